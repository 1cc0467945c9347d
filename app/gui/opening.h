// From the name of a file to what is shown: the loader, preprocessing, and reading beside the window.
#pragma once

#include <QObject>
#include <QString>
#include <memory>
#include <optional>

#include "app/gui/picture_state.h"
#include "app/gui/preprocessing.h"
#include "app/gui/workspace.h"

class QStackedWidget;
class QWidget;

namespace atomesh::gui {

class LoaderPage;
class PreprocessingPage;

// Adds the loader and the preprocessing page to the window's pages and brings the one to the front that is needed. What
// is open stays until the next is there; what goes wrong is said by Workspace::complain(), or in the loader where that
// is what is shown.
class Opening : public QObject {
  Q_OBJECT

 public:
  // `view` is the page that shows the workspace's document. `settings_file` as for the pages.
  Opening(Workspace& workspace, QStackedWidget& pages, QWidget& view, const QString& settings_file = {});
  ~Opening() override;

  // A file of any kind: materials and meshes are read, atoms preprocessed, a picture that atomesh made brings back its
  // view with its data, legend, scale bar and tripod on or off as in it. With the parameters of a .crf; else ("") a
  // picture's own, or those there are.
  void open(const QString& path, const QString& parameters_file = {});
  // Those of a .crf, or of a picture, over the defaults: one step of the history.
  void load_parameters(const QString& path);
  // What DropTarget and the command line give: either may be "".
  void take(const QString& data, const QString& parameters_file);
  void show_loader();

  LoaderPage& loader() { return *loader_; }
  PreprocessingPage& preprocessing() { return *preprocessing_; }
  bool reading() const { return job_ != nullptr; }
  // What the title of the window says of it: "Preprocessing nacl.dat", or "".
  QString activity() const;

 signals:
  void job_started(atomesh::gui::Job* job);  // for the progress bar
  void opened();                             // the workspace has the document, and the view is in front
  void activity_changed();
  void exit_wanted();  // [Exit] of the loader

 private:
  struct Wanted;
  struct Found;
  // What comes with the data: of a .crf the parameters, of a picture also what lay over it.
  struct Look {
    std::optional<Parameters> parameters;
    std::optional<cli::PictureParts> parts;
  };

  void find(const Wanted& wanted);
  void take_found(const Wanted& wanted, Found& found);
  void take_picture(const Wanted& wanted, Found& found);
  void preprocess(const PreprocessingRequest& request, const Look& look);
  void show(Document document, const Look& look);
  void fail(const QString& path, const QString& problem);

  Workspace& workspace_;
  QStackedWidget& pages_;
  QWidget& view_;
  LoaderPage* loader_;
  PreprocessingPage* preprocessing_;
  std::unique_ptr<Job> job_;
  Look look_;  // that goes on with what is being preprocessed
};

}  // namespace atomesh::gui
