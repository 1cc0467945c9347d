#include "app/gui/output_dialog.h"

#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>
#include <algorithm>
#include <vector>

#include "app/gui/theme.h"
#include "core/error.h"

namespace atomesh::gui {

OutputDialog::OutputDialog(Workspace& workspace, const QString& name, const QString& ending, QWidget* parent)
    : QDialog(parent), workspace_(workspace), ending_(ending) {
  setObjectName(name);
  auto* all = new QVBoxLayout(this);
  inputs_ = new QWidget(this);
  content_ = new QVBoxLayout(inputs_);
  content_->setContentsMargins(0, 0, 0, 0);
  all->addWidget(inputs_);
  auto* row = new QHBoxLayout;
  file_label_ = new QLabel(tr("&File"), this);
  file_ = new QLineEdit(this);
  file_->setObjectName(name + "_file");
  file_->setMinimumWidth(fontMetrics().averageCharWidth() * 38);
  file_label_->setBuddy(file_);
  auto* choose = new QPushButton(tr("C&hoose…"), this);
  choose->setObjectName(name + "_choose");
  choose->setAutoDefault(false);
  row->addWidget(file_label_);
  row->addWidget(file_, 1);
  row->addWidget(choose);
  content_->addLayout(row);
  says_ = new QLabel(this);
  says_->setObjectName(name + "_says");
  says_->setWordWrap(true);
  says_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  progress_ = new QProgressBar(this);
  progress_->setObjectName(name + "_progress");
  progress_->setRange(0, 1000);
  progress_->setTextVisible(true);
  auto* buttons = new QDialogButtonBox(this);
  save_ = buttons->addButton(QDialogButtonBox::Save);
  save_->setObjectName(name + "_save");
  save_->setDefault(true);
  cancel_ = buttons->addButton(QDialogButtonBox::Cancel);
  cancel_->setObjectName(name + "_cancel");
  all->addWidget(says_);
  all->addWidget(progress_);
  all->addStretch(1);
  all->addWidget(buttons);
  connect(choose, &QPushButton::clicked, this, &OutputDialog::browse);
  connect(file_, &QLineEdit::textChanged, this, &OutputDialog::check);
  connect(save_, &QPushButton::clicked, this, &OutputDialog::save);
  connect(cancel_, &QPushButton::clicked, this, &OutputDialog::reject);
  QSizePolicy keeps_its_place = progress_->sizePolicy();
  keeps_its_place.setRetainSizeWhenHidden(true);
  progress_->setSizePolicy(keeps_its_place);
  progress_->hide();
}

OutputDialog::~OutputDialog() = default;

void OutputDialog::finish_building() {
  propose_path();
  align_labels();
  connect(&workspace_, &Workspace::shown_changed, this, &OutputDialog::check);
  connect(&workspace_, &Workspace::document_changed, this, &OutputDialog::propose_path);
}

void OutputDialog::propose_path() {
  if (working()) return;
  const auto& document = workspace_.document();
  const QFileInfo sample(document ? QString::fromStdString(document->path) : QString("picture"));
  const QString folder = QSettings().value("output/folder").toString();
  const QDir dir(folder.isEmpty() || !QDir(folder).exists() ? sample.absolutePath() : folder);
  const QString ending = QFileInfo(path()).suffix();
  set_path(dir.filePath(sample.completeBaseName() + (ending.isEmpty() ? ending_ : "." + ending)));
}

// The fields of all the forms begin at one line.
void OutputDialog::align_labels() {
  std::vector<QWidget*> labels{file_label_};
  for (const QFormLayout* form : findChildren<QFormLayout*>()) {
    for (int row = 0; row < form->rowCount(); ++row) {
      const QLayoutItem* const label = form->itemAt(row, QFormLayout::LabelRole);
      if (label != nullptr && label->widget() != nullptr) labels.push_back(label->widget());
    }
  }
  int widest = 0;
  for (const QWidget* label : labels) widest = std::max(widest, label->sizeHint().width());
  for (QWidget* label : labels) label->setMinimumWidth(widest);
}

// The name without folder and ending is what is most often typed anew.
void OutputDialog::showEvent(QShowEvent* event) {
  QDialog::showEvent(event);
  check();  // also the colors of what it says go by the theme
  file_->setFocus();
  const QFileInfo info(file_->text());
  file_->setSelection(static_cast<int>(file_->text().size() - info.fileName().size()),
                      static_cast<int>(info.completeBaseName().size()));
}

QString OutputDialog::path() const {
  const QString text = file_->text().trimmed();
  if (text.isEmpty()) return {};
  const QFileInfo info(text);
  return QDir::cleanPath(info.isAbsolute() ? text : QDir::current().filePath(text));
}

void OutputDialog::set_path(const QString& path) {
  file_->setText(QDir::toNativeSeparators(path));
  check();
}

void OutputDialog::browse() {
  const QString chosen = QFileDialog::getSaveFileName(this, windowTitle(), path(), filter());
  if (chosen.isEmpty()) return;
  set_path(QFileInfo(chosen).suffix().isEmpty() ? chosen + ending_ : chosen);
  asked_for_ = this->path();
}

void OutputDialog::say(const QString& text, bool wrong) {
  says_->setText(text);
  QPalette palette = this->palette();
  if (wrong) palette.setColor(QPalette::WindowText, error_color(palette));
  says_->setPalette(palette);
}

void OutputDialog::check() {
  if (working()) return;
  bool can = false;
  if (!workspace_.document()) {
    say(tr("Nothing is open"), true);
  } else if (path().isEmpty()) {
    say(tr("Name the file"), true);
  } else {
    try {
      say(plan(), false);
      can = true;
    } catch (const Error& error) {
      say(QString::fromUtf8(error.what()), true);
    }
  }
  save_->setEnabled(can);
}

QStringList OutputDialog::in_the_way() const {
  return QFileInfo::exists(path()) ? QStringList{path()} : QStringList{};
}

void OutputDialog::save() {
  check();
  if (working() || !save_->isEnabled()) return;
  const QStringList files = in_the_way();
  if (files.isEmpty() || asked_for_ == path()) {
    start();
    return;
  }
  const QString name = QFileInfo(files.first()).fileName();
  auto* box = new QMessageBox(QMessageBox::Question, windowTitle(),
                              files.size() == 1 ? tr("%1 is there already. Replace it?").arg(name)
                                                : tr("%1 and %n more are there already. Replace them?", nullptr,
                                                     static_cast<int>(files.size()) - 1)
                                                      .arg(name),
                              QMessageBox::Cancel, this);
  box->setObjectName("replace");
  box->setAttribute(Qt::WA_DeleteOnClose);
  QPushButton* replace = box->addButton(tr("&Replace"), QMessageBox::AcceptRole);
  replace->setObjectName("replace_yes");
  connect(replace, &QPushButton::clicked, this, &OutputDialog::start);
  box->open();
}

void OutputDialog::start() {
  try {
    job_ = std::make_unique<Job>(windowTitle(), work(), nullptr, Job::Unheeded::leave);
  } catch (const Error& error) {
    say(QString::fromUtf8(error.what()), true);
    return;
  }
  const QString file = path();
  connect(job_.get(), &Job::progressed, this, [this](const QString& stage, double fraction) {
    const bool drawing = stage == "render" || stage == "turntable";
    progress_->setRange(0, drawing ? 1000 : 0);  // a busy one until it is known how much there is to do
    if (drawing) progress_->setValue(static_cast<int>(1000.0 * fraction));
  });
  connect(job_.get(), &Job::done, this, [this, file] {
    job_.release()->deleteLater();
    show_working(false);
    asked_for_.clear();
    QSettings().setValue("output/folder", QFileInfo(file).absolutePath());
    workspace_.say(tr("Saved %1").arg(QDir::toNativeSeparators(file)));
    emit saved(file);
    accept();
  });
  connect(job_.get(), &Job::cancelled, this, [this] {
    job_.release()->deleteLater();
    show_working(false);
    say(tr("Cancelled; nothing was written"), false);
  });
  connect(job_.get(), &Job::failed, this, [this](const QString& message) {
    job_.release()->deleteLater();
    show_working(false);
    say(message, true);
  });
  show_working(true);
  job_->start();
}

void OutputDialog::show_working(bool on) {
  inputs_->setEnabled(!on);
  save_->setEnabled(!on);
  progress_->setVisible(on);
  progress_->setRange(0, 0);
  cancel_->setEnabled(true);
  if (!on) check();
}

void OutputDialog::reject() {
  if (working()) {
    cancel_->setEnabled(false);
    say(tr("Stopping…"), false);
    job_->cancel();
    return;
  }
  QDialog::reject();
}

}  // namespace atomesh::gui
