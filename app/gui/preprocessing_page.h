// The preprocessing window of the manual (B.5): what is done, how long it takes, what comes of it; cancelled any time.
#pragma once

#include <QWidget>
#include <optional>

#include "app/gui/preprocessing.h"

class QCheckBox;
class QLabel;
class QPlainTextEdit;
class QProgressBar;
class QPushButton;
class QTableWidget;
class QTimer;

namespace atomesh::gui {

class PreprocessingPage : public QWidget {
  Q_OBJECT

 public:
  // `settings_file`: an .ini in the place of the program's own settings.
  explicit PreprocessingPage(QWidget* parent = nullptr, const QString& settings_file = {});
  ~PreprocessingPage() override;

  // Shows the run from its beginning; the last one, if it still runs, is cancelled.
  void start(const PreprocessingRequest& request);
  void cancel() { run_.cancel(); }
  const Preprocessing& run() const { return run_; }

 signals:
  // To rendering: asked for, or by itself when that is wanted and nothing needs to be read first.
  void go_on(const atomesh::gui::Document& document);
  // With the file that was written, else the one that was read.
  void back_to_loader(const QString& file);
  void said(const QString& line);  // every line of the log
  void state_changed();            // of the run

 protected:
  void keyPressEvent(QKeyEvent* event) override;  // Escape cancels

 private:
  QWidget* make_table();
  QWidget* make_buttons();
  void show_plan();
  void mark_running(const QString& name);
  void show_row(const StageRow& row);
  void finish(const QString& status);
  void leave_out(int from, int to);
  void write(const QString& line);  // into the page's own log
  void log(const QString& line);    // and into everybody's
  void show_buttons();

  Preprocessing run_;
  QString settings_file_;
  QLabel* title_ = nullptr;
  QLabel* status_ = nullptr;
  QTableWidget* stages_ = nullptr;
  QProgressBar* bar_ = nullptr;
  QPlainTextEdit* log_ = nullptr;
  QCheckBox* automatic_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QPushButton* again_ = nullptr;
  QPushButton* back_ = nullptr;
  QPushButton* go_on_ = nullptr;
  int next_row_ = 0;  // of the first stage that is not finished
};

}  // namespace atomesh::gui
