#include "app/gui/preprocessing_page.h"

#include <QCheckBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSettings>
#include <QTableWidget>
#include <QTime>
#include <QVBoxLayout>

#include "app/cli/preprocess_file.h"
#include "app/cli/text_table.h"
#include "core/memory.h"

namespace atomesh::gui {

namespace {

constexpr Qt::ItemFlags row_has_begun = Qt::ItemIsEnabled | Qt::ItemIsSelectable;

enum Column { stage_column, time_column, memory_column, result_column, column_count };

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

std::unique_ptr<QSettings> open_settings(const QString& file) {
  return file.isEmpty() ? std::make_unique<QSettings>() : std::make_unique<QSettings>(file, QSettings::IniFormat);
}

}  // namespace

PreprocessingPage::PreprocessingPage(QWidget* parent, const QString& settings_file)
    : QWidget(parent), settings_file_(settings_file) {
  setObjectName("preprocessing");
  title_ = new QLabel;
  title_->setObjectName("preprocessing_title");
  QFont large = title_->font();
  large.setPointSizeF(large.pointSizeF() * 1.5);
  title_->setFont(large);
  bar_ = new QProgressBar;
  bar_->setObjectName("preprocessing_progress");
  bar_->setRange(0, 1000);
  status_ = new QLabel;
  status_->setObjectName("preprocessing_status");
  status_->setWordWrap(true);
  status_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  log_ = new QPlainTextEdit;
  log_->setObjectName("preprocessing_log");
  log_->setReadOnly(true);
  log_->setMaximumBlockCount(10'000);
  log_->setToolTip(tr("What was done, and what a person should know"));
  auto* log_label = new QLabel(tr("&Log:"));
  log_label->setBuddy(log_);
  auto* column = new QVBoxLayout(this);
  column->addWidget(title_);
  column->addWidget(bar_);
  column->addWidget(status_);
  column->addWidget(make_table(), 3);
  column->addWidget(log_label);
  column->addWidget(log_, 2);
  column->addWidget(make_buttons());

  connect(&run_, &Preprocessing::began, this, &PreprocessingPage::show_plan);
  connect(&run_, &Preprocessing::stage_began, this, &PreprocessingPage::mark_running);
  connect(&run_, &Preprocessing::stage_ended, this, &PreprocessingPage::show_row);
  connect(&run_, &Preprocessing::progressed, this,
          [this](double fraction) { bar_->setValue(static_cast<int>(1000.0 * fraction)); });
  connect(&run_, &Preprocessing::noted, this, [this](const QString& note) {
    write(tr("note: %1").arg(note));  // said by who shows the document
  });
  connect(&run_, &Preprocessing::cancelled, this, [this] { finish(tr("Cancelled. Nothing was saved.")); });
  connect(&run_, &Preprocessing::failed, this, [this](const QString& problem) { finish(problem); });
  connect(&run_, &Preprocessing::done, this, [this] {
    const Document& document = *run_.document();
    for (std::size_t i = 0; i < run_.stages().size(); ++i) {  // with what only the end could tell
      stages_->item(static_cast<int>(i), result_column)->setText(text(run_.stages()[i].outcome));
    }
    double ms = 0.0;
    for (const StageTime& stage : document.times) ms += stage.ms;
    QStringList names;
    for (const std::string& path : run_.written()) names << text(path);
    finish(!run_.problem().isEmpty() ? run_.problem()
           : names.isEmpty()
               ? tr("Done in %1 ms.").arg(text(cli::milliseconds(ms)))
               : tr("Done in %1 ms; saved as %2.").arg(text(cli::milliseconds(ms)), names.join(tr(" and "))));
    if (automatic_->isChecked() && run_.problem().isEmpty()) emit go_on(document);
  });
  show_buttons();
}

PreprocessingPage::~PreprocessingPage() {
  run_.disconnect(this);  // what it says while it goes is for nobody
}

QWidget* PreprocessingPage::make_table() {
  stages_ = new QTableWidget(0, column_count);
  stages_->setObjectName("stages");
  stages_->setHorizontalHeaderLabels({tr("Stage"), tr("ms"), tr("Memory"), tr("Result")});
  stages_->verticalHeader()->hide();
  stages_->horizontalHeader()->setStretchLastSection(true);
  stages_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  stages_->setSelectionBehavior(QAbstractItemView::SelectRows);
  stages_->setShowGrid(false);
  stages_->setWordWrap(true);
  stages_->setTabKeyNavigation(false);
  stages_->setToolTip(
      tr("The stages of preprocessing: how long each took, the most memory that was held, what came "
         "of it"));
  return stages_;
}

QWidget* PreprocessingPage::make_buttons() {
  automatic_ = new QCheckBox(tr("Go on to rendering &when done"));
  automatic_->setObjectName("automatic");
  automatic_->setToolTip(tr("Else this page stays until you choose"));
  automatic_->setChecked(open_settings(settings_file_)->value("preprocessing/go_on", true).toBool());
  connect(automatic_, &QCheckBox::toggled, this,
          [this](bool on) { open_settings(settings_file_)->setValue("preprocessing/go_on", on); });
  const auto button = [](const QString& name, const QString& label, const QString& tip) {
    auto* made = new QPushButton(label);
    made->setObjectName(name);
    made->setToolTip(tip);
    made->setAutoDefault(true);
    return made;
  };
  cancel_ = button("preprocessing_cancel", tr("&Cancel"), tr("Stops (Escape); nothing half written is left"));
  again_ = button("again", tr("Start &again"), tr("The same file with the same settings once more"));
  back_ = button("back", tr("&Back to loader"), tr("Choose another file, or other settings"));
  go_on_ = button("go_on", tr("&Go on to rendering"), tr("Shows the sample"));
  auto* buttons = new QWidget;
  auto* row = new QHBoxLayout(buttons);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(automatic_);
  row->addStretch(1);
  for (QPushButton* one : {go_on_, again_, back_, cancel_}) row->addWidget(one);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    status_->setText(tr("Cancelling…"));
    run_.cancel();
  });
  connect(again_, &QPushButton::clicked, this, [this] {
    const PreprocessingRequest same = run_.request();
    run_.start(same);
  });
  connect(back_, &QPushButton::clicked, this, [this] {
    emit back_to_loader(text(run_.written().empty() ? run_.request().input : run_.written().front()));
  });
  connect(go_on_, &QPushButton::clicked, this, [this] {
    if (run_.document()) emit go_on(*run_.document());
  });
  return buttons;
}

