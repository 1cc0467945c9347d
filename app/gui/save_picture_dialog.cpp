#include "app/gui/save_picture_dialog.h"

#include <QDir>
#include <QFileInfo>
#include <QLocale>
#include <QVBoxLayout>

#include "app/gui/picture_form.h"
#include "core/error.h"
#include "core/memory.h"

namespace atomesh::gui {

SavePictureDialog::SavePictureDialog(Workspace& workspace, QWidget* parent)
    : OutputDialog(workspace, "save_picture", ".png", parent), form_(new PictureForm(workspace, this)) {
  setWindowTitle(tr("Save picture"));
  content().addWidget(form_);
  connect(form_, &PictureForm::changed, this, &SavePictureDialog::check);
  finish_building();
}

void SavePictureDialog::showEvent(QShowEvent* event) {
  if (!working()) form_->follow_view();
  OutputDialog::showEvent(event);
}

QString SavePictureDialog::filter() const {
  return tr("Pictures (*.png)");
}

QString SavePictureDialog::plan() {
  const QFileInfo file(path());
  if (file.suffix().compare("png", Qt::CaseInsensitive) != 0) throw UsageError("the name must end in .png");
  if (!file.dir().exists()) throw UsageError("the folder does not exist: " + file.absolutePath().toStdString());
  const PictureSettings settings = form_->settings();
  const PicturePlan plan = plan_picture(workspace_.shown(), settings);
  const QLocale locale;
  const double megapixels = 1e-6 * settings.width * settings.height;
  QString text = tr("%1 × %2 pixels (%3 megapixels), drawn by the processor in about %4 of memory")
                     .arg(locale.toString(settings.width), locale.toString(settings.height),
                          locale.toString(megapixels, 'g', 3), QString::fromStdString(memory_text(plan.bytes)));
  if (plan.passes > 1) text += tr(", in %1 passes").arg(plan.passes);
  return text + tr(". The file carries these parameters: opening it shows this view again.");
}

Job::Work SavePictureDialog::work() const {
  return [document = *workspace_.document(), parameters = workspace_.shown(), settings = form_->settings(),
          file = path().toStdString()](Progress& progress) {
    save_picture(file, document, parameters, settings, progress);
  };
}

}  // namespace atomesh::gui
