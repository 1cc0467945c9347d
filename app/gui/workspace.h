// The window without its widgets: what is open, what is chosen, what is marked. Docks and viewport change it and follow
// its signals; they know nothing of each other. Lives on the window's thread.
#pragma once

#include <QObject>
#include <QString>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/gui/document.h"
#include "app/gui/parameter_history.h"
#include "app/gui/pick.h"

namespace atomesh::gui {

class Job;

// How the view looks beside the parameters; kept with the program's settings, not in .crf.
struct ViewOptions {
  bool legend = true;
  bool scale_bar = true;
  bool tripod = true;
  bool cut_handles = true;  // of the enabled cut planes, in the window only
  bool upright = true;      // turning keeps z up, as OVITO does; else freely about the picture's axes
  // Who draws volume, surface and atom balls. automatic: the graphics card where there is one, else (OpenGL in
  // software) cpu.
  enum class Drawing { automatic, gpu, cpu } drawing = Drawing::automatic;
  bool operator==(const ViewOptions&) const = default;
};

// A sphere or, with radius 0, a point that is marked in the view.
struct Mark {
  Vec3 position{0.0};   // Å
  double radius = 0.0;  // Å
  Vec4f color{1.0F, 0.6F, 0.0F, 1.0F};
  std::string text;
  bool operator==(const Mark&) const = default;
};

class Workspace : public QObject {
  Q_OBJECT

 public:
  explicit Workspace(QObject* parent = nullptr);
  ~Workspace() override;

  // --- what is open; none before the first
  const std::optional<Document>& document() const { return document_; }
  // Takes its place, with `parameters`, or with those there are but the view and the cut planes of the defaults. Clears
  // the history, the picks and the marks. Emits document_changed(), then shown_changed().
  void show_document(Document document, const std::optional<Parameters>& parameters = std::nullopt);
  void close_document();
  // Reads what is missing of the document, beside the window; emits parts_changed() when it is there, and at once
  // nothing when nothing is missing. The mode's own parts are asked for by the workspace itself.
  void need_parts(const MaterialParts& parts);
  bool has_parts(const MaterialParts& parts) const { return document_ && covers(document_->parts, parts); }

  // --- what is chosen: the parameters as the forms show them
  const Parameters& parameters() const { return history_.now(); }
  // `name` is what the Undo menu says; see ParameterHistory for gestures. Throws UsageError (and changes nothing) for
  // values that the table refuses.
  void change(const Parameters& to, const QString& name, const std::string& gesture = "");
  // What a picture brings back: the parameters, and what lies over the view, as one step of the history.
  void change_look(const Parameters& to, const cli::PictureParts& parts, const QString& name);
  // One row of the table, see set_parameter(); the name is the row's label, the gesture the key. Throws UsageError.
  void set(const std::string& key, const std::string& text);
  void reset(const std::string& key);  // to the default
  void end_gesture() { history_.end_gesture(); }
  const ParameterHistory& history() const { return history_; }
  void undo();
  void redo();

  // --- and as they are drawn: a mode whose auto apply is off keeps its own group (volume_surface.*, volume.*, …) as it
  // was when last applied
  const Parameters& shown() const { return shown_; }
  bool auto_apply(Mode mode) const { return auto_apply_[static_cast<std::size_t>(mode)]; }
  void set_auto_apply(Mode mode, bool on);  // switching it on applies
  bool apply_pending(Mode mode) const;      // parameters() and shown() differ in the mode's group
  void apply(Mode mode);

  // --- view
  const ViewOptions& view_options() const { return view_options_; }
  void set_view_options(const ViewOptions& options);
  // Legend, scale bar and tripod of them.
  void show_parts(const cli::PictureParts& parts);
  // What turning turns about, Å; the middle of the sample until set. No picture changes by setting it.
  const Vec3& rotation_center() const { return rotation_center_; }
  void set_rotation_center(const Vec3& center);
  void reset_rotation_center();
  // Of the whole sample, as Scene::bounds for the shown mode; empty without a document.
  const Bounds& bounds() const { return bounds_; }
  // Pixels of the viewport (device pixels), for who makes the camera; 1 × 1 before it is shown.
  int width() const { return width_; }
  int height() const { return height_; }
  void set_view_size(int width, int height);
  // The camera of shown() and the viewport's size.
  Camera camera() const;

  // --- what is picked and marked
  const std::vector<Pick>& picks() const { return picks_; }  // none, one, or two between which is measured
  // `second`: beside the one there is, to measure; else instead.
  void add_pick(const Pick& pick, bool second);
  void clear_picks();
  const std::vector<Mark>& marks() const { return marks_; }  // besides those of the picks
  void set_marks(std::vector<Mark> marks);

  // --- what is said
  void say(const QString& message);                      // a line of the log
  void complain(const QString& message);                 // and where nobody overlooks it
  void note_times(const std::vector<StageTime>& times);  // of what was last done, for the timing panel

 signals:
  void document_changed();
  void parts_changed();
  void parameters_changed();  // those of the forms, with undo and redo
  void shown_changed();       // what is drawn must be drawn anew: parameters, document, parts, or the size
  void apply_changed();       // auto apply or what is pending
  void view_options_changed();
  void view_size_changed();
  void picks_changed();
  void marks_changed();
  void said(const QString& message);
  void complained(const QString& message);
  void times_changed(const std::vector<atomesh::StageTime>& times);
  void job_started(atomesh::gui::Job* job);  // a job of the workspace's own, for the progress bar

 private:
  void follow_parameters();
  void load_missing_parts();
  void update_bounds();

  std::optional<Document> document_;
  ParameterHistory history_;
  Parameters shown_;
  std::array<bool, 5> auto_apply_;
  ViewOptions view_options_;
  Vec3 rotation_center_{0.0};
  bool own_rotation_center_ = false;
  Bounds bounds_;
  int width_ = 1;
  int height_ = 1;
  std::vector<Pick> picks_;
  std::vector<Mark> marks_;
  MaterialParts wanted_;
  std::unique_ptr<Job> loading_;
};

}  // namespace atomesh::gui
