// The histogram of what is open, kept up to date beside the window.
#pragma once

#include <QObject>
#include <QString>
#include <memory>

#include "app/gui/latest_job.h"
#include "app/gui/scalar_histogram.h"
#include "app/gui/workspace.h"

namespace atomesh::gui {

// Follows the workspace: counts anew when the document, its parts, or the scalar that the forms choose (field, range,
// weights) changes.
class HistogramSource : public QObject {
  Q_OBJECT

 public:
  explicit HistogramSource(Workspace& workspace, QObject* parent = nullptr);

  // Whether anybody looks; until then nothing is read or counted.
  void set_wanted(bool wanted);
  // Throws UsageError outside of 1 to max_bins.
  void set_bins(int bins);
  int bins() const { return bins_; }

  // The latest; null without a document and before the first. While another is counted it stays.
  const std::shared_ptr<const ScalarHistogram>& histogram() const { return histogram_; }
  bool counting() const { return job_.running(); }
  // Whether it is that of the document and the scalar as they are now.
  bool up_to_date() const;
  // Why there is none: "an unknown field …"; "" otherwise.
  const QString& trouble() const { return trouble_; }

 signals:
  void changed();  // histogram, counting or trouble

 private:
  struct Question {
    std::shared_ptr<const Material> material;
    VolumeParameters parameters;  // the colour map left as it is by default
    int bins = 0;
    bool operator==(const Question&) const = default;
  };
  Question question() const;
  void follow();

  Workspace& workspace_;
  bool wanted_ = false;
  int bins_ = default_bins;
  Question asked_;
  std::shared_ptr<const ScalarHistogram> histogram_;
  QString trouble_;
  LatestJob job_;
};

}  // namespace atomesh::gui
