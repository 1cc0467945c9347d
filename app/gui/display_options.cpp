#include "app/gui/display_options.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QSettings>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/gui/miller_cut.h"
#include "app/gui/miller_dialog.h"
#include "app/gui/numbered_parts.h"
#include "app/gui/parameter_form.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/section.h"
#include "app/gui/theme.h"
#include "app/gui/wheel_guard.h"
#include "app/gui/workspace.h"

namespace atomesh::gui {

namespace {

std::vector<std::string> keys_of_part(const char* prefix, int n) {
  const std::string start = std::string(prefix) + std::to_string(n) + ".";
  std::vector<std::string> keys = parameter_keys();
  std::erase_if(keys, [&](const std::string& key) { return !key.starts_with(start); });
  return keys;
}

}  // namespace

DisplayOptions::DisplayOptions(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName(QStringLiteral("display_options"));
  auto* content = new QWidget(this);
  auto* layout = new QVBoxLayout(content);
  build_buttons(*layout);
  add_section(*layout, tr("Display"), QStringLiteral("Display"), keys_of_group("Display"));
  build_lights(*layout);
  build_cut_planes(*layout);
  add_section(*layout, tr("View"), QStringLiteral("View"), keys_of_group("View"), true);
  build_overlay(*layout);
  add_section(*layout, tr("Quality"), QStringLiteral("Quality"), keys_of_group("Quality"), true);
  layout->addStretch();
  auto* scroll = new QScrollArea(this);
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAsNeeded);
  auto* outer = new QVBoxLayout(this);
  outer->setContentsMargins(0, 0, 0, 0);
  outer->addWidget(scroll);
  connect(&workspace_, &Workspace::parameters_changed, this, &DisplayOptions::follow_parameters);
  connect(&workspace_, &Workspace::document_changed, this, &DisplayOptions::follow_parameters);
  follow_parameters();
}

void DisplayOptions::build_buttons(QVBoxLayout& layout) {
  auto* line = new QHBoxLayout;
  const auto add = [&](const QString& text, const QString& tip, const char* name) {
    auto* button = new QPushButton(text, this);
    button->setObjectName(QLatin1String(name));
    button->setToolTip(tip);
    line->addWidget(button);
    return button;
  };
  connect(add(tr("&Full screen"), tr("Full screen or window (f)"), "full_screen"), &QPushButton::clicked, this,
          &DisplayOptions::full_screen_requested);
  connect(add(tr("&Reset orientation"), tr("The view as it was at first (r)"), "reset_orientation"),
          &QPushButton::clicked, this, &DisplayOptions::reset_orientation_requested);
  connect(add(tr("Mouse…"), tr("Quick help on the mouse controls"), "mouse_controls"), &QPushButton::clicked, this,
          [this] { emit help_requested(QStringLiteral("controls")); });
  layout.addLayout(line);
}

ParameterForm* DisplayOptions::make_form(QWidget* parent, const std::vector<std::string>& keys) {
  auto* form = new ParameterForm(workspace_, parent);
  form->set_keys(keys);
  connect(form, &ParameterForm::help_requested, this, &DisplayOptions::help_requested);
  return form;
}

QToolButton* DisplayOptions::make_button(Section* section, const QString& text, const QString& tip, const char* name) {
  auto* button = new QToolButton(section);
  button->setObjectName(section->objectName() + QLatin1Char('/') + QLatin1String(name));
  button->setText(text);
  button->setToolTip(tip);
  button->setAccessibleName(tip);
  button->setAutoRaise(true);
  section->add_to_heading(button);
  return button;
}

Section* DisplayOptions::add_section(QVBoxLayout& layout, const QString& title, const QString& help,
                                     const std::vector<std::string>& keys, bool folded) {
  auto* section = new Section(title, help, this);
  if (!keys.empty()) {
    section->add(make_form(section, keys));
    connect(make_button(section, QStringLiteral("↺"), tr("All of %1 back to the defaults").arg(title), "reset"),
            &QToolButton::clicked, this,
            [this, keys, title] { reset_parameters(workspace_, keys, tr("Reset %1").arg(title)); });
  }
  connect(section, &Section::help_requested, this, &DisplayOptions::help_requested);
  const QString setting = QStringLiteral("display_options/folded/") + help;
  section->set_folded(QSettings().value(setting, folded).toBool());
  connect(section, &Section::folded_changed, this, [setting](bool now) { QSettings().setValue(setting, now); });
  layout.addWidget(section);
  return section;
}

