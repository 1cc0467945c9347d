#include "app/gui/drop_target.h"

#include <QDragEnterEvent>
#include <QDropEvent>
#include <QMimeData>
#include <QUrl>
#include <QWidget>

#include "app/gui/file_summary.h"

namespace atomesh::gui {

DropTarget::DropTarget(QWidget& window) : QObject(&window) {
  window.setAcceptDrops(true);
  window.installEventFilter(this);
}

bool DropTarget::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::DragEnter:
    case QEvent::DragMove: {
      auto* drag = static_cast<QDragMoveEvent*>(event);
      if (!drag->mimeData()->hasUrls()) break;
      // The file stays where it is, whatever the keys that are held.
      drag->setDropAction(Qt::CopyAction);
      drag->accept();
      return true;
    }
    case QEvent::Drop: {
      auto* drop = static_cast<QDropEvent*>(event);
      if (!drop->mimeData()->hasUrls()) break;
      drop->setDropAction(Qt::CopyAction);
      drop->accept();
      take(*drop->mimeData());
      return true;
    }
    default:
      break;
  }
  return QObject::eventFilter(watched, event);
}

void DropTarget::take(const QMimeData& data) {
  QStringList paths;
  for (const QUrl& url : data.urls()) {
    if (!url.isLocalFile()) {
      emit refused(tr("%1 is not on this machine; save it first and drop the file").arg(url.toDisplayString()));
      return;
    }
    paths << url.toLocalFile();
  }
  const FileChoice choice = choose_files(paths);
  if (!choice.problem.isEmpty()) {
    emit refused(choice.problem);
  } else if (!choice.data.isEmpty() || !choice.parameters.isEmpty()) {
    emit dropped(choice.data, choice.parameters);
  }
}

}  // namespace atomesh::gui
