// The editor of one row of the parameter table: shows the workspace's value and changes it.
#pragma once

#include <QString>
#include <QWidget>
#include <string>

#include "core/parameters.h"

namespace atomesh::gui {

class Workspace;

// Made by make_parameter_field(). Its objectName is the key; its parts are called "KEY/box", "KEY/slider", …. What the
// table refuses stays in the editor, with error() saying what is allowed, until it is put right or given up (Escape),
// or the value changes elsewhere.
class ParameterField : public QWidget {
  Q_OBJECT

 public:
  ~ParameterField() override;
  const std::string& key() const { return key_; }
  bool modified() const { return text_ != default_text_; }
  const QString& error() const { return error_; }

  // Shows the workspace's value; cheap when it is the one shown. Who makes the field calls it at every
  // Workspace::parameters_changed().
  void refresh();
  // The same when the document or the cut planes changed: what depends on them beside the value.
  virtual void refresh_context() {}
  // Leaves out what is not needed to change the value (a slider), for a line with other editors.
  virtual void make_compact() {}
  void reset();
  void paste();       // a value as text from the clipboard
  void copy() const;  // and into it

 signals:
  void state_changed();  // modified() or error() may be another
  void edit_color_map_requested();

 protected:
  ParameterField(Workspace& workspace, std::string key, QWidget* parent);

  virtual void show_text(const std::string& text) = 0;
  // Changes the parameter; true when that was possible. Consecutive ones are one step of the history up to end_edit().
  bool commit(const std::string& text);
  // A change of its own.
  bool commit_once(const std::string& text);
  void end_edit();
  void clear_error();
  const std::string& text() const { return text_; }
  // Name for a part, tool tip, and no turning of the wheel without focus.
  void add_part(QWidget* part, const char* name);

  Workspace& workspace_;
  const ParameterRow& row_;

 private:
  void set_error(const QString& error);

  std::string key_;
  std::string text_;  // the value that is shown
  std::string default_text_;
  QString error_;
};

// The editor that suits the row: a check box, a spin box with a slider where the range can be shown, a combo box, a
// color button (with opacity), three spin boxes, a name, a color map. Throws UsageError for a key that there is not.
ParameterField* make_parameter_field(Workspace& workspace, const std::string& key, QWidget* parent);

}  // namespace atomesh::gui
