#include "app/gui/loader_page.h"

#include <QComboBox>
#include <QCompleter>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QFileSystemModel>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QTimer>
#include <QVBoxLayout>

#include "app/gui/job.h"
#include "app/gui/pipeline_form.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr int typing_pause_ms = 250;

std::unique_ptr<QSettings> open_settings(const QString& file) {
  return file.isEmpty() ? std::make_unique<QSettings>() : std::make_unique<QSettings>(file, QSettings::IniFormat);
}

QPushButton* browse_button(const QString& name, const QString& tip) {
  auto* button = new QPushButton(LoaderPage::tr("Browse…"));
  button->setObjectName(name);
  button->setToolTip(tip);
  return button;
}

QLabel* wrapped_label(const QString& name) {
  auto* label = new QLabel;
  label->setObjectName(name);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

}  // namespace

LoaderPage::LoaderPage(QWidget* parent, const QString& settings_file)
    : QWidget(parent),
      recent_("data", settings_file),
      recent_parameters_("parameter_files", settings_file),
      settings_file_(settings_file) {
  setObjectName("loader");
  typing_ = new QTimer(this);
  typing_->setSingleShot(true);
  typing_->setInterval(typing_pause_ms);
  connect(typing_, &QTimer::timeout, this, &LoaderPage::look_up);

  auto* title = new QLabel(tr("Open a sample"));
  QFont large = title->font();
  large.setPointSizeF(large.pointSizeF() * 1.5);
  title->setFont(large);
  auto* column = new QVBoxLayout;
  column->addWidget(title);
  column->addWidget(make_file_box());
  column->addWidget(make_output_box());
  column->addWidget(make_parameters_box());
  column->addWidget(make_recent_box(), 1);
  problem_ = wrapped_label("loader_problem");
  problem_->setFrameShape(QFrame::StyledPanel);
  problem_->setMargin(fontMetrics().height() / 2);
  column->addWidget(problem_);
  column->addWidget(make_buttons());
  auto* middle = new QWidget;
  middle->setLayout(column);
  middle->setMaximumWidth(fontMetrics().averageCharWidth() * 110);
  auto* row = new QHBoxLayout(this);
  row->addStretch(1);
  row->addWidget(middle, 8);
  row->addStretch(1);

  connect(&recent_, &RecentFiles::changed, this, &LoaderPage::list_recent);
  connect(&recent_parameters_, &RecentFiles::changed, this, &LoaderPage::list_recent);
  list_recent();
  set_has_view(false);
  show_problem({});
  update_state();
}

LoaderPage::~LoaderPage() = default;

QWidget* LoaderPage::make_file_box() {
  auto* box = new QGroupBox(tr("Dataset"));
  file_ = new QLineEdit;
  file_->setObjectName("file");
  file_->setClearButtonEnabled(true);
  file_->setPlaceholderText(tr("a file of atoms, a .crb or .crt, a mesh, or a picture that atomesh saved"));
  file_->setToolTip(tr("The dataset file. Atoms (.dat, .xyz, LAMMPS) are preprocessed first; all else opens at once"));
  auto* completer = new QCompleter(this);
  auto* files = new QFileSystemModel(completer);
  files->setRootPath({});
  completer->setModel(files);
  file_->setCompleter(completer);
  auto* label = new QLabel(tr("&File:"));
  label->setBuddy(file_);
  QPushButton* button = browse_button("browse", tr("Choose the dataset file"));
  kind_ = wrapped_label("kind");
  auto* layout = new QGridLayout(box);
  layout->addWidget(label, 0, 0);
  layout->addWidget(file_, 0, 1);
  layout->addWidget(button, 0, 2);
  layout->addWidget(kind_, 1, 1, 1, 2);
  connect(file_, &QLineEdit::textChanged, this, [this] {
    summary_.reset();
    go_when_known_ = false;
    show_problem({});
    update_state();
    typing_->start();
  });
  connect(file_, &QLineEdit::returnPressed, this, [this] {
    go_when_known_ = true;
    if (summary_) {
      go();
    } else {
      look_up();
    }
  });
  connect(button, &QPushButton::clicked, this, &LoaderPage::browse);
  return box;
}

