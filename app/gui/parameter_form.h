// A form of rows of the parameter table: label, editor, reset; made from the table, never by hand.
#pragma once

#include <QWidget>
#include <string>
#include <vector>

class QGridLayout;
class QLabel;
class QMenu;
class QToolButton;

namespace atomesh::gui {

class ParameterField;
class Workspace;

class ParameterForm : public QWidget {
  Q_OBJECT

 public:
  // heading: for a form under a heading that says the rest ("Light 1"); place: the group stands in the label.
  enum class Labels { heading, place };
  explicit ParameterForm(Workspace& workspace, QWidget* parent = nullptr);

  // Shows the rows of these keys in this order. Rows once made are kept for the next time.
  void set_keys(const std::vector<std::string>& keys, Labels labels = Labels::heading);
  const std::vector<std::string>& keys() const { return keys_; }
  // Shown or not; nullptr for a key that was never among those shown.
  ParameterField* field(const std::string& key) const;
  // Keys whose value is not the default.
  std::vector<std::string> modified_keys() const;

 signals:
  void edit_color_map_requested();
  void help_requested(const QString& key);

 private:
  struct Row {
    std::string key;
    QLabel* label;
    ParameterField* field;
    QToolButton* reset;
    QLabel* message;
  };
  Row& row_of(const std::string& key, Labels labels);
  void update_row(const Row& row) const;
  void show_menu(const Row& row, const QPoint& place);

  Workspace& workspace_;
  QGridLayout* grid_;
  std::vector<Row> rows_;
  std::vector<std::string> keys_;
};

// What happens to parameters as a whole: those of `keys` back to their defaults, as one step of the history.
void reset_parameters(Workspace& workspace, const std::vector<std::string>& keys, const QString& name);

}  // namespace atomesh::gui
