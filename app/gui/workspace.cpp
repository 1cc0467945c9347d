#include "app/gui/workspace.h"

#include <utility>

#include "app/gui/job.h"
#include "app/gui/navigation.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr std::array modes{Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms};

// Makes the mode's own group of `to` that of `from`.
void take_group(Parameters& to, const Parameters& from, Mode mode) {
  switch (mode) {
    case Mode::volume_surface:
      to.volume_surface = from.volume_surface;
      break;
    case Mode::volume:
      to.volume = from.volume;
      break;
    case Mode::surface:
      to.surface = from.surface;
      break;
    case Mode::xray:
      to.xray = from.xray;
      break;
    case Mode::atoms:
      to.atoms = from.atoms;
      break;
  }
}

// What belongs to one sample and not to the next: where it is looked at and cut, what of it is shown.
Parameters for_another_sample(const Parameters& parameters) {
  const Parameters defaults;
  Parameters next = parameters;
  reset_orientation(next);
  next.cut_planes = defaults.cut_planes;
  next.volume.field = defaults.volume.field;
  next.volume.range_low = defaults.volume.range_low;
  next.volume.range_high = defaults.volume.range_high;
  return next;
}

}  // namespace

Workspace::Workspace(QObject* parent) : QObject(parent) {
  auto_apply_.fill(true);
}

Workspace::~Workspace() = default;

void Workspace::show_document(Document document, const std::optional<Parameters>& parameters) {
  loading_.reset();
  wanted_ = document.parts;
  document_ = std::move(document);
  history_ = ParameterHistory(parameters ? *parameters : for_another_sample(history_.now()));
  shown_ = history_.now();
  own_rotation_center_ = false;
  picks_.clear();
  marks_.clear();
  update_bounds();
  emit document_changed();
  emit parameters_changed();
  emit apply_changed();
  emit picks_changed();
  emit marks_changed();
  for (const std::string& note : document_->notes) say(QString::fromStdString(note));
  note_times(document_->times);
  load_missing_parts();
  emit shown_changed();
}

void Workspace::close_document() {
  loading_.reset();
  document_.reset();
  picks_.clear();
  marks_.clear();
  update_bounds();
  emit document_changed();
  emit picks_changed();
  emit marks_changed();
  emit shown_changed();
}

void Workspace::need_parts(const MaterialParts& parts) {
  if (!document_) return;
  wanted_ = united(wanted_, parts);
  load_missing_parts();
}

void Workspace::load_missing_parts() {
  if (!document_ || document_->kind != FileKind::material) return;
  wanted_ = united(wanted_, parts_needed(shown_));
  if (covers(document_->parts, wanted_)) return;
  const auto result = std::make_shared<std::optional<Document>>();
  loading_ = std::make_unique<Job>(tr("Reading %1").arg(QString::fromStdString(document_->path)),
                                   [result, document = *document_, wanted = wanted_](Progress& progress) {
                                     *result = with_parts(document, wanted, progress);
                                   });
  connect(loading_.get(), &Job::done, this, [this, result] {
    loading_.release()->deleteLater();
    document_ = std::move(**result);
    note_times(document_->times);
    emit parts_changed();
    emit shown_changed();
    load_missing_parts();  // what was asked for meanwhile
  });
  connect(loading_.get(), &Job::failed, this, [this](const QString& message) {
    loading_.release()->deleteLater();
    complain(message);
  });
  emit job_started(loading_.get());
  loading_->start();
}

void Workspace::change(const Parameters& to, const QString& name, const std::string& gesture) {
  check_parameters(to);
  if (history_.change(to, name.toStdString(), gesture)) follow_parameters();
}

void Workspace::change_look(const Parameters& to, const cli::PictureParts& parts, const QString& name) {
  check_parameters(to);
  const cli::PictureParts before{
      .legend = view_options_.legend, .scale_bar = view_options_.scale_bar, .tripod = view_options_.tripod};
  if (!history_.change(to, name.toStdString(), {.before = before, .after = parts})) return;
  show_parts(parts);
  follow_parameters();
}

