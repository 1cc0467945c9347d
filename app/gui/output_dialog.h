// A dialog that writes a file beside the window: where to, what it will be, how far it is, and a way to stop it.
#pragma once

#include <QDialog>
#include <memory>

#include "app/gui/job.h"
#include "app/gui/workspace.h"

class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QVBoxLayout;

namespace atomesh::gui {

class OutputDialog : public QDialog {
  Q_OBJECT

 public:
  OutputDialog(Workspace& workspace, const QString& name, const QString& ending, QWidget* parent);
  ~OutputDialog() override;

  QString path() const;  // absolute
  void set_path(const QString& path);
  bool working() const { return job_ != nullptr; }

 signals:
  void saved(const QString& path);

 public slots:
  // Asks before something is written over, then works.
  void save();
  void reject() override;  // stops the work first

 protected:
  // What is between the file's name and the buttons; before the first finish_building().
  QVBoxLayout& content() { return *content_; }
  void finish_building();
  void showEvent(QShowEvent* event) override;
  // Says in the dialog what will be made or why it cannot be; the button goes by it.
  void check();

  // For QFileDialog: "Pictures (*.png)".
  virtual QString filter() const = 0;
  // What will be made ("3,840 × 2,160 pixels …"). Throws Error with what is wrong.
  virtual QString plan() = 0;
  // The files that will be written over.
  virtual QStringList in_the_way() const;
  // Called on the window's thread; must own all that it touches.
  virtual Job::Work work() const = 0;

  Workspace& workspace_;

 private:
  void browse();
  void propose_path();  // named like what is open, in the folder of the last
  void align_labels();
  void start();
  void show_working(bool on);
  void say(const QString& text, bool wrong);

  QVBoxLayout* content_ = nullptr;
  QLabel* file_label_ = nullptr;
  QLineEdit* file_ = nullptr;
  QLabel* says_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QWidget* inputs_ = nullptr;
  QString ending_;
  QString asked_for_;  // the file the user agreed to write over by choosing it
  std::unique_ptr<Job> job_;
};

}  // namespace atomesh::gui