void PreprocessingPage::start(const PreprocessingRequest& request) {
  run_.start(request);
}

void PreprocessingPage::keyPressEvent(QKeyEvent* event) {
  if (event->matches(QKeySequence::Cancel) && cancel_->isVisible()) {
    cancel_->click();
  } else {
    QWidget::keyPressEvent(event);
  }
}

void PreprocessingPage::show_plan() {
  const PreprocessingRequest& request = run_.request();
  title_->setText(tr("Preprocessing %1").arg(QFileInfo(text(request.input)).fileName()));
  status_->setText(tr("Working…"));
  bar_->setValue(0);
  next_row_ = 0;
  log_->clear();
  const std::vector<std::string> planned = planned_stages(request);
  stages_->setRowCount(0);
  stages_->setRowCount(static_cast<int>(planned.size()));
  for (int row = 0; row < stages_->rowCount(); ++row) {
    const std::string& name = planned[static_cast<std::size_t>(row)];
    for (int column = 0; column < column_count; ++column) {
      auto* item = new QTableWidgetItem(column == stage_column ? stage_title(name) : QString());
      item->setData(Qt::UserRole, text(name));
      if (column == time_column || column == memory_column) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      item->setFlags(Qt::NoItemFlags);  // gray, in whatever theme
      stages_->setItem(row, column, item);
    }
  }
  stages_->resizeColumnToContents(stage_column);
  log(text(request.input));
  QStringList options;
  for (const auto& [name, value] : cli::recorded_options(request.settings, request.settings.options.read.format)) {
    if (!value.empty() && name != "unit_cell_hash") options << text(name) + " " + text(value);
  }
  log(tr("settings: %1").arg(options.join(", ")));
  show_buttons();
}

