// The settings of preprocessing as a form: a row an option of the command line, hidden until they are asked for.
#pragma once

#include <QWidget>
#include <map>
#include <string>

#include "app/gui/pipeline_settings.h"

class QLabel;
class QLineEdit;
class QToolButton;

namespace atomesh::gui {

class PipelineForm : public QWidget {
  Q_OBJECT

 public:
  explicit PipelineForm(QWidget* parent = nullptr);

  // Those that are not the default.
  PipelineValues values() const;
  void set_values(const PipelineValues& values);
  // What is wrong with them, or "".
  QString problem() const;
  // Throws UsageError.
  PipelineOptions options() const { return pipeline_options(values()); }
  void open(bool opened);

 signals:
  void changed();

 private:
  QWidget* make_field(const PipelineSetting& setting);
  QWidget* make_table();
  void show_state();

  QToolButton* opener_;
  QWidget* table_;
  QLabel* message_;
  std::map<std::string, QWidget*> fields_;  // QLineEdit or QComboBox, by option
};

}  // namespace atomesh::gui
