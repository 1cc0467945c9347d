// The files that were last opened, newest first, kept between runs of the program. Without widgets.
#pragma once

#include <QObject>
#include <QSet>
#include <QString>
#include <QStringList>
#include <memory>

class QSettings;

namespace atomesh::gui {

class Job;

class RecentFiles : public QObject {
  Q_OBJECT

 public:
  static constexpr int most = 12;

  // `what` is the name under which they are kept: "data", "parameter_files". `settings_file`: an .ini in the place of
  // the program's own settings.
  explicit RecentFiles(const QString& what, const QString& settings_file = {}, QObject* parent = nullptr);
  ~RecentFiles() override;

  const QStringList& files() const { return files_; }  // absolute paths
  // To the top; without a second place.
  void add(const QString& path);
  void remove(const QString& path);
  void clear();

  // Takes in what others have added, and looks, beside the window (a disk may not answer), which of them are there;
  // `changed` says when it is known.
  void look();
  bool missing(const QString& path) const { return missing_.contains(path); }

 signals:
  void changed();

 private:
  void keep();

  std::unique_ptr<QSettings> settings_;
  QString key_;
  QStringList files_;
  QSet<QString> missing_;
  std::unique_ptr<Job> looking_;
};

}  // namespace atomesh::gui
