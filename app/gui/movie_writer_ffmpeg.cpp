// Whatever ffmpeg can write: raw frames into its standard input.
#include <fmt/format.h>

#include <QProcess>
#include <QStandardPaths>
#include <QStringList>
#include <algorithm>
#include <array>

#include "app/gui/movie_writer.h"
#include "core/error.h"
#include "core/file_extension.h"
#include "core/text_file.h"

namespace atomesh::gui {

namespace {

struct Codec {
  QStringList options;
  const char* container;
};

// H.264 and VP9 by constant quality, MPEG-4 where a container is old. Pixels as every player knows them.
Codec codec_for(const std::string& path, int quality) {
  const std::string end = lower_extension(path);
  const auto level = [quality](const std::array<const char*, 3>& levels) {
    return QString(levels[static_cast<std::size_t>(std::clamp(quality, 0, 2))]);
  };
  const QStringList pixels{"-pix_fmt", "yuv420p"};
  if (end == ".webm") {
    return {QStringList{"-c:v", "libvpx-vp9", "-crf", level({"40", "31", "22"}), "-b:v", "0"} + pixels, "webm"};
  }
  if (end == ".avi") return {QStringList{"-c:v", "mpeg4", "-q:v", level({"8", "4", "2"})} + pixels, "avi"};
  QStringList options = QStringList{"-c:v", "libx264", "-crf", level({"28", "22", "16"})} + pixels;
  if (end == ".mkv") return {options, "matroska"};
  options += {"-movflags", "+faststart"};
  return {options, end == ".mov" ? "mov" : "mp4"};
}

class FfmpegWriter : public MovieWriter {
 public:
  FfmpegWriter(const std::string& path, const MovieSettings& settings) : path_(path), file_(path) {
    const Codec codec = codec_for(path, settings.quality);
    const QString size = QString("%1x%2").arg(settings.width).arg(settings.height);
    QStringList words{"-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size};
    words << "-r" << QString::number(settings.frames_per_second) << "-i"
          << "-";
    words << codec.options << "-f" << codec.container << QString::fromStdString(file_.place());
    process_.start(QString::fromStdString(ffmpeg_program()), words);
    if (!process_.waitForStarted()) throw UnavailableError("ffmpeg: " + process_.errorString().toStdString());
  }
  ~FfmpegWriter() override {
    if (process_.state() == QProcess::NotRunning) return;
    process_.kill();
    process_.waitForFinished();
  }
  FfmpegWriter(const FfmpegWriter&) = delete;
  FfmpegWriter& operator=(const FfmpegWriter&) = delete;

  void write(const Image& frame, const PngText&, Progress& progress) override {
    const std::vector<unsigned char> bytes = rgb_bytes(frame, false);
    process_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<qint64>(bytes.size()));
    while (process_.bytesToWrite() > 0) {
      progress.check();
      process_.waitForBytesWritten(50);
      if (process_.state() == QProcess::NotRunning) fail();
    }
  }
  void finish(Progress& progress) override {
    process_.closeWriteChannel();
    while (!process_.waitForFinished(50)) {
      progress.check();
      if (process_.state() == QProcess::NotRunning) break;
    }
    if (process_.exitStatus() != QProcess::NormalExit || process_.exitCode() != 0) fail();
    file_.commit();
  }

 private:
  [[noreturn]] void fail() {
    const std::string said = process_.readAllStandardError().trimmed().toStdString();
    throw Error(fmt::format("{}: the movie cannot be written: ffmpeg says: {}", path_,
                            said.empty() ? fmt::format("exit code {}", process_.exitCode()) : said));
  }

  std::string path_;
  AtomicFile file_;
  QProcess process_;
};

}  // namespace

std::string ffmpeg_program() {
  return QStandardPaths::findExecutable("ffmpeg").toStdString();
}

std::unique_ptr<MovieWriter> make_ffmpeg_writer(const std::string& path, const MovieSettings& settings) {
  return std::make_unique<FfmpegWriter>(path, settings);
}

}  // namespace atomesh::gui
