#include "app/gui/color_map_editor.h"

#include <QApplication>
#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSpinBox>
#include <QTableView>
#include <QVBoxLayout>
#include <utility>

#include "app/gui/color_map_canvas.h"
#include "app/gui/color_map_painting.h"
#include "app/gui/color_map_table.h"
#include "core/error.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

namespace {

const char* const map_key = "volume.color_map";

QString help_of(const char* key) {
  return QString::fromStdString(parameter_row(key).help);
}

}  // namespace

ColorMapEditor::ColorMapEditor(Workspace& workspace, QWidget* parent)
    : QWidget(parent), workspace_(workspace), source_(workspace) {
  setObjectName("color_map_editor");
  setWindowTitle(tr("Color map"));
  canvas_ = new ColorMapCanvas(this);
  canvas_->setToolTip(help_of(map_key));
  build_toolbar();
  build_table();
  build_range();
  build_layout();
  follow();
  show_parameters();
  show_histogram();
  show_apply();
}

// --- how it is built

void ColorMapEditor::build_toolbar() {
  presets_ = new QPushButton(this);
  presets_->setObjectName("presets");
  presets_->setText(tr("&Preset"));
  presets_->setToolTip(tr("Colors and opacities of a preset; beside it is chosen which of them are taken"));
  auto* menu = new QMenu(presets_);
  menu->setObjectName("presets_menu");
  presets_->setMenu(menu);
  fill_presets(menu);

  part_ = new QComboBox(this);
  part_->setObjectName("preset_part");
  part_->addItems({tr("Colors and opacities"), tr("Colors only"), tr("Opacities only")});
  part_->setToolTip(tr("What a preset, Paste and Reverse change"));
  part_->setAccessibleName(tr("What a preset, Paste and Reverse change"));

  opacities_ = new QPushButton(this);
  opacities_->setObjectName("opacity_curves");
  opacities_->setText(tr("&Opacity"));
  opacities_->setToolTip(tr("Opacities by a rule; the colors stay"));
  auto* curves = new QMenu(opacities_);
  curves->setObjectName("opacity_menu");
  opacities_->setMenu(curves);
  fill_opacities(curves);

  reverse_ = new QPushButton(tr("Re&verse"), this);
  reverse_->setObjectName("reverse");
  reverse_->setToolTip(tr("Each scalar gets what 1 − scalar has"));
  connect(reverse_, &QPushButton::clicked, this, [this] {
    ColorMap map = color_map();
    reverse_color_map(map, part());
    change(map, tr("Reverse color map"));
  });

  logarithmic_ = new QCheckBox(tr("&Logarithmic histogram"), this);
  logarithmic_->setObjectName("logarithmic");
  logarithmic_->setToolTip(
      tr("Bars as long as the logarithm of their counts: a few defects among a million atoms show"));
  logarithmic_->setChecked(canvas_->logarithmic());
  connect(logarithmic_, &QCheckBox::toggled, canvas_, &ColorMapCanvas::set_logarithmic);
}

void ColorMapEditor::fill_presets(QMenu* menu) {
  const QSize size(fontMetrics().averageCharWidth() * 10, fontMetrics().height());
  for (const std::string& name : preset_color_map_names()) {
    QAction* action = menu->addAction(color_map_icon(preset_color_map(name), size, devicePixelRatioF()),
                                      QString::fromStdString(name), this, [this, name] { apply_preset(name); });
    action->setObjectName(QString::fromStdString("preset_" + name));
    action->setIconVisibleInMenu(true);
  }
  menu->addSeparator();
  QAction* copy = menu->addAction(tr("&Copy as text"), this, &ColorMapEditor::copy_text);
  copy->setObjectName("copy_color_map");
  copy->setToolTip(tr("As --set %1=… and the .crf file have it").arg(map_key));
  QAction* paste = menu->addAction(tr("P&aste text"), this, &ColorMapEditor::paste_text);
  paste->setObjectName("paste_color_map");
  QAction* load = menu->addAction(tr("&Load…"), this, &ColorMapEditor::ask_which_to_load);
  load->setObjectName("load_color_map");
  QAction* save = menu->addAction(tr("&Save…"), this, &ColorMapEditor::ask_where_to_save);
  save->setObjectName("save_color_map");
}

