#include "app/gui/parameter_history.h"

#include <utility>

namespace atomesh::gui {

bool ParameterHistory::change(const Parameters& to, const std::string& name, const std::string& gesture) {
  if (to == now_) return false;
  const bool goes_on = !gesture.empty() && gesture == gesture_ && !undo_.empty();
  if (!goes_on) {
    undo_.push_back({now_, name});
    if (undo_.size() > most_steps) undo_.erase(undo_.begin());
  }
  gesture_ = gesture;
  redo_.clear();
  now_ = to;
  return true;
}

void ParameterHistory::undo() {
  if (undo_.empty()) return;
  Step step = std::move(undo_.back());
  undo_.pop_back();
  std::swap(step.other, now_);
  redo_.push_back(std::move(step));
  gesture_.clear();
}

void ParameterHistory::redo() {
  if (redo_.empty()) return;
  Step step = std::move(redo_.back());
  redo_.pop_back();
  std::swap(step.other, now_);
  undo_.push_back(std::move(step));
  gesture_.clear();
}

}  // namespace atomesh::gui
