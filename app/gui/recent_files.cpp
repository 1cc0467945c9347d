#include "app/gui/recent_files.h"

#include <QFileInfo>
#include <QSettings>
#include <utility>

#include "app/gui/job.h"

namespace atomesh::gui {

RecentFiles::RecentFiles(const QString& what, const QString& settings_file, QObject* parent)
    : QObject(parent),
      settings_(settings_file.isEmpty() ? std::make_unique<QSettings>()
                                        : std::make_unique<QSettings>(settings_file, QSettings::IniFormat)),
      key_("recent/" + what) {
  files_ = settings_->value(key_).toStringList().mid(0, most);
}

RecentFiles::~RecentFiles() = default;

void RecentFiles::add(const QString& path) {
  const QString file = QFileInfo(path).absoluteFilePath();
  // Other windows of the program may have added theirs.
  settings_->sync();
  files_ = settings_->value(key_).toStringList();
  files_.removeAll(file);
  files_.prepend(file);
  files_ = files_.mid(0, most);
  missing_.remove(file);
  keep();
}

void RecentFiles::remove(const QString& path) {
  if (files_.removeAll(path) > 0) keep();
}

void RecentFiles::clear() {
  files_.clear();
  keep();
}

void RecentFiles::look() {
  settings_->sync();
  files_ = settings_->value(key_).toStringList().mid(0, most);
  const auto found = std::make_shared<QSet<QString>>();
  looking_ = std::make_unique<Job>(
      tr("Recent files"),
      [found, files = files_](Progress& progress) {
        for (const QString& file : files) {
          progress.check();
          if (!QFileInfo::exists(file)) found->insert(file);
        }
      },
      nullptr, Job::Unheeded::leave);
  connect(looking_.get(), &Job::done, this, [this, found] {
    looking_.release()->deleteLater();
    missing_ = *found;
    emit changed();
  });
  looking_->start();
}

void RecentFiles::keep() {
  settings_->setValue(key_, files_);
  settings_->sync();
  emit changed();
}

}  // namespace atomesh::gui