void DisplayOptions::build_lights(QVBoxLayout& layout) {
  lights_section_ = add_section(layout, tr("Lights"), QStringLiteral("Lights"), {});
  connect(make_button(lights_section_, QStringLiteral("↺"), tr("All lights back to the defaults"), "reset"),
          &QToolButton::clicked, this,
          [this] { reset_parameters(workspace_, keys_of_group("Lights"), tr("Reset lights")); });
  auto* line = new QWidget(this);
  auto* form = new QFormLayout(line);
  form->setContentsMargins(0, 0, 0, 0);
  light_count_ = new QSpinBox(line);
  light_count_->setObjectName(QStringLiteral("light_count"));
  guard_wheel(light_count_);
  light_count_->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Fixed);
  light_count_->setRange(1, max_lights);
  light_count_->setToolTip(tr("From 1 to 8. Those taken away are switched off."));
  form->addRow(tr("&Number of lights"), light_count_);
  lights_section_->add(line);
  connect(light_count_, &QSpinBox::valueChanged, this, [this](int count) {
    Parameters parameters = workspace_.parameters();
    set_light_count(parameters, count);
    workspace_.change(parameters, tr("Number of lights"));
  });
}

void DisplayOptions::build_cut_planes(QVBoxLayout& layout) {
  cut_planes_section_ = add_section(layout, tr("Cut planes"), QStringLiteral("Cut planes"), {});
  connect(make_button(cut_planes_section_, QStringLiteral("↺"), tr("No cut planes"), "reset"), &QToolButton::clicked,
          this, [this] { reset_parameters(workspace_, keys_of_group("Cut planes"), tr("Reset cut planes")); });
  auto* line = new QWidget(this);
  auto* form = new QFormLayout(line);
  form->setContentsMargins(0, 0, 0, 0);
  cut_plane_count_ = new QSpinBox(line);
  cut_plane_count_->setObjectName(QStringLiteral("cut_plane_count"));
  guard_wheel(cut_plane_count_);
  cut_plane_count_->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Fixed);
  cut_plane_count_->setRange(0, max_cut_planes);
  cut_plane_count_->setToolTip(tr("From 0 to 8. A new one cuts through the middle of the sample."));
  form->addRow(tr("N&umber of cut planes"), cut_plane_count_);
  cut_planes_section_->add(line);
  connect(cut_plane_count_, &QSpinBox::valueChanged, this, [this](int count) {
    Parameters parameters = workspace_.parameters();
    set_cut_plane_count(parameters, count, workspace_.bounds());
    workspace_.change(parameters, tr("Number of cut planes"));
  });
}

DisplayOptions::Part DisplayOptions::make_light(int n, QWidget* parent) {
  Part part;
  part.section = new Section(tr("Light %1").arg(n), {}, parent);
  part.form = make_form(part.section, keys_of_part("light.", n));
  part.section->add(part.form);
  connect(make_button(part.section, QStringLiteral("✕"), tr("Remove light %1").arg(n), "remove"), &QToolButton::clicked,
          this, [this, n] {
            Parameters parameters = workspace_.parameters();
            remove_light(parameters, n);
            workspace_.change(parameters, tr("Remove light %1").arg(n));
          });
  part.section->set_folded(n > 1);
  return part;
}

DisplayOptions::Part DisplayOptions::make_cut_plane(int n, QWidget* parent) {
  Part part;
  part.section = new Section(tr("Cut plane %1").arg(n), {}, parent);
  part.form = make_form(part.section, keys_of_part("cut_plane.", n));
  part.section->add(part.form);
  // Inserted before the one made last: from right to left.
  connect(make_button(part.section, QStringLiteral("✕"), tr("Remove cut plane %1").arg(n), "remove"),
          &QToolButton::clicked, this, [this, n] {
            Parameters parameters = workspace_.parameters();
            remove_cut_plane(parameters, n);
            workspace_.change(parameters, tr("Remove cut plane %1").arg(n));
          });
  connect(make_button(part.section, QStringLiteral("⇄"), tr("The other side stays"), "flip"), &QToolButton::clicked,
          this, [this, n] {
            Parameters parameters = workspace_.parameters();
            flip_cut_plane(parameters, n);
            workspace_.change(parameters, tr("Flip cut plane %1").arg(n));
          });
  connect(make_button(part.section, QStringLiteral("(hkl)…"), tr("By Miller indices of the crystal's own cell"), "hkl"),
          &QToolButton::clicked, this, [this, n] { open_miller_cut(n); });
  return part;
}

