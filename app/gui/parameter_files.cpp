#include "app/gui/parameter_files.h"

#include <QDir>
#include <QFileInfo>
#include <QSettings>

#include "app/gui/workspace.h"
#include "core/error.h"
#include "core/parameter_file.h"

namespace atomesh::gui {

namespace {

constexpr const char* recent_key = "recent/parameter_files";
constexpr int most_recent = 10;

void remember(const std::string& path) {
  const QString name = QFileInfo(QString::fromStdString(path)).absoluteFilePath();
  QSettings settings;
  QStringList names = settings.value(recent_key).toStringList();
  names.removeAll(name);
  names.prepend(name);
  settings.setValue(recent_key, names.mid(0, most_recent));
}

}  // namespace

std::string parameter_file_path(const QString& typed, const std::optional<Document>& document) {
  const QString name = typed.trimmed();
  if (name.isEmpty() || name.compare(QLatin1String("default"), Qt::CaseInsensitive) == 0) {
    if (!document) {
      throw UsageError("\"default\" is the name of the data set, and none is open: type a file name, or open a file");
    }
    const QFileInfo data(QString::fromStdString(document->path));
    return data.dir().filePath(data.completeBaseName() + QStringLiteral(".crf")).toStdString();
  }
  QFileInfo file(name);
  if (file.suffix().isEmpty()) file.setFile(name + QStringLiteral(".crf"));
  if (file.isRelative() && document) {
    const QDir beside = QFileInfo(QString::fromStdString(document->path)).dir();
    return QDir::cleanPath(beside.filePath(file.filePath())).toStdString();
  }
  return QDir::cleanPath(file.absoluteFilePath()).toStdString();
}

void load_parameter_file(Workspace& workspace, const std::string& path) {
  const Parameters loaded = read_crf(path);
  const QString name = QFileInfo(QString::fromStdString(path)).fileName();
  workspace.change(loaded, QObject::tr("Load %1").arg(name));
  remember(path);
  workspace.say(QObject::tr("Parameters from %1").arg(QString::fromStdString(path)));
}

void save_parameter_file(Workspace& workspace, const std::string& path) {
  const QFileInfo file(QString::fromStdString(path));
  if (file.exists() && file.suffix().compare(QLatin1String("crf"), Qt::CaseInsensitive) != 0) {
    try {
      static_cast<void>(read_crf(path));
    } catch (const Error&) {
      throw UsageError(path + " is there already and is no parameter file; choose another name, or one with .crf");
    }
  }
  write_crf(path, workspace.parameters());
  remember(path);
  workspace.say(QObject::tr("Parameters saved as %1").arg(QString::fromStdString(path)));
}

QStringList recent_parameter_files() {
  QStringList names = QSettings().value(recent_key).toStringList();
  names.removeIf([](const QString& name) { return !QFileInfo::exists(name); });
  return names;
}

}  // namespace atomesh::gui