void ColorMapEditor::fill_opacities(QMenu* menu) {
  // In the order of opacity_curve_names().
  const std::array labels{tr("&1 everywhere"), tr("&As the scalar"), tr("As its &square"),
                          tr("0, from the middle &on 1"), tr("0, from the &middle on a ramp")};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::string name = opacity_curve_names()[i];
    QAction* action = menu->addAction(labels[i], this, [this, name] {
      ColorMap map = color_map();
      apply_color_map(map, opacity_curve(name), ColorMapPart::opacity);
      change(map, tr("Opacities of the color map"));
    });
    action->setObjectName(QString::fromStdString("opacity_" + name));
  }
}

void ColorMapEditor::build_table() {
  entries_ = new ColorMapTable(this);
  table_ = new QTableView(this);
  table_->setObjectName("color_map_table");
  table_->setAccessibleName(tr("Entries of the color map"));
  table_->setModel(entries_);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::SingleSelection);
  table_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed |
                          QAbstractItemView::AnyKeyPressed);
  table_->setTabKeyNavigation(false);  // Tab goes on to the buttons
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  // A color cut off says nothing; numbers may be.
  table_->horizontalHeader()->setSectionResizeMode(ColorMapTable::color, QHeaderView::ResizeToContents);
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);

  const auto button = [this](const QString& text, const char* name, const QString& tip) {
    auto* made = new QPushButton(text, this);
    made->setObjectName(name);
    made->setToolTip(tip);
    return made;
  };
  add_ = button(tr("A&dd"), "add_entry", tr("An entry between the selected one and the next (Insert)"));
  remove_ = button(tr("Re&move"), "remove_entry", tr("Remove the selected entry (Delete)"));
  color_ = button(tr("&Color…"), "entry_color", tr("Color of the selected entry (Enter)"));
  count_ = new QLabel(this);
  count_->setObjectName("entry_count");
  connect(add_, &QPushButton::clicked, canvas_, &ColorMapCanvas::insert_after_selected);
  connect(remove_, &QPushButton::clicked, canvas_, &ColorMapCanvas::remove_selected);
  connect(color_, &QPushButton::clicked, this, [this] {
    if (canvas_->selected()) ask_color(*canvas_->selected());
  });
}

void ColorMapEditor::build_range() {
  range_ = new QWidget(this);
  auto* row = new QHBoxLayout(range_);
  row->setContentsMargins(0, 0, 0, 0);
  const auto edit = [&](const char* key, const char* name) {
    auto* label = new QLabel(QString::fromStdString("&" + parameter_row(key).label), range_);
    auto* line = new QLineEdit(range_);
    line->setObjectName(name);
    line->setToolTip(help_of(key));
    label->setBuddy(line);
    row->addWidget(label);
    row->addWidget(line);
    connect(line, &QLineEdit::editingFinished, this, [this, key, line] { set_range(key, line); });
    return line;
  };
  range_low_ = edit("volume.range_low", "range_low");
  range_high_ = edit("volume.range_high", "range_high");

  refusal_ = new QLabel(this);
  refusal_->setObjectName("refusal");
  refusal_->setWordWrap(true);
  refusal_->hide();

  bins_ = new QSpinBox(this);
  bins_->setObjectName("bins");
  bins_->setRange(2, max_bins);
  bins_->setValue(source_.bins());
  bins_->setKeyboardTracking(false);
  bins_->setToolTip(tr("How many intervals the scalars are counted in"));
  connect(bins_, &QSpinBox::valueChanged, this, [this](int bins) { source_.set_bins(bins); });
  create_histogram_ = new QPushButton(tr("Create Scalar &Histogram…"), this);
  create_histogram_->setObjectName("create_histogram");
  create_histogram_->setToolTip(tr("Write the counts to a file, histogram.csv"));
  connect(create_histogram_, &QPushButton::clicked, this, &ColorMapEditor::ask_where_to_write_histogram);

  auto_apply_ = new QCheckBox(tr("A&uto apply"), this);
  auto_apply_->setObjectName("auto_apply");
  auto_apply_->setToolTip(tr("Draw every change at once"));
  connect(auto_apply_, &QCheckBox::toggled, this, [this](bool on) { workspace_.set_auto_apply(Mode::volume, on); });
  apply_ = new QPushButton(tr("&Apply"), this);
  apply_->setObjectName("apply");
  apply_->setToolTip(tr("Draw with the color map as it is here"));
  connect(apply_, &QPushButton::clicked, this, [this] { workspace_.apply(Mode::volume); });
}

