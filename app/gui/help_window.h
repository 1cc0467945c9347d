// The window of the help: contents, search and pages.
#pragma once

#include <QWidget>

class QLabel;
class QLineEdit;
class QListWidget;
class QStackedWidget;
class QTreeWidget;

namespace atomesh::gui {

class HelpBrowser;

// A window of its own beside the main window; `parent` keeps it above itself.
class HelpWindow : public QWidget {
  Q_OBJECT

 public:
  explicit HelpWindow(QWidget* parent = nullptr);

  // Shows the window at a topic as help_place() knows it; at the first page where there is none.
  void show_topic(const QString& topic = {});
  // Of the page that is shown.
  QString page() const;
  void search(const QString& query);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void fill_contents();
  void fill_hits(const QString& query);
  void follow_page(const QUrl& address);

  QLineEdit* search_;
  QStackedWidget* contents_or_hits_;
  QTreeWidget* contents_;
  QListWidget* hits_;
  QLabel* nothing_;
  HelpBrowser* browser_;
};

}  // namespace atomesh::gui
