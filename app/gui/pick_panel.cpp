#include "app/gui/pick_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QFontDatabase>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "app/gui/pick_report.h"

namespace atomesh::gui {

namespace {

constexpr int atom_role = Qt::UserRole;

QString text_of(const std::string& text) {
  return QString::fromStdString(text);
}

QTreeWidget* flat_tree(QWidget* parent, const char* name) {
  auto* tree = new QTreeWidget(parent);
  tree->setObjectName(name);
  tree->setRootIsDecorated(false);
  tree->setAlternatingRowColors(true);
  tree->setUniformRowHeights(true);
  return tree;
}

}  // namespace

PickPanel::PickPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName("pick_panel");
  setWindowTitle(tr("Pick"));
  build();
  connect(&workspace, &Workspace::picks_changed, this, &PickPanel::show_picks);
  connect(&workspace, &Workspace::document_changed, this, [this] { job_.cancel(); });
  show_picks();
}

void PickPanel::build() {
  facts_ = flat_tree(this, "pick_facts");
  facts_->setAccessibleName(tr("What is known of what is picked"));
  facts_->setTextElideMode(Qt::ElideMiddle);
  distance_ = new QLabel(this);
  distance_->setObjectName("pick_distance");
  distance_->setWordWrap(true);
  distance_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  neighbours_title_ = new QLabel(this);
  neighbours_title_->setObjectName("pick_neighbours_title");
  neighbours_ = flat_tree(this, "pick_neighbours");
  neighbours_->setHeaderLabels({tr("Species"), tr("Atom"), tr("Distance")});
  neighbours_->setToolTip(tr("A click picks the neighbor; with Ctrl or Shift it is the second, to measure to"));
  neighbours_title_->setBuddy(neighbours_);
  const auto choose = [this](QTreeWidgetItem* item, int) {
    const bool second = (QApplication::keyboardModifiers() & (Qt::ControlModifier | Qt::ShiftModifier)) != 0;
    pick_atom_by_number(static_cast<Index>(item->data(0, atom_role).toUInt()), second);
  };
  connect(neighbours_, &QTreeWidget::itemClicked, this, choose);
  connect(neighbours_, &QTreeWidget::itemActivated, this, choose);  // Enter

  const auto button = [this](const QString& text, const char* name, const QString& tip) {
    auto* made = new QPushButton(text, this);
    made->setObjectName(name);
    made->setToolTip(tip);
    return made;
  };
  center_ = button(tr("Turn &about it"), "pick_center", tr("The view turns about the last pick from now on"));
  copy_ = button(tr("Co&py"), "pick_copy", tr("All of this as text"));
  clear_ = button(tr("C&lear"), "pick_clear", tr("Nothing is picked"));
  connect(center_, &QPushButton::clicked, this, &PickPanel::center_view);
  connect(copy_, &QPushButton::clicked, this, &PickPanel::copy);
  connect(clear_, &QPushButton::clicked, this, [this] {
    job_.cancel();
    workspace_.clear_picks();
  });

  auto* picked = new QWidget(this);
  auto* column = new QVBoxLayout(picked);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(facts_, 3);
  column->addWidget(distance_);
  column->addWidget(neighbours_title_);
  column->addWidget(neighbours_, 2);
  auto* nothing = new QLabel(
      tr("Click in the view to pick an atom or a place.\n\nCtrl+click another one to measure the distance."), this);
  nothing->setObjectName("pick_nothing");
  nothing->setAlignment(Qt::AlignCenter);
  nothing->setWordWrap(true);
  pages_ = new QStackedWidget(this);
  pages_->setObjectName("pick_pages");
  pages_->addWidget(picked);
  pages_->addWidget(nothing);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(center_);
  buttons->addStretch(1);
  buttons->addWidget(copy_);
  buttons->addWidget(clear_);
  auto* all = new QVBoxLayout(this);
  all->addWidget(pages_, 1);
  all->addLayout(buttons);
}

void PickPanel::show_picks() {
  const std::vector<Pick>& picks = workspace_.picks();
  const bool any = !picks.empty() && workspace_.document();
  pages_->setCurrentIndex(any ? 0 : 1);
  for (QPushButton* one : {center_, copy_, clear_}) one->setEnabled(any);
  facts_->clear();
  neighbours_->clear();
  distance_->clear();
  if (!any) return;
  const Material& material = *workspace_.document()->material;
  QStringList headings{tr("What"), picks.size() > 1 ? tr("First") : tr("Value")};
  if (picks.size() > 1) headings << tr("Second");
  facts_->setColumnCount(static_cast<int>(headings.size()));
  facts_->setHeaderLabels(headings);
  for (const PickRow& row : pick_rows(picks, material)) {
    QStringList cells{text_of(row.label)};
    for (const std::string& value : row.values) cells << text_of(value);
    auto* item = new QTreeWidgetItem(facts_, cells);
    for (int c = 0; c < cells.size(); ++c) item->setToolTip(c, cells[c]);
  }
  for (int column = 0; column < facts_->columnCount(); ++column) facts_->resizeColumnToContents(column);
  if (picks.size() > 1) {
    distance_->setText(text_of(distance_text(distance_between(picks[0], picks[1], material), material)));
  }
  distance_->setVisible(picks.size() > 1);
  show_neighbours();
}

void PickPanel::show_neighbours() {
  const std::vector<Pick>& picks = workspace_.picks();
  const Material& material = *workspace_.document()->material;
  const bool known = picks.back().atom != no_index;
  neighbours_title_->setVisible(known);
  neighbours_->setVisible(known);
  neighbours_title_->setText(picks.size() > 1 ? tr("&Neighbors of the second") : tr("&Neighbors"));
  for (const Neighbour& neighbour : picks.back().neighbours) {
    auto* item = new QTreeWidgetItem(
        neighbours_, {text_of(material.atoms.species_name(neighbour.atom)), QString::number(neighbour.atom),
                      text_of(length_text(neighbour.distance, material))});
    item->setData(0, atom_role, neighbour.atom);
    item->setTextAlignment(1, Qt::AlignRight);
    item->setTextAlignment(2, Qt::AlignRight);
  }
}

void PickPanel::pick_atom_by_number(Index atom, bool second) {
  if (!workspace_.document()) return;
  const auto result = std::make_shared<Pick>();
  job_.run(
      tr("Looking up atom %1").arg(atom),
      [result, atom, material = workspace_.document()->material](Progress& progress) {
        *result = pick_atom(*material, atom, progress);
      },
      [this, result, second] { workspace_.add_pick(*result, second); },
      [this](const QString& message) { workspace_.complain(message); });
}

void PickPanel::center_view() {
  if (!workspace_.picks().empty()) workspace_.set_rotation_center(workspace_.picks().back().position);
}

void PickPanel::copy() {
  if (!workspace_.document()) return;
  QApplication::clipboard()->setText(text_of(pick_text(workspace_.picks(), *workspace_.document()->material)));
}

}  // namespace atomesh::gui