void ColorMapEditor::build_layout() {
  // Rows of few: a dock is narrow.
  const auto row = [](std::initializer_list<QWidget*> left, std::initializer_list<QWidget*> right) {
    auto* layout = new QHBoxLayout;
    for (QWidget* widget : left) layout->addWidget(widget);
    layout->addStretch(1);
    for (QWidget* widget : right) layout->addWidget(widget);
    return layout;
  };
  auto* bins_label = new QLabel(tr("&Bins"), this);
  bins_label->setBuddy(bins_);
  auto* all = new QVBoxLayout(this);
  all->addLayout(row({presets_, part_}, {}));
  all->addLayout(row({opacities_, reverse_}, {}));
  all->addWidget(canvas_, 3);
  all->addWidget(range_);
  all->addLayout(row({logarithmic_}, {bins_label, bins_}));
  all->addLayout(row({}, {create_histogram_}));
  all->addWidget(table_, 2);
  all->addWidget(refusal_);
  all->addLayout(row({add_, remove_, color_}, {}));
  all->addLayout(row({count_}, {auto_apply_, apply_}));
  QWidget* const order[] = {presets_,     part_, opacities_,        reverse_, canvas_, range_low_, range_high_,
                            logarithmic_, bins_, create_histogram_, table_,   add_,    remove_,    color_,
                            auto_apply_,  apply_};
  for (std::size_t i = 1; i < std::size(order); ++i) setTabOrder(order[i - 1], order[i]);
}

void ColorMapEditor::follow() {
  connect(canvas_, &ColorMapCanvas::edited, this, &ColorMapEditor::change);
  // To the workspace itself: the canvas loses the focus while this is taken down.
  connect(canvas_, &ColorMapCanvas::gesture_ended, &workspace_, &Workspace::end_gesture);
  connect(canvas_, &ColorMapCanvas::color_wanted, this, &ColorMapEditor::ask_color);
  connect(canvas_, &ColorMapCanvas::refused, this, &ColorMapEditor::show_refusal);
  connect(canvas_, &ColorMapCanvas::selection_changed, this, [this] {
    const auto selected = canvas_->selected();
    remove_->setEnabled(selected && color_map().entries.size() > min_color_map_entries);
    color_->setEnabled(selected.has_value());
    if (!selected) {
      table_->clearSelection();
    } else if (table_->currentIndex().row() != static_cast<int>(*selected)) {
      table_->selectRow(static_cast<int>(*selected));
    }
  });
  connect(entries_, &ColorMapTable::edited, this, [this](const ColorMap& map, const QString& name, std::size_t entry) {
    change(map, name);
    canvas_->select(entry);
  });
  connect(entries_, &ColorMapTable::refused, this, &ColorMapEditor::show_refusal);
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, [this](const QModelIndex& current) {
    if (current.isValid()) canvas_->select(static_cast<std::size_t>(current.row()));
  });
  connect(table_, &QTableView::doubleClicked, this, [this](const QModelIndex& index) {
    if (index.column() == ColorMapTable::color) ask_color(static_cast<std::size_t>(index.row()));
  });

  connect(&workspace_, &Workspace::parameters_changed, this, &ColorMapEditor::show_parameters);
  connect(&workspace_, &Workspace::document_changed, this, &ColorMapEditor::show_parameters);
  connect(&workspace_, &Workspace::apply_changed, this, &ColorMapEditor::show_apply);
  connect(&source_, &HistogramSource::changed, this, &ColorMapEditor::show_histogram);
}

void ColorMapEditor::showEvent(QShowEvent* event) {
  source_.set_wanted(true);
  QWidget::showEvent(event);
}

void ColorMapEditor::hideEvent(QHideEvent* event) {
  source_.set_wanted(false);
  QWidget::hideEvent(event);
}

// --- what it shows

void ColorMapEditor::show_parameters() {
  const ColorMap& map = color_map();
  canvas_->set_color_map(map);
  entries_->set_color_map(map);
  count_->setText(tr("%1 of %2 entries").arg(map.entries.size()).arg(max_color_map_entries));
  add_->setEnabled(map.entries.size() < max_color_map_entries);
  remove_->setEnabled(canvas_->selected() && map.entries.size() > min_color_map_entries);
  color_->setEnabled(canvas_->selected().has_value());
  if (const auto selected = canvas_->selected()) table_->selectRow(static_cast<int>(*selected));
  const auto preset = preset_of_colors(map);
  presets_->setText(preset ? tr("&Preset: %1").arg(QString::fromStdString(*preset)) : tr("&Preset"));

  const VolumeParameters& volume = workspace_.parameters().volume;
  const auto text = [](const std::optional<double>& value) {
    return value ? QString::fromStdString(real_text(*value)) : QString();
  };
  for (const auto& [line, value] : {std::pair(range_low_, volume.range_low), {range_high_, volume.range_high}}) {
    if (!line->hasFocus() || !line->isModified()) line->setText(text(value));  // not while it is typed
  }
}

