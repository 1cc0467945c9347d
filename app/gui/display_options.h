// The dock "Display options" (manual, B.6.2): background, render mode, shading, lights, cut planes, view and what lies
// over the picture. Its rows come from the parameter table.
#pragma once

#include <QWidget>
#include <string>
#include <vector>

class QAction;
class QComboBox;
class QSpinBox;
class QToolButton;
class QVBoxLayout;

namespace atomesh::gui {

class ParameterForm;
class Section;
class Workspace;

class DisplayOptions : public QWidget {
  Q_OBJECT

 public:
  DisplayOptions(Workspace& workspace, QWidget* parent);

 signals:
  void full_screen_requested();
  void reset_orientation_requested();
  // A page of help_pages(), or a parameter's key.
  void help_requested(const QString& topic);

 private:
  // A light or a cut plane: its form under a heading with what can be done to it.
  struct Part {
    Section* section = nullptr;
    ParameterForm* form = nullptr;
  };
  void build_buttons(QVBoxLayout& layout);
  // Folded, or not, as it was left the last time.
  Section* add_section(QVBoxLayout& layout, const QString& title, const QString& help,
                       const std::vector<std::string>& keys, bool folded = false);
  void build_lights(QVBoxLayout& layout);
  void build_cut_planes(QVBoxLayout& layout);
  void build_overlay(QVBoxLayout& layout);
  ParameterForm* make_form(QWidget* parent, const std::vector<std::string>& keys);
  QToolButton* make_button(Section* section, const QString& text, const QString& tip, const char* name);
  void follow_parameters();
  void show_parts(std::vector<Part>& parts, int count, Section& section, const char* prefix);
  Part make_light(int n, QWidget* parent);
  Part make_cut_plane(int n, QWidget* parent);
  void title_cut_planes();
  void open_miller_cut(int n);

  Workspace& workspace_;
  QSpinBox* light_count_ = nullptr;
  QSpinBox* cut_plane_count_ = nullptr;
  Section* lights_section_ = nullptr;
  Section* cut_planes_section_ = nullptr;
  std::vector<Part> lights_;  // made when first needed
  std::vector<Part> cut_planes_;
};

}  // namespace atomesh::gui
