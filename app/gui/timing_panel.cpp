#include "app/gui/timing_panel.h"

#include <QApplication>
#include <QClipboard>
#include <QGridLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QPainter>
#include <QPushButton>
#include <QStyledItemDelegate>
#include <QTreeWidget>

#include "app/gui/render_worker.h"
#include "core/memory.h"

namespace atomesh::gui {

namespace {

enum StageColumn { stage_name, stage_time, stage_part, stage_memory };
constexpr int part_role = Qt::UserRole;  // of the longest, 0 to 1

// A bar behind the number of its part.
class BarDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const double part = index.data(part_role).toDouble();
    QRectF bar = QRectF(option.rect).adjusted(2, 3, -2, -3);
    bar.setWidth(bar.width() * part);
    QColor color = option.palette.color(QPalette::Highlight);
    color.setAlphaF(0.45F);
    painter->fillRect(bar, color);
    QStyledItemDelegate::paint(painter, option, index);
  }
};

QString text_of(const std::string& text) {
  return QString::fromStdString(text);
}

}  // namespace

TimingPanel::TimingPanel(Workspace& workspace, QWidget* parent) : QWidget(parent), workspace_(workspace) {
  setObjectName("timing_panel");
  setWindowTitle(tr("Timing"));
  watch_.start();
  build();
  connect(&workspace, &Workspace::times_changed, this, &TimingPanel::set_stages);
  if (workspace.document()) set_stages(workspace.document()->times);
}

void TimingPanel::build() {
  stages_title_ = new QLabel(tr("&Stages"), this);
  stages_title_->setObjectName("stages_title");
  stages_tree_ = new QTreeWidget(this);
  stages_tree_->setObjectName("stages");
  stages_tree_->setRootIsDecorated(false);
  stages_tree_->setUniformRowHeights(true);
  stages_tree_->setHeaderLabels({tr("Stage"), tr("Time"), tr("Part"), tr("Memory")});
  stages_tree_->headerItem()->setToolTip(stage_part, tr("Of the whole; the bar is of the longest"));
  stages_tree_->headerItem()->setToolTip(stage_memory, tr("The most that the process held while the stage ran"));
  stages_tree_->setItemDelegateForColumn(stage_part, new BarDelegate(stages_tree_));
  stages_tree_->header()->setStretchLastSection(false);
  stages_tree_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  stages_tree_->header()->setSectionResizeMode(stage_part, QHeaderView::Stretch);
  stages_title_->setBuddy(stages_tree_);
  auto* frame_title = new QLabel(tr("&Frame"), this);
  frame_tree_ = new QTreeWidget(this);
  frame_tree_->setObjectName("frame_times");
  frame_tree_->setRootIsDecorated(false);
  frame_tree_->setUniformRowHeights(true);
  frame_tree_->setHeaderLabels({tr("What"), tr("Value")});
  frame_title->setBuddy(frame_tree_);
  copy_ = new QPushButton(tr("Co&py"), this);
  copy_->setObjectName("timing_copy");
  copy_->setToolTip(tr("All of this as text"));
  connect(copy_, &QPushButton::clicked, this, &TimingPanel::copy);
  auto* all = new QGridLayout(this);
  all->addWidget(stages_title_, 0, 0);
  all->addWidget(stages_tree_, 1, 0);
  all->addWidget(frame_title, 0, 1);
  all->addWidget(frame_tree_, 1, 1);
  all->addWidget(copy_, 2, 1, Qt::AlignRight);
  all->setColumnStretch(0, 3);
  all->setColumnStretch(1, 2);
}

void TimingPanel::set_stages(const std::vector<StageTime>& stages) {
  stages_ = stages;
  const auto& document = workspace_.document();
  memory_.clear();
  // What the stages of preprocessing held; they come first where more (writing, reading) was done.
  if (document && document->pipeline && document->pipeline->stage_memory.size() <= stages.size()) {
    memory_ = document->pipeline->stage_memory;
  }
  show_stages();
}

void TimingPanel::show_stages() {
  stages_tree_->clear();
  stages_tree_->setColumnHidden(stage_memory, memory_.empty());
  for (const TimeRow& row : time_rows(stages_, memory_)) {
    auto* item = new QTreeWidgetItem(
        stages_tree_, {text_of(row.name), text_of(time_text(row.ms)), tr("%1 %").arg(100.0 * row.of_all, 0, 'f', 1),
                       row.memory ? text_of(memory_text(*row.memory)) : QString()});
    item->setData(stage_part, part_role, row.of_longest);
    for (const int column : {stage_time, stage_part, stage_memory}) item->setTextAlignment(column, Qt::AlignRight);
  }
  stages_title_->setText(stages_.empty() ? tr("&Stages: open a file to see where the time goes")
                                         : tr("&Stages: %1").arg(text_of(time_text(total_ms(stages_)))));
}