QWidget* LoaderPage::make_recent_box() {
  auto* box = new QGroupBox(tr("&Recent files"));
  recent_list_ = new QListWidget;
  recent_list_->setObjectName("recent");
  recent_list_->setToolTip(tr("Click to choose, double click or Enter to open"));
  recent_list_->setMinimumHeight(fontMetrics().height() * 4);
  auto* layout = new QVBoxLayout(box);
  layout->addWidget(recent_list_);
  connect(recent_list_, &QListWidget::itemClicked, this,
          [this](const QListWidgetItem* item) { set_file(item->data(Qt::UserRole).toString()); });
  connect(recent_list_, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) {
    set_file(item->data(Qt::UserRole).toString());
    go_when_known_ = true;
    if (summary_) go();
  });
  return box;
}

QWidget* LoaderPage::make_output_box() {
  output_box_ = new QGroupBox(tr("Preprocessing"));
  output_box_->setObjectName("output_box");
  format_ = new QComboBox;
  format_->setObjectName("format");
  format_->addItem(tr("Binary (.crb): compact, fast to load"), static_cast<int>(OutputFormat::binary));
  format_->addItem(tr("Text (.crt): for other tools"), static_cast<int>(OutputFormat::text));
  format_->addItem(tr("Both"), static_cast<int>(OutputFormat::both));
  format_->addItem(tr("None: only look at it"), static_cast<int>(OutputFormat::none));
  format_->setToolTip(tr("What the result is saved as, so that it opens at once the next time"));
  const int last = open_settings(settings_file_)->value("loader/format").toInt();
  format_->setCurrentIndex(std::max(0, format_->findData(last)));
  output_ = new QLineEdit;
  output_->setObjectName("output");
  output_->setClearButtonEnabled(true);
  output_->setToolTip(tr("Name of the result, without its ending; beside the dataset when nothing stands here"));
  QPushButton* button = browse_button("browse_output", tr("Choose where the result goes"));
  output_note_ = wrapped_label("output_note");
  form_ = new PipelineForm;
  form_->setObjectName("form");
  auto* output_row = new QWidget;
  auto* row = new QHBoxLayout(output_row);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(output_, 1);
  row->addWidget(button);
  auto* layout = new QFormLayout(output_box_);
  auto* format_label = new QLabel(tr("Output f&ormat:"));
  format_label->setBuddy(format_);
  layout->addRow(format_label, format_);
  auto* output_label = new QLabel(tr("Save &as:"));
  output_label->setBuddy(output_);
  layout->addRow(output_label, output_row);
  layout->addRow(QString(), output_note_);
  layout->addRow(form_);
  connect(button, &QPushButton::clicked, this, [this] {
    const QString path =
        QFileDialog::getSaveFileName(this, tr("Save as"), output_->placeholderText(), tr("Materials (*.crb *.crt)"));
    if (path.isEmpty()) return;
    const QFileInfo info(path);
    const bool has_ending = info.suffix() == "crb" || info.suffix() == "crt";
    output_->setText(has_ending ? info.dir().filePath(info.completeBaseName()) : path);
  });
  connect(format_, &QComboBox::currentIndexChanged, this, [this] {
    open_settings(settings_file_)->setValue("loader/format", format_->currentData());
    update_state();
  });
  connect(output_, &QLineEdit::textChanged, this, &LoaderPage::update_state);
  connect(form_, &PipelineForm::changed, this, &LoaderPage::update_state);
  return output_box_;
}

