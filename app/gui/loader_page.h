// The loader of the manual (B.4): which file, what becomes of it, with which parameters.
#pragma once

#include <QWidget>
#include <memory>

#include "app/gui/file_summary.h"
#include "app/gui/preprocessing.h"
#include "app/gui/recent_files.h"

class QComboBox;
class QGroupBox;
class QLabel;
class QLineEdit;
class QListWidget;
class QPushButton;
class QTimer;

namespace atomesh::gui {

class Job;
class PipelineForm;

// What is chosen decides what is asked: of a file of atoms the output format, of all others nothing but an optional
// .crf. The file's kind is looked up beside the window as soon as its name stands there.
class LoaderPage : public QWidget {
  Q_OBJECT

 public:
  // `settings_file`: an .ini in the place of the program's own settings, for the recent files and what was chosen last.
  explicit LoaderPage(QWidget* parent = nullptr, const QString& settings_file = {});
  ~LoaderPage() override;

  void set_file(const QString& path);
  void set_parameters_file(const QString& path);
  QString file() const;
  QString parameters_file() const;
  // Of the file that stands there; nothing while it is looked up.
  const std::optional<FileSummary>& summary() const { return summary_; }
  // What [Preprocess] would ask for. Throws UsageError for settings that are none.
  PreprocessingRequest request() const;
  // Atoms as they would be preprocessed without being asked: the format chosen last, default settings, and nothing
  // that is there is replaced.
  PreprocessingRequest unasked_request(const QString& path) const;

  RecentFiles& recent_files() { return recent_; }
  RecentFiles& recent_parameters() { return recent_parameters_; }
  // Whether there is a view to go back to by [Cancel]; else it closes the window.
  void set_has_view(bool has_view);
  // Where nobody overlooks it; "" takes it away.
  void show_problem(const QString& problem);

 signals:
  void open_requested(const QString& path, const QString& parameters);  // a .crf, or ""
  void preprocess_requested(const atomesh::gui::PreprocessingRequest& request, const QString& parameters);
  void cancelled();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  QWidget* make_file_box();
  QWidget* make_recent_box();
  QWidget* make_output_box();
  QWidget* make_parameters_box();
  QWidget* make_buttons();
  void look_up();
  void take(const FileSummary& summary);
  void update_state();
  void list_recent();
  void browse();
  void go();
  OutputFormat format() const;

  RecentFiles recent_;
  RecentFiles recent_parameters_;
  QString settings_file_;
  QLineEdit* file_ = nullptr;
  QLabel* kind_ = nullptr;
  QListWidget* recent_list_ = nullptr;
  QGroupBox* output_box_ = nullptr;
  QComboBox* format_ = nullptr;
  QLineEdit* output_ = nullptr;
  QLabel* output_note_ = nullptr;
  PipelineForm* form_ = nullptr;
  QComboBox* parameters_ = nullptr;
  QLabel* problem_ = nullptr;
  QPushButton* go_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QTimer* typing_ = nullptr;
  std::optional<FileSummary> summary_;
  bool go_when_known_ = false;
  std::unique_ptr<Job> looking_;
};

}  // namespace atomesh::gui