void PreprocessingPage::mark_running(const QString& name) {
  const QString stage = name == "write" ? QString("write_material") : name;
  for (int row = next_row_; row < stages_->rowCount(); ++row) {
    if (stages_->item(row, stage_column)->data(Qt::UserRole).toString() != stage) continue;
    leave_out(next_row_, row);
    stages_->item(next_row_, stage_column)->setFlags(row_has_begun);
    stages_->item(next_row_, result_column)->setFlags(row_has_begun);
    stages_->item(next_row_, result_column)->setText(tr("…"));
    stages_->scrollToItem(stages_->item(next_row_, stage_column));
    break;
  }
  status_->setText(stage_title(stage.toStdString()) + tr("…"));
}

// Stages that were planned and whose turn has passed.
void PreprocessingPage::leave_out(int from, int to) {
  for (int row = to - 1; row >= from; --row) stages_->removeRow(row);
}

void PreprocessingPage::show_row(const StageRow& row) {
  int place = next_row_;
  while (place < stages_->rowCount() &&
         stages_->item(place, stage_column)->data(Qt::UserRole).toString() != text(row.name)) {
    ++place;
  }
  if (place == stages_->rowCount()) {  // one that was not planned
    place = next_row_;
    stages_->insertRow(place);
    for (int column = 0; column < column_count; ++column) {
      stages_->setItem(place, column, new QTableWidgetItem(column == stage_column ? stage_title(row.name) : QString()));
      stages_->item(place, column)->setData(Qt::UserRole, text(row.name));
    }
  } else {
    leave_out(next_row_, place);
    place = next_row_;
  }
  const QString ms = text(cli::milliseconds(row.ms));
  stages_->item(place, time_column)->setText(ms);
  stages_->item(place, memory_column)->setText(text(memory_text(row.memory)));
  stages_->item(place, result_column)->setText(text(row.outcome));
  stages_->item(place, result_column)->setToolTip(text(row.outcome));
  for (int column = 0; column < column_count; ++column) {
    stages_->item(place, column)->setFlags(row_has_begun);
  }
  for (const int column : {stage_column, time_column, memory_column}) stages_->resizeColumnToContents(column);
  ++next_row_;
  log(tr("%1: %2 ms. %3").arg(text(row.name), ms, text(row.outcome)));
}

void PreprocessingPage::finish(const QString& status) {
  status_->setText(status);
  leave_out(next_row_, stages_->rowCount());
  log(status);
  show_buttons();
  const bool done = run_.state() == Preprocessing::State::done;
  (done ? go_on_ : back_)->setDefault(true);
  (done ? go_on_ : back_)->setFocus();
}

void PreprocessingPage::write(const QString& line) {
  log_->appendPlainText(QTime::currentTime().toString("HH:mm:ss  ") + line);
}

void PreprocessingPage::log(const QString& line) {
  write(line);
  emit said(line);
}

void PreprocessingPage::show_buttons() {
  const Preprocessing::State state = run_.state();
  const bool running = state == Preprocessing::State::running;
  cancel_->setVisible(running);
  again_->setVisible(state == Preprocessing::State::cancelled || state == Preprocessing::State::failed);
  back_->setVisible(!running);
  go_on_->setVisible(state == Preprocessing::State::done);
  if (running) cancel_->setFocus();
  emit state_changed();
}

}  // namespace atomesh::gui