QWidget* LoaderPage::make_parameters_box() {
  auto* box = new QGroupBox(tr("View parameters"));
  parameters_ = new QComboBox;
  parameters_->setObjectName("parameters");
  parameters_->setEditable(true);
  parameters_->setInsertPolicy(QComboBox::NoInsert);
  parameters_->lineEdit()->setClearButtonEnabled(true);
  parameters_->lineEdit()->setPlaceholderText(tr("none: the defaults"));
  parameters_->setToolTip(tr("A .crf that was saved before; without one the defaults hold"));
  auto* label = new QLabel(tr("&Parameters (.crf):"));
  label->setBuddy(parameters_);
  QPushButton* button = browse_button("browse_parameters", tr("Choose a .crf"));
  auto* layout = new QHBoxLayout(box);
  layout->addWidget(label);
  layout->addWidget(parameters_, 1);
  layout->addWidget(button);
  connect(button, &QPushButton::clicked, this, [this] {
    const QString path = QFileDialog::getOpenFileName(this, tr("View parameters"), QFileInfo(file()).path(),
                                                      tr("View parameters (*.crf);;All files (*)"));
    if (!path.isEmpty()) set_parameters_file(path);
  });
  connect(parameters_, &QComboBox::editTextChanged, this, [this] { show_problem({}); });
  return box;
}

QWidget* LoaderPage::make_buttons() {
  auto* buttons = new QWidget;
  go_ = new QPushButton;
  go_->setObjectName("go");
  go_->setAutoDefault(true);
  go_->setDefault(true);
  cancel_ = new QPushButton;
  cancel_->setObjectName("cancel");
  auto* layout = new QHBoxLayout(buttons);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addStretch(1);
  layout->addWidget(go_);
  layout->addWidget(cancel_);
  connect(go_, &QPushButton::clicked, this, &LoaderPage::go);
  connect(cancel_, &QPushButton::clicked, this, &LoaderPage::cancelled);
  return buttons;
}

void LoaderPage::set_file(const QString& path) {
  file_->setText(path);
  look_up();
}

void LoaderPage::set_parameters_file(const QString& path) {
  parameters_->setEditText(path);
}

QString LoaderPage::file() const {
  const QString text = file_->text().trimmed();
  return text.startsWith("~/") ? QDir::home().filePath(text.mid(2)) : text;
}

QString LoaderPage::parameters_file() const {
  const QString text = parameters_->currentText().trimmed();
  return text.startsWith("~/") ? QDir::home().filePath(text.mid(2)) : text;
}

void LoaderPage::look_up() {
  typing_->stop();
  if (file().isEmpty() || summary_) return;
  const auto result = std::make_shared<FileSummary>();
  looking_ = std::make_unique<Job>(
      tr("Looking at %1").arg(file()),
      [result, path = file().toStdString()](Progress&) { *result = summarize_file(path); }, nullptr,
      Job::Unheeded::leave);
  connect(looking_.get(), &Job::done, this, [this, result] {
    looking_.release()->deleteLater();
    take(*result);
  });
  looking_->start();
}

void LoaderPage::take(const FileSummary& summary) {
  if (summary.path != file().toStdString()) return;  // typed on meanwhile
  summary_ = summary;
  update_state();
  if (go_when_known_) go();
}

void LoaderPage::update_state() {
  const bool known = summary_ && summary_->problem.isEmpty();
  const bool atoms = known && summary_->kind == FileKind::atoms;
  kind_->setText(file().isEmpty() ? QString() : !summary_ ? tr("…") : known ? summary_->text : summary_->problem);
  output_box_->setVisible(atoms);
  output_->parentWidget()->setEnabled(format() != OutputFormat::none);
  go_->setText(atoms ? tr("&Preprocess") : tr("&Open"));
  go_->setToolTip(atoms ? tr("Makes volume, surface and defects of the atoms, then shows them")
                        : tr("Shows the sample"));
  QString problem;
  if (atoms) {
    PreprocessingRequest paths;
    paths.input = file().toStdString();
    paths.format = format();
    paths.output = output_->text().trimmed().toStdString();
    output_->setPlaceholderText(QString::fromStdString(default_output(paths.input)));
    QStringList replaced;
    for (const std::string& path : existing_outputs(paths)) {
      replaced << QFileInfo(QString::fromStdString(path)).fileName();
    }
    problem = problem_with(paths);
    output_note_->setText(!problem.isEmpty() ? problem
                          : replaced.isEmpty()
                              ? QString()
                              : tr("%1 is there already and will be replaced").arg(replaced.join(tr(" and "))));
    output_note_->setVisible(!output_note_->text().isEmpty());
    if (problem.isEmpty()) problem = form_->problem();
  }
  go_->setEnabled(known && problem.isEmpty());
}

