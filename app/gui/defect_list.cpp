#include "app/gui/defect_list.h"

#include <algorithm>
#include <numeric>

#include "app/cli/defect_table.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::gui {

namespace {

const MaterialParts parts_of_defects{
    .atoms = true, .tetrahedra = false, .surface = false, .defects = true, .fields = false};

double number_of(const DefectCluster& cluster, int column) {
  switch (column) {
    case DefectList::atoms:
      return static_cast<double>(cluster.atoms.size());
    case DefectList::vacancies:
      return static_cast<double>(cluster.vacancies.size());
    case DefectList::extras:
      return static_cast<double>(cluster.extras.size());
    case DefectList::substitutions:
      return static_cast<double>(cluster.substitutions.size());
    case DefectList::radius:
      return cluster.radius;
    case DefectList::x:
      return cluster.centre.x;
    case DefectList::y:
      return cluster.centre.y;
    case DefectList::z:
      return cluster.centre.z;
    case DefectList::peak:
      return static_cast<double>(cluster.peak);
    default:
      return 0.0;
  }
}

QString number_text(const DefectCluster& cluster, int column) {
  const double number = number_of(cluster, column);
  switch (column) {
    case DefectList::radius:
    case DefectList::x:
    case DefectList::y:
    case DefectList::z:
      return QString::number(number, 'f', 2);
    case DefectList::peak:
      return QString::number(number, 'g', 4);
    default:
      return QString::number(static_cast<qulonglong>(number));
  }
}

}  // namespace

QString defect_kind_label(DefectKind kind) {
  switch (kind) {
    case DefectKind::vacancy:
      return DefectList::tr("Vacancy");
    case DefectKind::extra:
      return DefectList::tr("Extra atom");
    case DefectKind::substitution:
      return DefectList::tr("Substitution");
    case DefectKind::positional:
      return DefectList::tr("Positional");
    case DefectKind::mixed:
      return DefectList::tr("Mixed");
  }
  return {};
}

Vec4f defect_kind_color(DefectKind kind) {
  // Okabe and Ito's, told apart with every common colour blindness.
  switch (kind) {
    case DefectKind::vacancy:
      return {0.0F, 0.447F, 0.698F, 1.0F};
    case DefectKind::extra:
      return {0.0F, 0.62F, 0.451F, 1.0F};
    case DefectKind::substitution:
      return {0.8F, 0.475F, 0.655F, 1.0F};
    case DefectKind::positional:
      return {0.835F, 0.369F, 0.0F, 1.0F};
    case DefectKind::mixed:
      return {0.902F, 0.624F, 0.0F, 1.0F};
  }
  return Vec4f(1.0F);
}

DefectList::DefectList(Workspace& workspace, QObject* parent)
    : QAbstractTableModel(parent),
      workspace_(workspace),
      clusters_(std::make_shared<const std::vector<DefectCluster>>()) {
  connect(&workspace, &Workspace::document_changed, this, [this] {
    job_.cancel();
    asked_.reset();
    set_clusters(std::make_shared<const std::vector<DefectCluster>>());
    set_state(State::nothing_open);
    follow();
  });
  connect(&workspace, &Workspace::parts_changed, this, &DefectList::follow);
  // Of parts that cannot be read nothing else tells.
  connect(&workspace, &Workspace::complained, this, [this](const QString& message) {
    if (state_ == State::working && !job_.running()) set_state(State::failed, message);
  });
}

void DefectList::set_wanted(bool wanted) {
  if (wanted == wanted_) return;
  wanted_ = wanted;
  follow();
}

