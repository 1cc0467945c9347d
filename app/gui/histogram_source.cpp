#include "app/gui/histogram_source.h"

#include "core/error.h"

namespace atomesh::gui {

HistogramSource::HistogramSource(Workspace& workspace, QObject* parent) : QObject(parent), workspace_(workspace) {
  connect(&workspace, &Workspace::document_changed, this, [this] {
    job_.cancel();
    asked_ = {};
    histogram_.reset();
    trouble_.clear();
    emit changed();
    follow();
  });
  connect(&workspace, &Workspace::parts_changed, this, &HistogramSource::follow);
  connect(&workspace, &Workspace::parameters_changed, this, &HistogramSource::follow);
  // Of parts that cannot be read nothing else tells.
  connect(&workspace, &Workspace::complained, this, [this](const QString& message) {
    if (!wanted_ || histogram_ || job_.running() || !workspace_.document()) return;
    trouble_ = message;
    emit changed();
  });
}

void HistogramSource::set_wanted(bool wanted) {
  if (wanted == wanted_) return;
  wanted_ = wanted;
  follow();
}

void HistogramSource::set_bins(int bins) {
  if (bins < 1 || bins > max_bins) throw UsageError("a histogram has 1 to " + std::to_string(max_bins) + " bins");
  if (bins == bins_) return;
  bins_ = bins;
  follow();
}

HistogramSource::Question HistogramSource::question() const {
  Question asking{workspace_.document()->material, workspace_.parameters().volume, bins_};
  asking.parameters.color_map = VolumeParameters{}.color_map;
  asking.parameters.alpha_length = VolumeParameters{}.alpha_length;
  return asking;
}

bool HistogramSource::up_to_date() const {
  return histogram_ && !counting() && workspace_.document() && question() == asked_;
}

void HistogramSource::follow() {
  if (!wanted_ || !workspace_.document()) return;
  const MaterialParts parts{.atoms = true, .tetrahedra = true, .surface = false, .defects = true, .fields = true};
  if (workspace_.document()->kind == FileKind::material && !workspace_.has_parts(parts)) {
    workspace_.need_parts(parts);  // and again by parts_changed()
    return;
  }
  const Question asking = question();
  if (asking == asked_) return;
  asked_ = asking;
  const auto result = std::make_shared<ScalarHistogram>();
  job_.run(
      tr("Counting scalars"),
      [asking, result](Progress& progress) {
        *result = scalar_histogram(*asking.material, asking.parameters, asking.bins, progress);
      },
      [this, result] {
        histogram_ = result;
        trouble_.clear();
        emit changed();
      },
      [this](const QString& message) {
        histogram_.reset();
        trouble_ = message;
        emit changed();
      });
  emit changed();
}

}  // namespace atomesh::gui
