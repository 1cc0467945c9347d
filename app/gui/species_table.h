// Color, visibility and radius of each species: one line a species, the editors those of the parameter table.
#pragma once

#include <QWidget>
#include <string>
#include <vector>

class QGridLayout;
class QLabel;

namespace atomesh::gui {

class ParameterField;
class Workspace;

class SpeciesTable : public QWidget {
  Q_OBJECT

 public:
  SpeciesTable(Workspace& workspace, QWidget* parent);
  // "atoms.color.Na", …; of the document's species.
  const std::vector<std::string>& keys() const { return keys_; }

 signals:
  void help_requested(const QString& key);

 private:
  void fill();
  void show_all(bool visible);
  void update_line(std::size_t line);

  struct Line {
    std::string species;
    QLabel* name;
    std::vector<ParameterField*> fields;
    QLabel* message;
  };
  Workspace& workspace_;
  QWidget* content_ = nullptr;  // made anew for other species
  std::vector<Line> lines_;
  std::vector<std::string> keys_;
};

}  // namespace atomesh::gui
