#include "app/gui/color_field.h"

#include <QColorDialog>
#include <QComboBox>
#include <QHBoxLayout>
#include <QPainter>
#include <QPushButton>
#include <QStyle>
#include <algorithm>
#include <cmath>

#include "app/gui/number_box.h"
#include "app/gui/workspace.h"
#include "core/elements.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

namespace {

QColor qcolor(const Vec4f& color) {
  const auto channel = [&](int i) { return std::clamp(color[i], 0.0F, 1.0F); };
  return QColor::fromRgbF(channel(0), channel(1), channel(2), channel(3));
}

void paint_checkerboard(QPainter& painter, const QRect& rect) {
  painter.fillRect(rect, Qt::white);
  const int size = std::max(2, rect.height() / 4);
  for (int y = 0; y * size < rect.height(); ++y) {
    for (int x = y % 2; x * size < rect.width(); x += 2) {
      painter.fillRect(QRect(rect.left() + x * size, rect.top() + y * size, size, size).intersected(rect),
                       Qt::lightGray);
    }
  }
}

// Left half as it is, right half with its opacity.
QIcon swatch(const Vec4f& color, const QSize& size, double pixel_ratio, const QColor& frame) {
  QPixmap picture(size * pixel_ratio);
  picture.setDevicePixelRatio(pixel_ratio);
  QPainter painter(&picture);
  const QRect all(QPoint(0, 0), size);
  paint_checkerboard(painter, all);
  painter.fillRect(all, qcolor(color));
  QRect opaque = all;
  opaque.setWidth(size.width() / 2);
  painter.fillRect(opaque, qcolor({color.x, color.y, color.z, 1.0F}));
  painter.setPen(frame);
  painter.drawRect(all.adjusted(0, 0, -1, -1));
  return QIcon(picture);
}

// Of a component that the dialog did not change, the parameter's own digits; else as many as can be seen.
float component(float from_dialog, float before) {
  if (std::abs(from_dialog - before) < 1.0F / 65535.0F) return before;
  return std::round(from_dialog * 10000.0F) / 10000.0F;
}

}  // namespace

ColorField::ColorField(Workspace& workspace, const std::string& key, QWidget* parent)
    : ParameterField(workspace, key, parent), button_(new QPushButton(this)) {
  const int height = fontMetrics().height();
  button_->setIconSize({2 * height, height});
  add_part(button_, "button");
  connect(button_, &QPushButton::clicked, this, &ColorField::open_dialog);
  if (row_.type == ParameterType::rgba) {
    alpha_ = new NumberBox(this);
    alpha_->set_range(0.0, 1.0);
    SliderScale scale;
    scale.unit = 0.05;
    alpha_->set_scale(scale);
    add_part(alpha_, "alpha");
    alpha_->setToolTip(tr("Opacity, from 0 to 1") + toolTip());
    alpha_->setAccessibleName(tr("Opacity"));
    const auto with_alpha = [this](const QString& alpha) {
      const Vec4f color = color_of(text());
      return vector_text(Vec3f(color)) + "," + alpha.toStdString();
    };
    connect(alpha_, &NumberBox::entered, this, [=, this](const QString& alpha) { commit_once(with_alpha(alpha)); });
    connect(alpha_, &NumberBox::stepped, this, [=, this](const QString& alpha) { commit(with_alpha(alpha)); });
    connect(alpha_, &NumberBox::steps_ended, this, [this] { end_edit(); });
    connect(alpha_, &NumberBox::given_up, this, [this] { clear_error(); });
  }
  static_cast<QHBoxLayout*>(layout())->addStretch();
}

Vec4f ColorField::color_of(const std::string& text) const {
  if (text == "auto") {
    const std::string species = key().substr(key().rfind('.') + 1);
    std::size_t ordinal = 0;
    if (workspace_.document()) {
      const auto names = workspace_.document()->species();
      ordinal = static_cast<std::size_t>(std::find(names.begin(), names.end(), species) - names.begin());
    }
    const auto color = default_species_color(species, ordinal);
    return {static_cast<float>(color[0]) / 255.0F, static_cast<float>(color[1]) / 255.0F,
            static_cast<float>(color[2]) / 255.0F, 1.0F};
  }
  if (row_.type == ParameterType::rgba) return read_rgba(text).value_or(Vec4f(0.0F));
  return {read_rgb(text).value_or(Vec3f(0.0F)), 1.0F};
}

