// Files dropped onto the window.
#pragma once

#include <QObject>

class QMimeData;
class QWidget;

namespace atomesh::gui {

// Accepts drops of files for `window` and everything in it that does not take them itself.
class DropTarget : public QObject {
  Q_OBJECT

 public:
  explicit DropTarget(QWidget& window);

 signals:
  // One of them may be "": the sample (or a picture of one), and a .crf.
  void dropped(const QString& data, const QString& parameters);
  void refused(const QString& problem);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void take(const QMimeData& data);
};

}  // namespace atomesh::gui
