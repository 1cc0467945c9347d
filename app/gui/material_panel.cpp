#include "app/gui/material_panel.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QHeaderView>
#include <QKeyEvent>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "app/gui/material_facts.h"

namespace atomesh::gui {

MaterialPanel::MaterialPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName("material_panel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  tree_ = new QTreeWidget(this);
  tree_->setObjectName("material_facts");
  tree_->setColumnCount(2);
  tree_->setHeaderHidden(true);
  tree_->setAlternatingRowColors(true);
  tree_->setIndentation(fontMetrics().averageCharWidth() * 2);
  tree_->setUniformRowHeights(true);
  tree_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  tree_->setAccessibleName(tr("What is open"));
  auto* copy = new QAction(tr("&Copy all"), tree_);
  copy->setShortcut(QKeySequence::Copy);
  copy->setShortcutContext(Qt::WidgetShortcut);
  connect(copy, &QAction::triggered, this, &MaterialPanel::copy);
  tree_->addAction(copy);
  tree_->installEventFilter(this);
  tree_->setContextMenuPolicy(Qt::ActionsContextMenu);
  layout->addWidget(tree_);
  connect(&workspace_, &Workspace::document_changed, this, &MaterialPanel::refresh);
  connect(&workspace_, &Workspace::parts_changed, this, &MaterialPanel::refresh);
  refresh();
}

// The window's own Copy would be as much meant by the key as the tree's.
bool MaterialPanel::eventFilter(QObject* object, QEvent* event) {
  if (event->type() != QEvent::ShortcutOverride && event->type() != QEvent::KeyPress) return false;
  if (object != tree_ || !static_cast<QKeyEvent*>(event)->matches(QKeySequence::Copy)) return false;
  if (event->type() == QEvent::KeyPress) copy();
  event->accept();
  return true;
}

void MaterialPanel::refresh() {
  tree_->clear();
  if (!workspace_.document()) {
    new QTreeWidgetItem(tree_, {tr("Nothing is open. File > Open, or drop a file here.")});
    tree_->topLevelItem(0)->setFirstColumnSpanned(true);
    return;
  }
  for (const MaterialFacts& facts : material_facts(*workspace_.document())) {
    auto* heading = new QTreeWidgetItem(tree_, {QString::fromStdString(facts.heading)});
    heading->setFirstColumnSpanned(true);
    QFont bold = heading->font(0);
    bold.setBold(true);
    heading->setFont(0, bold);
    for (const auto& [label, value] : facts.rows) {
      auto* row = new QTreeWidgetItem(heading, {QString::fromStdString(label), QString::fromStdString(value)});
      row->setToolTip(1, row->text(1));
    }
    heading->setExpanded(facts.heading != "How it was made" && facts.heading != "Unit cell");
  }
}

void MaterialPanel::copy() {
  if (!workspace_.document()) return;
  QString text;
  for (const MaterialFacts& facts : material_facts(*workspace_.document())) {
    text += QString::fromStdString(facts.heading) + "\n";
    for (const auto& [label, value] : facts.rows) {
      text += "  " + QString::fromStdString(label) + ": " + QString::fromStdString(value) + "\n";
    }
  }
  QApplication::clipboard()->setText(text);
}

}  // namespace atomesh::gui
