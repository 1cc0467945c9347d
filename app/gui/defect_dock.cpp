#include "app/gui/defect_dock.h"

#include <QAbstractItemView>
#include <QCheckBox>
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QTableView>
#include <QVBoxLayout>
#include <algorithm>

#include "app/gui/color_map_painting.h"
#include "app/gui/navigation.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

// Shown around a cluster, Å: some shells of what is regular, to see what is not.
constexpr double surroundings = 6.0;

}  // namespace

DefectDock::DefectDock(Workspace& workspace, QWidget* parent)
    : QWidget(parent), workspace_(workspace), list_(workspace) {
  setObjectName("defect_dock");
  setWindowTitle(tr("Defects"));
  build();
  connect(&list_, &DefectList::state_changed, this, &DefectDock::show_state);
  connect(&list_, &QAbstractItemModel::modelReset, this, &DefectDock::unmark);
  connect(&workspace, &Workspace::marks_changed, this, [this] { marked_ = marked_ && !workspace_.marks().empty(); });
  show_state();
}

void DefectDock::build() {
  auto* kinds_label = new QLabel(tr("&Kind"), this);
  kinds_ = new QComboBox(this);
  kinds_->setObjectName("defect_kinds");
  kinds_->setToolTip(tr("Only clusters of this kind"));
  kinds_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  kinds_->view()->setTextElideMode(Qt::ElideNone);
  kinds_label->setBuddy(kinds_);
  fill_kinds();
  connect(kinds_, &QComboBox::activated, this, [this](int row) {
    const QVariant kind = kinds_->itemData(row);
    list_.set_kind(kind.isValid() ? std::optional(static_cast<DefectKind>(kind.toInt())) : std::nullopt);
  });
  flying_ = new QCheckBox(tr("&Fly there"), this);
  flying_->setObjectName("defect_flying");
  flying_->setChecked(true);
  flying_->setToolTip(tr("Bring the selected cluster to the middle of the view; else it is only marked"));

  table_ = new QTableView(this);
  table_->setObjectName("defect_table");
  table_->setAccessibleName(tr("Defect clusters"));
  table_->setModel(&list_);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::SingleSelection);
  table_->setAlternatingRowColors(true);
  table_->setTabKeyNavigation(false);
  table_->setWordWrap(false);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() * 3 / 2);
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  QHeaderView* header = table_->horizontalHeader();
  header->setSortIndicator(-1, Qt::DescendingOrder);  // as they are found: most atoms first
  header->setSortIndicatorClearable(true);
  header->setHighlightSections(false);
  table_->setSortingEnabled(true);
  // Only a column that is sorted by needs room for the arrow.
  connect(header, &QHeaderView::sortIndicatorChanged, this, [this, header](int column) {
    if (column >= 0)
      header->resizeSection(column, std::max(header->sectionSize(column), header->sectionSizeHint(column)));
  });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, [this](const QModelIndex& current) {
    if (current.isValid()) fly(current.row());
  });
  // Again, after the view was turned elsewhere; the first click comes by the row that changes.
  connect(table_, &QTableView::clicked, this, [this](const QModelIndex& index) { fly(index.row()); });
  connect(table_, &QTableView::activated, this, [this](const QModelIndex& index) { fly(index.row()); });

  message_ = new QLabel(this);
  message_->setObjectName("defect_message");
  message_->setWordWrap(true);
  message_->setAlignment(Qt::AlignCenter);
  message_->setMargin(fontMetrics().height());
  pages_ = new QStackedWidget(this);
  pages_->setObjectName("defect_pages");
  pages_->addWidget(table_);
  pages_->addWidget(message_);

  summary_ = new QLabel(this);
  summary_->setObjectName("defect_summary");
  export_ = new QPushButton(tr("&Export CSV…"), this);
  export_->setObjectName("defect_export");
  export_->setToolTip(tr("The rows as they stand, as atomesh defects --csv writes them"));
  connect(export_, &QPushButton::clicked, this, &DefectDock::ask_where_to_write);

  auto* top = new QHBoxLayout;
  top->addWidget(kinds_label);
  top->addWidget(kinds_);
  top->addStretch(1);
  top->addWidget(flying_);
  auto* bottom = new QHBoxLayout;
  bottom->addWidget(summary_, 1);
  bottom->addWidget(export_);
  auto* all = new QVBoxLayout(this);
  all->addLayout(top);
  all->addWidget(pages_, 1);
  all->addLayout(bottom);
  setTabOrder(kinds_, flying_);
  setTabOrder(flying_, table_);
  setTabOrder(table_, export_);
}

