#include "app/gui/parameter_history.h"

#include <utility>

namespace atomesh::gui {

void ParameterHistory::add(const Step& step) {
  undo_.push_back(step);
  if (undo_.size() > most_steps) undo_.erase(undo_.begin());
}

bool ParameterHistory::change(const Parameters& to, const std::string& name, const std::string& gesture) {
  if (to == now_) return false;
  const bool goes_on = !gesture.empty() && gesture == gesture_ && !undo_.empty();
  if (!goes_on) add({now_, name, std::nullopt});
  gesture_ = gesture;
  redo_.clear();
  now_ = to;
  return true;
}

bool ParameterHistory::change(const Parameters& to, const std::string& name, const PartsChange& parts) {
  if (parts.before == parts.after) return change(to, name);
  add({now_, name, parts});
  gesture_.clear();
  redo_.clear();
  now_ = to;
  return true;
}

std::optional<cli::PictureParts> ParameterHistory::undo() {
  if (undo_.empty()) return std::nullopt;
  Step step = std::move(undo_.back());
  undo_.pop_back();
  std::swap(step.other, now_);
  gesture_.clear();
  redo_.push_back(std::move(step));
  const auto& parts = redo_.back().parts;
  return parts ? std::optional(parts->before) : std::nullopt;
}

std::optional<cli::PictureParts> ParameterHistory::redo() {
  if (redo_.empty()) return std::nullopt;
  Step step = std::move(redo_.back());
  redo_.pop_back();
  std::swap(step.other, now_);
  gesture_.clear();
  undo_.push_back(std::move(step));
  const auto& parts = undo_.back().parts;
  return parts ? std::optional(parts->after) : std::nullopt;
}

}  // namespace atomesh::gui