void LoaderPage::list_recent() {
  recent_list_->clear();
  for (const QString& path : recent_.files()) {
    const QFileInfo info(path);
    auto* item =
        new QListWidgetItem(tr("%1  –  %2").arg(info.fileName(), QDir::toNativeSeparators(info.path())), recent_list_);
    item->setData(Qt::UserRole, path);
    item->setToolTip(path);
    if (recent_.missing(path)) {
      item->setFlags(item->flags() & ~(Qt::ItemIsEnabled | Qt::ItemIsSelectable));
      item->setToolTip(tr("%1 is no longer there").arg(path));
    }
  }
  const QString now = parameters_->currentText();
  parameters_->clear();
  for (const QString& path : recent_parameters_.files()) {
    if (!recent_parameters_.missing(path)) parameters_->addItem(path);
  }
  parameters_->setEditText(now);
}

void LoaderPage::browse() {
  const QString from = !file().isEmpty()            ? QFileInfo(file()).path()
                       : !recent_.files().isEmpty() ? QFileInfo(recent_.files().first()).path()
                                                    : QString();
  const QString path = QFileDialog::getOpenFileName(
      this, tr("Dataset"), from,
      tr("All that can be opened (*.dat *.xyz *.extxyz *.data *.lmp *.lammps *.dump *.lammpstrj *.crb *.crt *.vtu "
         "*.vtk *.node *.ele *.x *.g *.bin *.p3d *.png);;"
         "Atoms (*.dat *.xyz *.extxyz *.data *.lmp *.lammps *.dump *.lammpstrj);;Materials (*.crb *.crt);;"
         "Meshes (*.vtu *.vtk *.node *.ele *.xyz *.x *.g *.bin *.p3d);;Pictures (*.png);;All files (*)"));
  if (!path.isEmpty()) set_file(path);
}

PreprocessingRequest LoaderPage::request() const {
  PreprocessingRequest request;
  request.input = file().toStdString();
  request.format = format();
  request.output = output_->text().trimmed().toStdString();
  request.settings.options = form_->options();
  return request;
}

PreprocessingRequest LoaderPage::unasked_request(const QString& path) const {
  PreprocessingRequest request;
  request.input = path.toStdString();
  request.format = format();
  request.replace = false;
  if (!problem_with(request).isEmpty()) request.format = OutputFormat::none;  // a folder that is read only
  return request;
}

OutputFormat LoaderPage::format() const {
  return static_cast<OutputFormat>(format_->currentData().toInt());
}

void LoaderPage::go() {
  go_when_known_ = false;
  if (!go_->isEnabled() || !summary_) return;
  const QString parameters = parameters_file();
  if (!parameters.isEmpty() && !QFileInfo(parameters).isFile()) {
    show_problem(tr("There is no file of parameters %1; choose another, or none").arg(parameters));
    parameters_->setFocus();
    return;
  }
  if (summary_->kind != FileKind::atoms) {
    emit open_requested(file(), parameters);
    return;
  }
  try {
    emit preprocess_requested(request(), parameters);
  } catch (const UsageError& error) {
    show_problem(QString::fromUtf8(error.what()));
  }
}

void LoaderPage::set_has_view(bool has_view) {
  cancel_->setText(has_view ? tr("&Cancel") : tr("E&xit"));
  cancel_->setToolTip(has_view ? tr("Back to what is open") : tr("Closes the program"));
}

void LoaderPage::show_problem(const QString& problem) {
  problem_->setText(problem);
  problem_->setVisible(!problem.isEmpty());
}

void LoaderPage::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  recent_.look();
  recent_parameters_.look();
  // It may have changed while something else was shown.
  summary_.reset();
  look_up();
  update_state();
  file_->setFocus();
}

}  // namespace atomesh::gui
