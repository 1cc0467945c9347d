// Ogg Theora through VTK.
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkOggTheoraWriter.h>

#include <cstring>

#include "app/gui/movie_writer.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::gui {

namespace {

// What VTK complains of, instead of its output window.
class Complaints : public vtkCommand {
 public:
  static Complaints* New() { return new Complaints; }
  void Execute(vtkObject*, unsigned long, void* text) override {
    if (text != nullptr) heard = static_cast<const char*>(text);
  }
  std::string heard;
};

class TheoraWriter : public MovieWriter {
 public:
  TheoraWriter(const std::string& path, const MovieSettings& settings) : path_(path), file_(path) {
    image_->SetDimensions(settings.width, settings.height, 1);
    image_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    writer_->AddObserver(vtkCommand::ErrorEvent, complaints_);
    writer_->SetInputData(image_);
    writer_->SetFileName(file_.place().c_str());
    writer_->SetRate(settings.frames_per_second);
    writer_->SetQuality(settings.quality);
    writer_->SubsamplingOn();  // what every player knows
    writer_->Start();
    started_ = true;
    check();
  }
  ~TheoraWriter() override {
    if (started_) writer_->End();
  }
  TheoraWriter(const TheoraWriter&) = delete;
  TheoraWriter& operator=(const TheoraWriter&) = delete;

  void write(const Image& frame, const PngText&, Progress& progress) override {
    progress.check();
    const std::vector<unsigned char> bytes = rgb_bytes(frame, true);
    std::memcpy(image_->GetScalarPointer(), bytes.data(), bytes.size());
    image_->Modified();
    writer_->Write();
    check();
  }
  void finish(Progress& progress) override {
    progress.check();
    started_ = false;
    writer_->End();
    check();
    file_.commit();
  }

 private:
  void check() const {
    if (!complaints_->heard.empty()) throw Error(path_ + ": the movie cannot be written: " + complaints_->heard);
    if (writer_->GetError() != 0) throw Error(path_ + ": the movie cannot be written");
  }

  std::string path_;
  AtomicFile file_;
  vtkNew<vtkImageData> image_;
  vtkNew<Complaints> complaints_;
  vtkNew<vtkOggTheoraWriter> writer_;
  bool started_ = false;
};

}  // namespace

std::unique_ptr<MovieWriter> make_theora_writer(const std::string& path, const MovieSettings& settings) {
  return std::make_unique<TheoraWriter>(path, settings);
}

}  // namespace atomesh::gui