void DisplayOptions::open_miller_cut(int n) {
  const auto& document = workspace_.document();
  if (!document || !document->material->unit_cell) {
    workspace_.complain(
        tr("Miller indices need the crystal's unit cell, and this file has none. Preprocess the atoms with a unit cell "
           "(atomesh preprocess --unit-cell auto), or type the plane's a, b, c and d."));
    return;
  }
  auto* dialog = new MillerDialog(workspace_, n, this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->show();
}

void DisplayOptions::build_overlay(QVBoxLayout& layout) {
  Section* section = add_section(layout, tr("On and around the picture"), QStringLiteral("pictures"), {});
  auto* box = new QWidget(section);
  auto* form = new QFormLayout(box);
  form->setContentsMargins(0, 0, 0, 0);
  const auto add = [&](const QString& text, const QString& tip, const char* name, bool ViewOptions::*member) {
    auto* check = new QCheckBox(text, box);
    check->setObjectName(QLatin1String(name));
    check->setToolTip(tip);
    check->setChecked(workspace_.view_options().*member);
    form->addRow(check);
    connect(check, &QCheckBox::clicked, this, [this, member](bool on) {
      ViewOptions options = workspace_.view_options();
      options.*member = on;
      workspace_.set_view_options(options);
    });
    connect(&workspace_, &Workspace::view_options_changed, check,
            [this, check, member] { check->setChecked(workspace_.view_options().*member); });
  };
  add(tr("&Legend"), tr("What the colors mean, with units"), "view_legend", &ViewOptions::legend);
  add(tr("&Scale bar"), tr("A length of the sample, in parallel projection exact everywhere"), "view_scale_bar",
      &ViewOptions::scale_bar);
  add(tr("&Tripod"), tr("Where x, y, z and the crystal's a, b, c point"), "view_tripod", &ViewOptions::tripod);
  add(tr("&Handles of cut planes"), tr("To drag the enabled planes in the view; never in saved pictures"),
      "view_cut_handles", &ViewOptions::cut_handles);
  add(tr("Turn &upright"), tr("Turning keeps z upwards; else freely about the picture's axes"), "view_upright",
      &ViewOptions::upright);

  auto* drawing = new QComboBox(box);
  drawing->setObjectName(QStringLiteral("view_drawing"));
  guard_wheel(drawing);
  drawing->addItems({tr("Automatic"), tr("Graphics card"), tr("Processor")});
  drawing->setToolTip(tr("Who draws volume, surface and atom balls"));
  form->addRow(tr("&Drawn by"), drawing);
  const auto show_drawing = [this, drawing] {
    drawing->setCurrentIndex(static_cast<int>(workspace_.view_options().drawing));
  };
  show_drawing();
  connect(&workspace_, &Workspace::view_options_changed, drawing, show_drawing);
  connect(drawing, &QComboBox::activated, this, [this](int index) {
    ViewOptions options = workspace_.view_options();
    options.drawing = static_cast<ViewOptions::Drawing>(index);
    workspace_.set_view_options(options);
  });

  auto* theme = new QComboBox(box);
  theme->setObjectName(QStringLiteral("theme"));
  guard_wheel(theme);
  theme->addItems({tr("As the system"), tr("Light"), tr("Dark")});
  theme->setToolTip(tr("Colors of menus and docks"));
  theme->setCurrentIndex(static_cast<int>(chosen_theme()));
  form->addRow(tr("&Menu color"), theme);
  if (const ThemeKeeper* keeper = ThemeKeeper::instance()) {  // it can be chosen elsewhere too
    connect(keeper, &ThemeKeeper::changed, theme,
            [theme] { theme->setCurrentIndex(static_cast<int>(chosen_theme())); });
  }
  connect(theme, &QComboBox::activated, this, [](int index) {
    if (ThemeKeeper* keeper = ThemeKeeper::instance()) keeper->choose(static_cast<Theme>(index));
  });
  section->add(box);
}

void DisplayOptions::show_parts(std::vector<Part>& parts, int count, Section& section, const char* prefix) {
  const bool lights = std::string_view(prefix) == "light.";
  while (static_cast<int>(parts.size()) < count) {
    const int n = static_cast<int>(parts.size()) + 1;
    parts.push_back(lights ? make_light(n, &section) : make_cut_plane(n, &section));
    section.add(parts.back().section);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].section->setVisible(static_cast<int>(i) < count);
}

void DisplayOptions::follow_parameters() {
  const Parameters& parameters = workspace_.parameters();
  const int lights = light_count(parameters);
  const int planes = cut_plane_count(parameters);
  {
    const QSignalBlocker block_lights(light_count_);
    const QSignalBlocker block_planes(cut_plane_count_);
    light_count_->setValue(lights);
    cut_plane_count_->setValue(planes);
  }
  show_parts(lights_, lights, *lights_section_, "light.");
  show_parts(cut_planes_, planes, *cut_planes_section_, "cut_plane.");
  title_cut_planes();
}

void DisplayOptions::title_cut_planes() {
  const auto& document = workspace_.document();
  const bool crystal = document && document->material->unit_cell;
  for (std::size_t i = 0; i < cut_planes_.size(); ++i) {
    const CutPlane& plane = workspace_.parameters().cut_planes[i];
    QString title = tr("Cut plane %1").arg(i + 1);
    if (crystal) {
      if (const auto hkl = miller_indices(*document->material->unit_cell, plane.normal)) {
        title += QStringLiteral(" (%1 %2 %3)").arg(hkl->x).arg(hkl->y).arg(hkl->z);
      }
    }
    if (!plane.enabled) title += tr(", off");
    cut_planes_[i].section->set_title(title);
  }
}

}  // namespace atomesh::gui
