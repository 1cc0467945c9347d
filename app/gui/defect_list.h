// The clusters of crystal defects of what is open, as rows that can be sorted and filtered.
#pragma once

#include <QAbstractTableModel>
#include <QString>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/gui/latest_job.h"
#include "app/gui/workspace.h"
#include "preprocess/cluster_defects.h"

namespace atomesh::gui {

inline constexpr std::array defect_kinds{DefectKind::vacancy, DefectKind::extra, DefectKind::substitution,
                                         DefectKind::positional, DefectKind::mixed};
// "Vacancy", "Extra atom", … for people; defect_kind_name() is for files.
QString defect_kind_label(DefectKind kind);
// Of its mark in the view and its row.
Vec4f defect_kind_color(DefectKind kind);

// Follows the workspace: reads what is missing of the document and gathers the clusters beside the window
// (cluster_defects() with its own distance), once somebody looks.
class DefectList : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kind, atoms, x, y, z, peak, vacancies, extras, substitutions, radius, columns };
  enum class State { nothing_open, no_atoms, no_defect_values, working, failed, ready };

  explicit DefectList(Workspace& workspace, QObject* parent = nullptr);

  // Whether anybody looks; until then nothing is read or gathered.
  void set_wanted(bool wanted);
  State state() const { return state_; }
  // What to say where there are no rows, with what to do about it; "" where there are some.
  QString message() const;
  // "12 clusters", "3 of 12 clusters".
  QString summary() const;

  // Only clusters of this kind, or all.
  void set_kind(std::optional<DefectKind> which);
  std::optional<DefectKind> shown_kind() const { return shown_kind_; }
  // Of all clusters, whatever is shown.
  std::size_t count() const { return clusters_->size(); }
  std::size_t count(DefectKind which) const;
  // Of a row as it stands.
  const DefectCluster& cluster(int row) const;
  // The row whose cluster has the atom among its own, or is nearest to it of those whose sphere holds it.
  std::optional<int> row_of_atom(Index atom) const;
  // The rows as they stand; of all kinds unsorted it is what `atomesh defects --csv` writes.
  std::string csv() const;
  // Throws Error with the system's reason.
  void write_csv(const std::string& path) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role = Qt::DisplayRole) const override;
  // column -1: as they were found, those of most atoms first. Rows that are equal keep that order.
  void sort(int column, Qt::SortOrder order = Qt::AscendingOrder) override;

 signals:
  void state_changed();  // state, message, summary, counts

 private:
  void follow();
  void set_clusters(std::shared_ptr<const std::vector<DefectCluster>> clusters);
  void set_state(State state, const QString& trouble = {});
  void choose_rows();
  bool before(std::size_t a, std::size_t b) const;

  Workspace& workspace_;
  bool wanted_ = false;
  State state_ = State::nothing_open;
  QString trouble_;
  std::shared_ptr<const Material> asked_;  // whose clusters are there or are being gathered
  std::shared_ptr<const std::vector<DefectCluster>> clusters_;
  std::vector<std::size_t> rows_;  // into clusters_
  std::optional<DefectKind> shown_kind_;
  int sort_column_ = -1;
  Qt::SortOrder sort_order_ = Qt::AscendingOrder;
  LatestJob job_;
};

}  // namespace atomesh::gui
