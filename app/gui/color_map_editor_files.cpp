// What the colour map's editor reads and writes: maps as text and files, the histogram.
#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QFileInfo>
#include <QPushButton>
#include <utility>

#include "app/gui/color_map_editor.h"
#include "app/gui/color_map_files.h"
#include "core/error.h"
#include "core/parameter_text.h"

namespace atomesh::gui {

void ColorMapEditor::copy_text() {
  QApplication::clipboard()->setText(QString::fromStdString(color_map_text(color_map())));
}

void ColorMapEditor::paste_text() {
  try {
    const ColorMap pasted = read_color_map(QApplication::clipboard()->text().trimmed().toStdString());
    check_color_map(pasted);
    ColorMap map = color_map();
    apply_color_map(map, pasted, part());
    change(map, tr("Paste color map"));
    show_refusal({});
  } catch (const UsageError& error) {
    show_refusal(tr("The clipboard holds no color map: %1").arg(QString::fromUtf8(error.what())));
  }
}

void ColorMapEditor::load_color_map(const QString& path) {
  try {
    const ColorMapFile file = read_color_map_file(path.toStdString());
    ColorMap map = color_map();
    apply_color_map(map, file.map, file.opacities ? part() : ColorMapPart::color);
    change(map, tr("Load color map"));
    show_refusal({});
    if (!file.note.empty()) workspace_.say(QString::fromStdString(file.note));
  } catch (const Error& error) {
    workspace_.complain(QString::fromUtf8(error.what()));
  }
}

void ColorMapEditor::save_color_map(const QString& path) {
  try {
    write_color_map_file(path.toStdString(), color_map(), QFileInfo(path).completeBaseName().toStdString());
  } catch (const Error& error) {
    workspace_.complain(QString::fromUtf8(error.what()));
  }
}

void ColorMapEditor::ask_which_to_load() {
  auto* dialog = new QFileDialog(this, tr("Load color map"), QString(),
                                 tr("Color maps of ParaView, strips of colors (*.json *.png)"));
  dialog->setObjectName("load_color_map_dialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  connect(dialog, &QFileDialog::fileSelected, this, &ColorMapEditor::load_color_map);
  dialog->open();
}

void ColorMapEditor::ask_where_to_save() {
  auto* dialog = new QFileDialog(this, tr("Save color map"), QString(), tr("Color map of ParaView (*.json)"));
  dialog->setObjectName("save_color_map_dialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix("json");
  connect(dialog, &QFileDialog::fileSelected, this, &ColorMapEditor::save_color_map);
  dialog->open();
}

void ColorMapEditor::write_histogram(const QString& path) {
  if (!workspace_.document()) {
    workspace_.complain(tr("Open a file before its scalar histogram is created."));
    return;
  }
  histogram_path_ = path;
  source_.set_wanted(true);
  write_when_counted();
}

void ColorMapEditor::write_when_counted() {
  if (!workspace_.document()) histogram_path_.clear();  // it was closed meanwhile
  if (histogram_path_.isEmpty()) return;
  const bool in_vain = !source_.counting() && !source_.trouble().isEmpty();
  if (!in_vain && !source_.up_to_date()) return;
  const QString path = std::exchange(histogram_path_, {});
  try {
    if (in_vain) throw UsageError(source_.trouble().toStdString());
    write_histogram_csv(path.toStdString(), *source_.histogram());
    workspace_.say(tr("Scalar histogram of %L1 bins written to %2").arg(source_.histogram()->counts.size()).arg(path));
  } catch (const Error& error) {
    workspace_.complain(tr("The scalar histogram was not written: %1").arg(QString::fromUtf8(error.what())));
  }
  source_.set_wanted(isVisible());
}

void ColorMapEditor::ask_where_to_write_histogram() {
  const auto& document = workspace_.document();
  const QString folder = document ? QFileInfo(QString::fromStdString(document->path)).absolutePath() : QString();
  auto* dialog = new QFileDialog(this, tr("Create Scalar Histogram"), folder, tr("Comma-separated values (*.csv)"));
  dialog->setObjectName("histogram_file_dialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix("csv");
  dialog->selectFile("histogram.csv");
  connect(dialog, &QFileDialog::fileSelected, this, &ColorMapEditor::write_histogram);
  dialog->open();
}

}  // namespace atomesh::gui