void DefectDock::fill_kinds() {
  const QSignalBlocker quiet(kinds_);
  const auto shown = list_.shown_kind();
  const QSize size(fontMetrics().height() * 3 / 4, fontMetrics().height() * 3 / 4);
  kinds_->clear();
  kinds_->addItem(tr("All (%L1)").arg(list_.count()));
  for (const DefectKind kind : defect_kinds) {
    kinds_->addItem(swatch_icon(defect_kind_color(kind), size, devicePixelRatioF()),
                    tr("%1 (%L2)").arg(defect_kind_label(kind)).arg(list_.count(kind)), static_cast<int>(kind));
    if (shown == kind) kinds_->setCurrentIndex(kinds_->count() - 1);
  }
}

void DefectDock::show_state() {
  fill_kinds();
  const QString message = list_.message();
  message_->setText(message);
  pages_->setCurrentWidget(message.isEmpty() ? static_cast<QWidget*>(table_) : message_);
  summary_->setText(list_.summary());
  export_->setEnabled(list_.rowCount() > 0);
  // As narrow as the first rows of a sample allow; then the columns are the user's.
  if (list_.state() != DefectList::State::ready) fitted_ = false;
  if (!fitted_ && list_.rowCount() > 0) {
    QHeaderView* header = table_->horizontalHeader();
    header->setSortIndicatorShown(header->sortIndicatorSection() >= 0);
    table_->resizeColumnsToContents();
    header->setSortIndicatorShown(true);
    fitted_ = true;
  }
  kinds_->setEnabled(list_.count() > 0);
}

void DefectDock::showEvent(QShowEvent* event) {
  list_.set_wanted(true);
  QWidget::showEvent(event);
}

void DefectDock::hideEvent(QHideEvent* event) {
  list_.set_wanted(false);
  QWidget::hideEvent(event);
}

void DefectDock::mark(int row) {
  const DefectCluster& cluster = list_.cluster(row);
  workspace_.set_marks({{cluster.centre, cluster.radius, defect_kind_color(cluster.kind),
                         defect_kind_label(cluster.kind).toStdString()}});
  marked_ = true;
}

void DefectDock::unmark() {
  if (marked_) workspace_.set_marks({});
  marked_ = false;
}

void DefectDock::fly(int row) {
  if (row < 0 || row >= list_.rowCount() || !workspace_.document()) return;
  mark(row);
  if (!flying_->isChecked()) return;
  const DefectCluster& cluster = list_.cluster(row);
  Parameters to = workspace_.parameters();
  fly_to(to, workspace_.bounds(), cluster.centre, cluster.radius + surroundings);
  // Through a list by the arrow keys is one step.
  workspace_.change(to, tr("Fly to defect"), "fly to defect");
  workspace_.set_rotation_center(cluster.centre);
}

bool DefectDock::select_atom(Index atom) {
  const auto row = list_.row_of_atom(atom);
  if (!row) return false;
  table_->selectRow(*row);
  return true;
}

void DefectDock::write_csv(const QString& path) {
  try {
    list_.write_csv(path.toStdString());
    workspace_.say(tr("%L1 defect clusters written to %2").arg(list_.rowCount()).arg(path));
  } catch (const Error& error) {
    workspace_.complain(QString::fromUtf8(error.what()));
  }
}

void DefectDock::ask_where_to_write() {
  if (!workspace_.document()) return;
  const QFileInfo info(QString::fromStdString(workspace_.document()->path));
  auto* dialog = new QFileDialog(this, tr("Export defects"), info.absolutePath(), tr("Comma-separated values (*.csv)"));
  dialog->setObjectName("defect_file_dialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix("csv");
  dialog->selectFile(info.completeBaseName() + "-defects.csv");
  connect(dialog, &QFileDialog::fileSelected, this, &DefectDock::write_csv);
  dialog->open();
}

}  // namespace atomesh::gui
