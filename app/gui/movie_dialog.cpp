#include "app/gui/movie_dialog.h"

#include <QComboBox>
#include <QDir>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLocale>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QVBoxLayout>
#include <array>

#include "app/gui/picture_form.h"
#include "app/gui/wheel_guard.h"
#include "core/error.h"
#include "core/memory.h"

namespace atomesh::gui {

namespace {

struct Format {
  const char* name;
  const char* ending;
};
constexpr std::array<Format, 7> formats{{{QT_TRANSLATE_NOOP("MovieDialog", "Ogg Theora (.ogv)"), ".ogv"},
                                         {QT_TRANSLATE_NOOP("MovieDialog", "MP4, H.264 (.mp4)"), ".mp4"},
                                         {QT_TRANSLATE_NOOP("MovieDialog", "WebM, VP9 (.webm)"), ".webm"},
                                         {QT_TRANSLATE_NOOP("MovieDialog", "Matroska, H.264 (.mkv)"), ".mkv"},
                                         {QT_TRANSLATE_NOOP("MovieDialog", "QuickTime, H.264 (.mov)"), ".mov"},
                                         {QT_TRANSLATE_NOOP("MovieDialog", "AVI, MPEG-4 (.avi)"), ".avi"},
                                         {QT_TRANSLATE_NOOP("MovieDialog", "Numbered pictures (.png)"), ".png"}}};

}  // namespace

MovieDialog::MovieDialog(Workspace& workspace, QWidget* parent)
    : OutputDialog(workspace, "movie", ".ogv", parent), form_(new PictureForm(workspace, this)) {
  setWindowTitle(tr("Turntable movie"));
  build_turn();
  content().addWidget(form_);
  connect(form_, &PictureForm::changed, this, &MovieDialog::check);
  finish_building();
  follow_path();
}

void MovieDialog::build_turn() {
  auto* form = new QFormLayout;
  const auto box = [&](const char* name, const QStringList& items) {
    auto* combo = new QComboBox(this);
    combo->setObjectName(name);
    combo->addItems(items);
    guard_wheel(combo);
    return combo;
  };
  const auto number = [&](const char* name, int low, int high, int value, const QString& tip) {
    auto* spin = new QSpinBox(this);
    spin->setObjectName(name);
    spin->setRange(low, high);
    spin->setValue(value);
    spin->setToolTip(tip);
    guard_wheel(spin);
    connect(spin, &QSpinBox::valueChanged, this, &MovieDialog::check);
    return spin;
  };
  QStringList names;
  for (const Format& format : formats) names << tr(format.name);
  format_ = box("movie_format", names);
  format_->setToolTip(tr("All but Ogg Theora and numbered pictures need the program ffmpeg"));
  connect(format_, &QComboBox::activated, this, &MovieDialog::take_format);
  form->addRow(tr("F&ormat"), format_);
  axis_ = box("movie_axis", {tr("The sample's z axis"), tr("The picture's vertical")});
  axis_->setToolTip(tr("The turn goes through the rotation center"));
  form->addRow(tr("Turn a&bout"), axis_);
  direction_ = box("movie_direction", {tr("Front to the right"), tr("Front to the left")});
  form->addRow(tr("&Direction"), direction_);
  auto* row = new QHBoxLayout;
  frames_ = number("movie_frames", 2, 10000, 120, tr("Pictures of one whole turn"));
  rate_ = number("movie_rate", 1, 120, 25, tr("Pictures shown in a second"));
  lasts_ = new QLabel(this);
  lasts_->setObjectName("movie_lasts");
  auto* per_second = new QLabel(tr("at r&ate"), this);
  per_second->setBuddy(rate_);
  rate_->setSuffix(tr(" per second"));
  row->addWidget(frames_, 1);
  row->addWidget(per_second);
  row->addWidget(rate_, 1);
  row->addWidget(lasts_);
  auto* label = new QLabel(tr("F&rames"), this);
  label->setBuddy(frames_);
  form->addRow(label, row);
  quality_ = box("movie_quality", {tr("Small file"), tr("Medium"), tr("Best")});
  quality_->setCurrentIndex(2);
  form->addRow(tr("&Quality"), quality_);
  content().addLayout(form);
}

void MovieDialog::showEvent(QShowEvent* event) {
  if (!working()) form_->follow_view();
  OutputDialog::showEvent(event);
}

void MovieDialog::take_format() {
  const QFileInfo file(path());
  const Format& format = formats[static_cast<std::size_t>(format_->currentIndex())];
  if (!path().isEmpty()) set_path(file.dir().filePath(file.completeBaseName() + format.ending));
}

// The format goes by the name, whoever changed it.
void MovieDialog::follow_path() {
  const QString ending = "." + QFileInfo(path()).suffix().toLower();
  for (std::size_t i = 0; i < formats.size(); ++i) {
    if (ending != formats[i].ending) continue;
    const QSignalBlocker quiet(format_);
    format_->setCurrentIndex(static_cast<int>(i));
  }
}

QString MovieDialog::filter() const {
  QStringList all;
  for (const Format& format : formats) all << QString("*") + format.ending;
  QStringList filters{tr("Movies (%1)").arg(all.join(' '))};
  for (const Format& format : formats) filters << tr(format.name).replace("(.", "(*.");
  return filters.join(";;");
}

TurntableSettings MovieDialog::settings() const {
  TurntableSettings settings;
  settings.axis = axis_->currentIndex() == 0 ? TurntableAxis::z : TurntableAxis::picture;
  settings.degrees = direction_->currentIndex() == 0 ? 360.0 : -360.0;
  settings.frames = frames_->value();
  settings.frames_per_second = rate_->value();
  settings.quality = quality_->currentIndex();
  settings.picture = form_->settings();
  return settings;
}

QString MovieDialog::plan() {
  const std::string file = path().toStdString();
  const bool pictures = movie_kind(file) == MovieKind::pictures;
  follow_path();
  form_->allow_transparent(pictures, tr("Movies have no transparency; numbered pictures do"));
  quality_->setEnabled(!pictures);
  const QLocale locale;
  lasts_->setText(tr("= %1 s").arg(locale.toString(static_cast<double>(frames_->value()) / rate_->value(), 'f', 1)));
  if (!QFileInfo(path()).dir().exists()) {
    throw UsageError("the folder does not exist: " + QFileInfo(path()).absolutePath().toStdString());
  }
  const std::string problem = movie_problem(file);
  if (!problem.empty()) throw UnavailableError(problem);
  const PictureSettings frame = frame_settings(file, form_->settings());
  const PicturePlan plan = plan_picture(workspace_.shown(), frame);
  const QString size = tr("%1 × %2 pixels").arg(locale.toString(frame.width), locale.toString(frame.height));
  if (pictures) {
    return tr("%1 pictures of %2, %3 to %4; each opens with its view")
        .arg(locale.toString(frames_->value()), size,
             QFileInfo(QString::fromStdString(numbered_path(file, 1))).fileName(),
             QFileInfo(QString::fromStdString(numbered_path(file, frames_->value()))).fileName());
  }
  return tr("%1 frames of %2, drawn by the processor in about %3 of memory")
      .arg(locale.toString(frames_->value()), size,
           QString::fromStdString(memory_text(plan.bytes * static_cast<std::uint64_t>(plan.passes))));
}

QStringList MovieDialog::in_the_way() const {
  const std::string file = path().toStdString();
  if (movie_kind(file) != MovieKind::pictures) return OutputDialog::in_the_way();
  QStringList there;
  for (int frame = 1; frame <= frames_->value(); ++frame) {
    const QString picture = QString::fromStdString(numbered_path(file, frame));
    if (QFileInfo::exists(picture)) there << picture;
  }
  return there;
}

Job::Work MovieDialog::work() const {
  return [document = *workspace_.document(), parameters = workspace_.shown(), pivot = workspace_.rotation_center(),
          settings = this->settings(), file = path().toStdString()](Progress& progress) {
    save_turntable(file, document, parameters, pivot, settings, progress);
  };
}

}  // namespace atomesh::gui