void TimingPanel::note_picture(std::shared_ptr<const WorkerPicture> picture, double gpu_ms, bool whole) {
  FrameTimes frame;
  std::uint64_t number = 0;
  double ms = gpu_ms;
  if (picture) {
    frame.drawn_by = "CPU";
    frame.width = picture->camera.width;
    frame.height = picture->camera.height;
    frame.scene_ms = picture->scene_ms;
    frame.setup_ms = picture->stats.setup_ms;
    frame.steps = picture->stats.steps;
    frame.level = picture->level;
    frame.levels = picture->levels;
    number = 2 * picture->number;
    ms = picture->ms;
    card_refines_ = false;
  } else {
    frame.drawn_by = "graphics card";
    frame.width = workspace_.width();
    frame.height = workspace_.height();
    // Whole at once, or the second of two.
    const bool second = whole && card_refines_;
    frame.level = second ? 2 : 1;
    frame.levels = whole && !second ? 1 : 2;
    if (!second) ++card_pictures_;
    card_refines_ = !whole;
    number = 2 * card_pictures_ + 1;
  }
  set_frame(clock_.shown(frame, number, ms, static_cast<double>(watch_.nsecsElapsed()) * 1e-6));
}

void TimingPanel::set_frame(const FrameTimes& times) {
  frame_ = times;
  any_frame_ = true;
  if (isVisible()) show_frame();  // many come while the view turns
}

void TimingPanel::showEvent(QShowEvent* event) {
  show_frame();
  QWidget::showEvent(event);
}

void TimingPanel::show_frame() {
  // Rows stay, so that a selection does and nothing flickers.
  int row = 0;
  const auto add = [&](const QString& what, const QString& value) {
    if (row == frame_tree_->topLevelItemCount()) new QTreeWidgetItem(frame_tree_);
    QTreeWidgetItem* item = frame_tree_->topLevelItem(row++);
    item->setText(0, what);
    item->setText(1, value);
  };
  if (any_frame_) {
    add(tr("Drawn by"), frame_.drawn_by == "CPU" ? tr("CPU") : tr("graphics card"));
    add(tr("Size"), tr("%1 × %2 pixels").arg(frame_.width).arg(frame_.height));
    if (frame_.scene_ms > 0.0) add(tr("Making the scene"), text_of(time_text(frame_.scene_ms)));
    if (frame_.setup_ms > 0.0) add(tr("Preparing the view"), text_of(time_text(frame_.setup_ms)));
    if (frame_.levels > 1 && frame_.first_ms) add(tr("First picture"), text_of(time_text(*frame_.first_ms)));
    add(tr("Whole picture"), frame_.whole_ms ? text_of(time_text(*frame_.whole_ms))
                                             : tr("drawing %1 of %2").arg(frame_.level).arg(frame_.levels));
    add(tr("Pictures a second"), frame_.per_second ? tr("%1").arg(*frame_.per_second, 0, 'f', 1) : tr("–"));
    if (frame_.steps > 0) add(tr("Steps of all rays"), tr("%L1").arg(static_cast<qulonglong>(frame_.steps)));
    if (frame_.memory > 0) add(tr("Memory held"), text_of(memory_text(frame_.memory)));
  }
  while (frame_tree_->topLevelItemCount() > row) delete frame_tree_->takeTopLevelItem(row);
  frame_tree_->resizeColumnToContents(0);
}

void TimingPanel::copy() {
  show_frame();
  QString text;
  for (const TimeRow& row : time_rows(stages_, memory_)) {
    text += text_of(row.name) + '\t' + text_of(time_text(row.ms));
    if (row.memory) text += '\t' + text_of(memory_text(*row.memory));
    text += '\n';
  }
  for (int row = 0; row < frame_tree_->topLevelItemCount(); ++row) {
    text += frame_tree_->topLevelItem(row)->text(0) + '\t' + frame_tree_->topLevelItem(row)->text(1) + '\n';
  }
  QApplication::clipboard()->setText(text);
}

}  // namespace atomesh::gui
