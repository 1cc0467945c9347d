#include "app/gui/picture_form.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/gui/wheel_guard.h"

namespace atomesh::gui {

namespace {

struct Preset {
  const char* name;
  double times;  // of the view's size; 0: the size below, which is that of the last, free one, where it is 0 too
  int width;
  int height;
};
constexpr std::array<Preset, 8> presets{{{QT_TRANSLATE_NOOP("PictureForm", "As the view"), 1, 0, 0},
                                         {QT_TRANSLATE_NOOP("PictureForm", "2 × the view"), 2, 0, 0},
                                         {QT_TRANSLATE_NOOP("PictureForm", "4 × the view"), 4, 0, 0},
                                         {QT_TRANSLATE_NOOP("PictureForm", "HD"), 0, 1280, 720},
                                         {QT_TRANSLATE_NOOP("PictureForm", "Full HD"), 0, 1920, 1080},
                                         {QT_TRANSLATE_NOOP("PictureForm", "4K"), 0, 3840, 2160},
                                         {QT_TRANSLATE_NOOP("PictureForm", "Square"), 0, 2048, 2048},
                                         {QT_TRANSLATE_NOOP("PictureForm", "Free"), 0, 0, 0}}};
constexpr int free_preset = static_cast<int>(presets.size()) - 1;

}  // namespace

PictureForm::PictureForm(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName("picture_form");
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  build_size();
  build_parts();
  follow_view();
  take_preset();
  connect(&workspace_, &Workspace::view_size_changed, this, [this] { take_preset(); });
}

void PictureForm::build_size() {
  auto* form = new QFormLayout;
  preset_ = new QComboBox(this);
  preset_->setObjectName("picture_preset");
  for (const Preset& preset : presets) {
    QString text = tr(preset.name);
    if (preset.width > 0) text += QString(" (%1 × %2)").arg(preset.width).arg(preset.height);
    preset_->addItem(text);
  }
  guard_wheel(preset_);
  form->addRow(tr("Si&ze"), preset_);
  auto* row = new QHBoxLayout;
  const auto side = [&](const char* name, const QString& spoken) {
    auto* box = new QSpinBox(this);
    box->setObjectName(name);
    box->setRange(1, largest_picture_side);
    box->setSuffix(tr(" px"));
    box->setAccelerated(true);
    box->setAccessibleName(spoken);
    box->setToolTip(tr("%1 in pixels; it may be larger than the screen").arg(spoken));
    guard_wheel(box);
    return box;
  };
  width_ = side("picture_width", tr("Width"));
  height_ = side("picture_height", tr("Height"));
  lock_ = new QCheckBox(tr("&Keep ratio"), this);
  lock_->setObjectName("picture_lock");
  lock_->setChecked(true);
  lock_->setToolTip(tr("Changing one side changes the other with it"));
  row->addWidget(width_, 1);
  row->addWidget(new QLabel("×", this));
  row->addWidget(height_, 1);
  row->addWidget(lock_);
  auto* label = new QLabel(tr("&Width × height"), this);
  label->setBuddy(width_);
  form->addRow(label, row);
  supersampling_ = new QSpinBox(this);
  supersampling_->setObjectName("picture_supersampling");
  const ParameterRow& rule = parameter_row("quality.supersampling");
  supersampling_->setRange(static_cast<int>(rule.min), static_cast<int>(rule.max));
  supersampling_->setToolTip(QString::fromStdString(rule.help) + " " + tr("2 or 3 make edges smooth."));
  guard_wheel(supersampling_);
  form->addRow(tr("S&upersampling"), supersampling_);
  static_cast<QVBoxLayout*>(layout())->addLayout(form);

  connect(preset_, &QComboBox::activated, this, &PictureForm::take_preset);
  connect(width_, &QSpinBox::valueChanged, this, [this] { keep_ratio(true); });
  connect(height_, &QSpinBox::valueChanged, this, [this] { keep_ratio(false); });
  connect(lock_, &QCheckBox::toggled, this,
          [this] { ratio_ = static_cast<double>(width_->value()) / height_->value(); });
  connect(supersampling_, &QSpinBox::valueChanged, this, &PictureForm::changed);
}

QCheckBox* PictureForm::add_part(const char* name, const QString& text, const QString& tip) {
  auto* box = new QCheckBox(text, this);
  box->setObjectName(name);
  box->setToolTip(tip);
  connect(box, &QCheckBox::toggled, this, &PictureForm::changed);
  return box;
}

void PictureForm::build_parts() {
  auto* grid = new QGridLayout;
  transparent_ = add_part("picture_transparent", tr("&Transparent background"),
                          tr("The sample alone, to be laid over something else"));
  legend_ = add_part("picture_legend", tr("&Legend"), tr("What the colors mean"));
  scale_bar_ = add_part("picture_scale_bar", tr("S&cale bar"), tr("How long a round number of Å or nm is"));
  tripod_ = add_part("picture_tripod", tr("Tripod of a&xes"), tr("Which way x, y, z and the cell's a, b, c point"));
  marks_ = add_part("picture_marks", tr("&Marks and picks"), tr("What is marked and measured in the view"));
  grid->addWidget(transparent_, 0, 0);
  grid->addWidget(legend_, 0, 1);
  grid->addWidget(scale_bar_, 1, 0);
  grid->addWidget(tripod_, 1, 1);
  grid->addWidget(marks_, 2, 0);
  static_cast<QVBoxLayout*>(layout())->addLayout(grid);
}

void PictureForm::follow_view() {
  const ViewOptions& options = workspace_.view_options();
  legend_->setChecked(options.legend);
  scale_bar_->setChecked(options.scale_bar);
  tripod_->setChecked(options.tripod);
  marks_->setChecked(!workspace_.marks().empty() || !workspace_.picks().empty());
  supersampling_->setValue(workspace_.shown().supersampling);
  take_preset();
}

void PictureForm::take_preset() {
  const Preset& preset = presets[static_cast<std::size_t>(std::max(preset_->currentIndex(), 0))];
  if (preset.times > 0) {
    set_size(static_cast<int>(std::lround(preset.times * workspace_.width())),
             static_cast<int>(std::lround(preset.times * workspace_.height())));
  } else if (preset.width > 0) {
    set_size(preset.width, preset.height);
  }
}

void PictureForm::set_size(int width, int height) {
  const QSignalBlocker no_width(width_);
  const QSignalBlocker no_height(height_);
  width_->setValue(width);
  height_->setValue(height);
  ratio_ = static_cast<double>(width_->value()) / height_->value();
  emit changed();
}

void PictureForm::keep_ratio(bool width_changed) {
  preset_->setCurrentIndex(free_preset);
  if (lock_->isChecked()) {
    QSpinBox* const other = width_changed ? height_ : width_;
    const double side = width_changed ? width_->value() / ratio_ : height_->value() * ratio_;
    const QSignalBlocker quiet(other);
    other->setValue(static_cast<int>(std::lround(side)));
  } else {
    ratio_ = static_cast<double>(width_->value()) / height_->value();
  }
  emit changed();
}

void PictureForm::allow_transparent(bool allowed, const QString& why_not) {
  transparent_->setEnabled(allowed);
  transparent_->setToolTip(allowed ? tr("The sample alone, to be laid over something else") : why_not);
}

PictureSettings PictureForm::settings() const {
  PictureSettings settings;
  settings.width = width_->value();
  settings.height = height_->value();
  settings.transparent = transparent_->isEnabled() && transparent_->isChecked();
  settings.supersampling = supersampling_->value();
  settings.parts = {
      .legend = legend_->isChecked(), .scale_bar = scale_bar_->isChecked(), .tripod = tripod_->isChecked()};
  if (marks_->isChecked()) {
    settings.marks = workspace_.marks();
    settings.picks = workspace_.picks();
  }
  return settings;
}

}  // namespace atomesh::gui