void ColorField::show_text(const std::string& text) {
  if (text.empty()) return;
  const Vec4f color = color_of(text);
  button_->setIcon(swatch(color, button_->iconSize(), devicePixelRatioF(), palette().color(QPalette::Mid)));
  button_->setText(text == "auto" ? text.c_str() : qcolor({color.x, color.y, color.z, 1.0F}).name());
  if (alpha_ != nullptr) alpha_->show_text(QString::fromStdString(real_text(color.w)));
}

void ColorField::open_dialog() {
  if (dialog_ != nullptr) {
    dialog_->raise();
    return;
  }
  dialog_ = new QColorDialog(this);
  dialog_->setObjectName(objectName() + QStringLiteral("/dialog"));
  dialog_->setAttribute(Qt::WA_DeleteOnClose);
  dialog_->setWindowTitle(QString::fromStdString(row_.label));
  dialog_->setOption(QColorDialog::DontUseNativeDialog);
  dialog_->setOption(QColorDialog::ShowAlphaChannel, row_.type == ParameterType::rgba);
  dialog_->setCurrentColor(qcolor(color_of(text())));
  end_edit();
  // The picture follows while the dialog is open; Cancel brings back what was.
  connect(dialog_, &QColorDialog::currentColorChanged, this, [this](const QColor& chosen) {
    const Vec4f before = color_of(text());
    const Vec4f now(component(chosen.redF(), before.x), component(chosen.greenF(), before.y),
                    component(chosen.blueF(), before.z), component(chosen.alphaF(), before.w));
    commit(row_.type == ParameterType::rgba ? vector_text(now) : vector_text(Vec3f(now)));
  });
  connect(dialog_, &QDialog::rejected, this, [this, before = text()] { commit(before); });
  connect(dialog_, &QDialog::finished, this, [this] {
    dialog_ = nullptr;
    end_edit();
  });
  dialog_->open();
}

ColorMapPreview::ColorMapPreview(QWidget* parent) : QAbstractButton(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setCursor(Qt::PointingHandCursor);
}

void ColorMapPreview::set_map(const ColorMap& map) {
  map_ = map;
  update();
}

QSize ColorMapPreview::sizeHint() const {
  return {fontMetrics().averageCharWidth() * 12, fontMetrics().height() * 3 / 2};
}

void ColorMapPreview::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QRect strip = rect().adjusted(1, 1, -1, -1);
  paint_checkerboard(painter, strip);
  if (map_.entries.size() >= 2) {
    for (int x = strip.left(); x <= strip.right(); ++x) {
      const double scalar = static_cast<double>(x - strip.left()) / std::max(1, strip.width() - 1);
      const Vec4f color = map_(scalar);
      const int middle = strip.top() + strip.height() / 2;
      painter.fillRect(x, strip.top(), 1, middle - strip.top(), qcolor({color.x, color.y, color.z, 1.0F}));
      painter.fillRect(x, middle, 1, strip.bottom() - middle + 1, qcolor(color));
    }
  }
  painter.setPen(palette().color(hasFocus() ? QPalette::Highlight : QPalette::Mid));
  painter.drawRect(rect().adjusted(0, 0, -1, -1));
}

ColorMapField::ColorMapField(Workspace& workspace, const std::string& key, QWidget* parent)
    : ParameterField(workspace, key, parent), preview_(new ColorMapPreview(this)), presets_(new QComboBox(this)) {
  preview_->setText(tr("Edit the color map"));
  add_part(preview_, "preview");
  preview_->setToolTip(tr("Opens the color map editor.") + toolTip());
  static_cast<QHBoxLayout*>(layout())->setStretchFactor(preview_, 1);
  presets_->addItem(tr("own"), QString());
  for (const std::string& name : preset_color_map_names()) {
    presets_->addItem(QString::fromStdString(name), QString::fromStdString(name));
  }
  presets_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  presets_->setMinimumContentsLength(7);
  add_part(presets_, "combo");
  connect(preview_, &QAbstractButton::clicked, this, [this] { emit edit_color_map_requested(); });
  connect(presets_, &QComboBox::activated, this, [this](int index) {
    const std::string name = presets_->itemData(index).toString().toStdString();
    if (name.empty()) {
      show_text(text());
      emit edit_color_map_requested();
    } else {
      commit_once(name);
    }
  });
}

void ColorMapField::show_text(const std::string& text) {
  preview_->set_map(read_color_map(text));
  const int preset = presets_->findData(QString::fromStdString(text));
  presets_->setCurrentIndex(std::max(0, preset));
}

}  // namespace atomesh::gui