void DefectList::follow() {
  if (!wanted_ || !workspace_.document()) return;
  const Document& document = *workspace_.document();
  if (document.kind == FileKind::material && !workspace_.has_parts(parts_of_defects)) {
    set_state(State::working);
    workspace_.need_parts(parts_of_defects);  // and again by parts_changed()
    return;
  }
  if (document.material->atoms.size() == 0) return set_state(State::no_atoms);
  if (!document.material->defects.present()) return set_state(State::no_defect_values);
  // Parts that came later change neither atoms nor defects.
  if (asked_ && (asked_ == document.material || state_ == State::ready)) return;
  asked_ = document.material;
  const auto result = std::make_shared<std::vector<DefectCluster>>();
  set_state(State::working);
  job_.run(
      tr("Gathering defects"),
      [material = asked_, result](Progress& progress) {
        progress.stage("cluster_defects");
        *result = cluster_defects(*material, 0.0, progress);
      },
      [this, result] {
        set_clusters(result);
        set_state(State::ready);
      },
      [this](const QString& message) { set_state(State::failed, message); });
}

void DefectList::set_state(State state, const QString& trouble) {
  state_ = state;
  trouble_ = trouble;
  emit state_changed();
}

QString DefectList::message() const {
  switch (state_) {
    case State::nothing_open:
      return tr("Open a file of atoms, or a .crb, to list its crystal defects.");
    case State::no_atoms:
      return tr("This is a mesh without atoms; defects are found from atoms.");
    case State::no_defect_values:
      return tr("There are no defect values, because no unit cell was known. Preprocess the atoms with a unit cell.");
    case State::working:
      return tr("Gathering defects…");
    case State::failed:
      return trouble_;
    case State::ready:
      break;
  }
  if (clusters_->empty()) return tr("No defects: every atom has the neighborhood of the perfect crystal.");
  if (rows_.empty()) return tr("No cluster is of the kind “%1”.").arg(defect_kind_label(*shown_kind_));
  return {};
}

QString DefectList::summary() const {
  if (state_ != State::ready) return {};
  if (clusters_->size() == 1 && rows_.size() == 1) return tr("1 cluster");
  if (rows_.size() == clusters_->size()) return tr("%L1 clusters").arg(rows_.size());
  return tr("%L1 of %L2 clusters").arg(rows_.size()).arg(clusters_->size());
}

void DefectList::set_clusters(std::shared_ptr<const std::vector<DefectCluster>> clusters) {
  beginResetModel();
  clusters_ = std::move(clusters);
  choose_rows();
  endResetModel();
}

void DefectList::set_kind(std::optional<DefectKind> which) {
  if (which == shown_kind_) return;
  beginResetModel();
  shown_kind_ = which;
  choose_rows();
  endResetModel();
  emit state_changed();
}

std::size_t DefectList::count(DefectKind which) const {
  return static_cast<std::size_t>(std::count_if(clusters_->begin(), clusters_->end(),
                                                [&](const DefectCluster& cluster) { return cluster.kind == which; }));
}

const DefectCluster& DefectList::cluster(int row) const {
  return (*clusters_)[rows_.at(static_cast<std::size_t>(row))];
}

std::optional<int> DefectList::row_of_atom(Index atom) const {
  if (state_ != State::ready || atom >= asked_->atoms.size()) return std::nullopt;
  const Vec3 position = asked_->atoms.positions[atom];
  std::optional<int> nearest;
  double smallest = 0.0;
  for (int row = 0; row < rowCount(); ++row) {
    const DefectCluster& one = cluster(row);
    if (std::binary_search(one.atoms.begin(), one.atoms.end(), atom)) return row;
    const double distance = glm::length(position - one.centre);
    if (distance > one.radius || (nearest && distance >= smallest)) continue;
    nearest = row;
    smallest = distance;
  }
  return nearest;
}

std::string DefectList::csv() const {
  std::vector<DefectCluster> rows;
  rows.reserve(rows_.size());
  for (const std::size_t i : rows_) rows.push_back((*clusters_)[i]);
  return cli::cluster_table(rows).csv();
}

void DefectList::write_csv(const std::string& path) const {
  AtomicFile file(path);
  file.write(csv());
  file.commit();
}

int DefectList::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int DefectList::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : columns;
}