void ColorMapEditor::show_histogram() {
  const auto& histogram = source_.histogram();
  QString note = source_.trouble();
  if (!workspace_.document()) {
    note = tr("Open a file to see how often each scalar occurs.");
  } else if (!histogram && note.isEmpty()) {
    note = tr("Counting…");
  } else if (histogram && histogram->of_atoms && !(histogram->high > 0.0)) {
    note = workspace_.document()->material->defects.present()
               ? tr("All scalars are 0: no atom has a defect, or the multipliers are 0.")
               : tr("The atoms have no defect values: preprocess them with a unit cell or a scalar.");
  } else if (histogram && histogram->below + histogram->above > 0) {
    note = tr("%L1 values below the range, %L2 above it")
               .arg(static_cast<qulonglong>(histogram->below))
               .arg(static_cast<qulonglong>(histogram->above));
  }
  canvas_->set_histogram(histogram, note);
  entries_->set_range(histogram ? histogram->low : 0.0, histogram ? histogram->high : 1.0);
  create_histogram_->setEnabled(histogram != nullptr);
  write_when_counted();
  const bool field = histogram && !histogram->of_atoms;
  range_->setVisible(field || workspace_.parameters().volume.range_low || workspace_.parameters().volume.range_high);
  range_low_->setPlaceholderText(field ? tr("auto: %1").arg(histogram->low) : tr("auto"));
  range_high_->setPlaceholderText(field ? tr("auto: %1").arg(histogram->high) : tr("auto"));
}

void ColorMapEditor::show_apply() {
  auto_apply_->setChecked(workspace_.auto_apply(Mode::volume));
  apply_->setEnabled(workspace_.apply_pending(Mode::volume));
}

void ColorMapEditor::show_refusal(const QString& why) {
  refusal_->setText(why);
  refusal_->setVisible(!why.isEmpty());
}

// --- what is done

ColorMapPart ColorMapEditor::part() const {
  return static_cast<ColorMapPart>(part_->currentIndex());
}

void ColorMapEditor::change(const ColorMap& map, const QString& name, const std::string& gesture) {
  Parameters to = workspace_.parameters();
  to.volume.color_map = map;
  workspace_.change(to, name, gesture);
}

void ColorMapEditor::apply_preset(const std::string& name) {
  ColorMap map = color_map();
  apply_color_map(map, preset_color_map(name), part());
  change(map, tr("Color map %1").arg(QString::fromStdString(name)));
}

void ColorMapEditor::ask_color(std::size_t entry) {
  if (entry >= color_map().entries.size()) return;
  const ColorMap before = color_map();
  const std::string gesture = "color map color " + std::to_string(++colors_asked_);
  auto* dialog = new QColorDialog(to_color(before.entries[entry].color), this);
  dialog->setObjectName("entry_color_dialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setOption(QColorDialog::DontUseNativeDialog);
  dialog->setWindowTitle(tr("Color of entry %1").arg(entry + 1));
  const QString name = tr("Color of map entry %1").arg(entry + 1);
  connect(dialog, &QColorDialog::currentColorChanged, this, [this, before, entry, gesture, name](const QColor& color) {
    ColorMap map = before;
    set_entry_color(map, entry, {color.redF(), color.greenF(), color.blueF()});
    change(map, name, gesture);
  });
  connect(dialog, &QColorDialog::rejected, this, [this, before, gesture, name] { change(before, name, gesture); });
  connect(dialog, &QColorDialog::finished, this, [this] { workspace_.end_gesture(); });
  dialog->open();
}

void ColorMapEditor::set_range(const std::string& key, QLineEdit* edit) {
  const QString text = edit->text().trimmed();
  try {
    workspace_.set(key, text.isEmpty() ? "auto" : text.toStdString());
    workspace_.end_gesture();
    show_refusal({});
  } catch (const UsageError& error) {
    show_refusal(QString::fromUtf8(error.what()));
  }
}

}  // namespace atomesh::gui
