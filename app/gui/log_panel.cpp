#include "app/gui/log_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QDir>
#include <QFileDialog>
#include <QFontDatabase>
#include <QHBoxLayout>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTextCursor>
#include <QTime>
#include <QVBoxLayout>

#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::gui {

namespace {

constexpr int most_lines = 10000;

}  // namespace

LogPanel::LogPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName("log_panel");
  setWindowTitle(tr("Log"));
  lines_ = new QPlainTextEdit(this);
  lines_->setObjectName("log_lines");
  lines_->setAccessibleName(tr("Log"));
  lines_->setReadOnly(true);
  lines_->setMaximumBlockCount(most_lines);
  lines_->setLineWrapMode(QPlainTextEdit::WidgetWidth);
  lines_->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
  lines_->setPlaceholderText(tr("What the program does and notices is written here."));
  lines_->setTabChangesFocus(true);
  lines_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);

  const auto button = [this](const QString& text, const char* name, const QString& tip) {
    auto* made = new QPushButton(text, this);
    made->setObjectName(name);
    made->setToolTip(tip);
    return made;
  };
  copy_ = button(tr("Co&py"), "log_copy", tr("The selected lines, or all"));
  save_ = button(tr("&Save…"), "log_save", tr("All lines to a file"));
  clear_ = button(tr("C&lear"), "log_clear", tr("Forget the lines so far"));
  connect(copy_, &QPushButton::clicked, this, &LogPanel::copy);
  connect(save_, &QPushButton::clicked, this, &LogPanel::ask_where_to_write);
  connect(clear_, &QPushButton::clicked, this, &LogPanel::clear);
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  buttons->addWidget(copy_);
  buttons->addWidget(save_);
  buttons->addWidget(clear_);
  auto* all = new QVBoxLayout(this);
  all->addWidget(lines_, 1);
  all->addLayout(buttons);
  connect(&workspace, &Workspace::said, this, &LogPanel::add);
  show_buttons();
}

void LogPanel::add(const QString& message) {
  // Lines after the first of a message stand under its text.
  const QString time = QTime::currentTime().toString("HH:mm:ss.zzz") + "  ";
  QString line = message;
  line.replace('\n', '\n' + QString(time.size(), ' '));
  lines_->appendPlainText(time + line);
  show_buttons();
}

void LogPanel::show_buttons() {
  const bool any = !lines_->document()->isEmpty();
  for (QPushButton* one : {copy_, save_, clear_}) one->setEnabled(any);
}

QString LogPanel::text() const {
  const QString lines = lines_->toPlainText();
  return lines.isEmpty() ? lines : lines + '\n';
}

void LogPanel::copy() {
  const QTextCursor cursor = lines_->textCursor();
  // Qt's own sign between the lines of a selection.
  QApplication::clipboard()->setText(cursor.hasSelection() ? cursor.selectedText().replace(QChar(0x2029), '\n')
                                                           : text());
}

void LogPanel::clear() {
  lines_->clear();
  show_buttons();
}

void LogPanel::write(const QString& path) {
  try {
    AtomicFile file(path.toStdString());
    file.write(text().toStdString());
    file.commit();
  } catch (const Error& error) {
    workspace_.complain(QString::fromUtf8(error.what()));
  }
}

void LogPanel::ask_where_to_write() {
  auto* dialog = new QFileDialog(this, tr("Save log"), QDir::homePath(), tr("Text (*.log *.txt)"));
  dialog->setObjectName("log_file_dialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix("log");
  dialog->selectFile("atomesh.log");
  connect(dialog, &QFileDialog::fileSelected, this, &LogPanel::write);
  dialog->open();
}

}  // namespace atomesh::gui
