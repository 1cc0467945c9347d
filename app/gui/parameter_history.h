// Undo and redo of changes to the parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/picture_text.h"
#include "core/parameters.h"

namespace atomesh::gui {

// The steps that can be undone, oldest first. A step has a name for the menu ("Face alpha constant") and a gesture:
// consecutive changes of one gesture that is not "" (a slider that is dragged, a turn of the view) are one step.
class ParameterHistory {
 public:
  explicit ParameterHistory(Parameters now = {}) : now_(std::move(now)) {}

  const Parameters& now() const { return now_; }
  // Does nothing, and returns false, when nothing changes. What was undone can no longer be redone.
  bool change(const Parameters& to, const std::string& name, const std::string& gesture = "");
  // What lies over the view is no parameter; a step may go along with a change of it all the same, whose two ends
  // undo() and redo() give back. Does nothing, and returns false, when neither changes.
  struct PartsChange {
    cli::PictureParts before;
    cli::PictureParts after;
  };
  bool change(const Parameters& to, const std::string& name, const PartsChange& parts);
  // The next change is a step of its own whatever its gesture.
  void end_gesture() { gesture_.clear(); }

  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  // Return what is to lie over the view, for steps that go along with a change of it.
  std::optional<cli::PictureParts> undo();
  std::optional<cli::PictureParts> redo();
  // Names of the steps that undo() and redo() would take; "" when there is none.
  std::string undo_name() const { return undo_.empty() ? "" : undo_.back().name; }
  std::string redo_name() const { return redo_.empty() ? "" : redo_.back().name; }

 private:
  struct Step {
    Parameters other;  // what undoing, or redoing, brings back
    std::string name;
    std::optional<PartsChange> parts;
  };
  void add(const Step& step);

  static constexpr std::size_t most_steps = 1000;

  Parameters now_;
  std::vector<Step> undo_;
  std::vector<Step> redo_;
  std::string gesture_;
};

}  // namespace atomesh::gui