QVariant DefectList::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const DefectCluster& one = cluster(index.row());
  const int column = index.column();
  switch (role) {
    case Qt::DisplayRole:
      return column == kind ? defect_kind_label(one.kind) : number_text(one, column);
    case Qt::TextAlignmentRole:
      return QVariant::fromValue<int>(Qt::AlignVCenter | (column == kind ? Qt::AlignLeft : Qt::AlignRight));
    case Qt::ToolTipRole:
      return tr("%1 at (%2, %3, %4) Å, radius %5 Å: %6 atoms, largest defect value %7")
          .arg(defect_kind_label(one.kind))
          .arg(one.centre.x, 0, 'f', 3)
          .arg(one.centre.y, 0, 'f', 3)
          .arg(one.centre.z, 0, 'f', 3)
          .arg(number_text(one, radius), number_text(one, atoms), number_text(one, peak));
    default:
      return {};
  }
}

QVariant DefectList::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Vertical) return role == Qt::DisplayRole ? QVariant(section + 1) : QVariant();
  if (section < 0 || section >= columns) return {};
  if (role == Qt::DisplayRole) {
    const std::array names{tr("Kind"), tr("Atoms"),     tr("x, Å"),  tr("y, Å"),        tr("z, Å"),
                           tr("Peak"), tr("Vacancies"), tr("Extra"), tr("Substituted"), tr("Radius, Å")};
    return names[static_cast<std::size_t>(section)];
  }
  if (role == Qt::ToolTipRole) {
    const std::array tips{tr("By the sites in it: vacancies, extra atoms, substitutions (an extra atom on a vacant "
                             "site) or, mixed, both; positional without any"),
                          tr("Atoms with a defect value"),
                          tr("Of the middle of the cluster"),
                          tr("Of the middle of the cluster"),
                          tr("Of the middle of the cluster"),
                          tr("Largest single defect value of its atoms"),
                          tr("Sites of the crystal without an atom of their species"),
                          tr("Atoms on no site of their species"),
                          tr("Extra atoms on vacant sites"),
                          tr("Of the sphere that holds the cluster")};
    return tips[static_cast<std::size_t>(section)];
  }
  return {};
}

bool DefectList::before(std::size_t a, std::size_t b) const {
  const DefectCluster& first = (*clusters_)[a];
  const DefectCluster& second = (*clusters_)[b];
  if (sort_column_ == kind) return defect_kind_name(first.kind) < defect_kind_name(second.kind);
  return number_of(first, sort_column_) < number_of(second, sort_column_);
}

void DefectList::choose_rows() {
  rows_.clear();
  for (std::size_t i = 0; i < clusters_->size(); ++i) {
    if (!shown_kind_ || (*clusters_)[i].kind == *shown_kind_) rows_.push_back(i);
  }
  if (sort_column_ < 0) return;
  std::stable_sort(rows_.begin(), rows_.end(), [&](std::size_t a, std::size_t b) {
    return sort_order_ == Qt::AscendingOrder ? before(a, b) : before(b, a);
  });
}

void DefectList::sort(int column, Qt::SortOrder order) {
  if (column == sort_column_ && order == sort_order_) return;
  emit layoutAboutToBeChanged({}, VerticalSortHint);
  const std::vector<std::size_t> old = rows_;
  sort_column_ = column < columns ? column : -1;
  sort_order_ = order;
  choose_rows();
  std::vector<int> now(clusters_->size(), -1);  // of each cluster, its row
  for (std::size_t r = 0; r < rows_.size(); ++r) now[rows_[r]] = static_cast<int>(r);
  const QModelIndexList from = persistentIndexList();
  QModelIndexList to;
  for (const QModelIndex& one : from) to.append(index(now[old[static_cast<std::size_t>(one.row())]], one.column()));
  changePersistentIndexList(from, to);
  emit layoutChanged({}, VerticalSortHint);
}

}  // namespace atomesh::gui