void Workspace::set(const std::string& key, const std::string& text) {
  Parameters to = parameters();
  set_parameter(to, key, text);
  change(to, QString::fromStdString(parameter_row(key).label), key);
}

void Workspace::reset(const std::string& key) {
  Parameters to = parameters();
  const std::string& name = parameter_row(key).key;
  set_parameter(to, key,
                name.ends_with("<species>") && !name.starts_with("atoms.visible") ? "auto"
                : name.starts_with("atoms.visible")                               ? "true"
                                                                                  : get_parameter({}, key));
  change(to, tr("Reset %1").arg(QString::fromStdString(parameter_row(key).label)));
}

void Workspace::undo() {
  if (!history_.can_undo()) return;
  if (const auto parts = history_.undo()) show_parts(*parts);
  follow_parameters();
}

void Workspace::redo() {
  if (!history_.can_redo()) return;
  if (const auto parts = history_.redo()) show_parts(*parts);
  follow_parameters();
}

void Workspace::follow_parameters() {
  Parameters next = parameters();
  for (const Mode mode : modes) {
    if (!auto_apply(mode)) take_group(next, shown_, mode);
  }
  const bool drawn = !(next == shown_);
  const bool other_bounds = !(next.atoms == shown_.atoms);
  shown_ = std::move(next);
  if (drawn && other_bounds) update_bounds();
  emit parameters_changed();
  emit apply_changed();
  if (!drawn) return;
  load_missing_parts();
  emit shown_changed();
}

void Workspace::set_auto_apply(Mode mode, bool on) {
  if (auto_apply(mode) == on) return;
  auto_apply_[static_cast<std::size_t>(mode)] = on;
  if (on) {
    follow_parameters();
  } else {
    emit apply_changed();
  }
}

bool Workspace::apply_pending(Mode mode) const {
  Parameters other = parameters();
  take_group(other, shown_, mode);
  return !(other == parameters());
}

void Workspace::apply(Mode mode) {
  if (!apply_pending(mode)) return;
  take_group(shown_, parameters(), mode);
  if (mode == Mode::atoms) update_bounds();
  emit apply_changed();
  load_missing_parts();
  emit shown_changed();
}

void Workspace::set_view_options(const ViewOptions& options) {
  if (options == view_options_) return;
  view_options_ = options;
  emit view_options_changed();
}

void Workspace::show_parts(const cli::PictureParts& parts) {
  ViewOptions options = view_options_;
  options.legend = parts.legend;
  options.scale_bar = parts.scale_bar;
  options.tripod = parts.tripod;
  set_view_options(options);
}

void Workspace::set_rotation_center(const Vec3& center) {
  rotation_center_ = center;
  own_rotation_center_ = true;
}

void Workspace::reset_rotation_center() {
  own_rotation_center_ = false;
  rotation_center_ = bounds_.center();
}

void Workspace::update_bounds() {
  bounds_ = document_ ? sample_bounds(*document_->material, shown_) : Bounds{};
  if (!own_rotation_center_) rotation_center_ = bounds_.center();
}

void Workspace::set_view_size(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  emit view_size_changed();
  emit shown_changed();
}

Camera Workspace::camera() const {
  return make_camera(shown_, bounds_, width_, height_);
}

void Workspace::add_pick(const Pick& pick, bool second) {
  if (!second || picks_.size() != 1) picks_.clear();
  picks_.push_back(pick);
  emit picks_changed();
}

void Workspace::clear_picks() {
  if (picks_.empty()) return;
  picks_.clear();
  emit picks_changed();
}

void Workspace::set_marks(std::vector<Mark> marks) {
  if (marks == marks_) return;
  marks_ = std::move(marks);
  emit marks_changed();
}

void Workspace::say(const QString& message) {
  emit said(message);
}

void Workspace::complain(const QString& message) {
  emit said(message);
  emit complained(message);
}

void Workspace::note_times(const std::vector<StageTime>& times) {
  emit times_changed(times);
}

}  // namespace atomesh::gui
