#include "app/cli/channel_files.h"

#include <fmt/format.h>

#include "app/cli/output_file.h"
#include "core/error.h"

namespace atomesh::cli {

ChannelFiles::ChannelFiles(const std::vector<std::string>& words, Mode mode) {
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    if (equals == std::string::npos || (name != "thickness" && name != "depth" && name != "id")) {
      throw UsageError("--channel: expected thickness=FILE.npy, depth=FILE.npy or id=FILE.npy, got \"" + word + "\"");
    }
    const bool mode_has_it = name == "thickness" ? mode == Mode::xray : mode == Mode::surface || mode == Mode::atoms;
    if (!mode_has_it) throw UsageError(fmt::format("--channel {}: mode {} has none", name, mode_name(mode)));
    std::string path = word.substr(equals + 1);
    check_output(path, {".npy"});
    (name == "thickness" ? thickness_path_ : name == "depth" ? depth_path_ : id_path_) = std::move(path);
  }
}

Channels ChannelFiles::channels() {
  Channels channels;
  if (!thickness_path_.empty()) channels.thickness = &thickness_;
  if (!depth_path_.empty()) channels.depth = &depth_;
  if (!id_path_.empty()) channels.id = &id_;
  return channels;
}

void ChannelFiles::begin(int width, int height) {
  using Type = NpyWriter::Type;
  if (!thickness_path_.empty()) thickness_file_.emplace(thickness_path_, Type::float32, width, height);
  if (!depth_path_.empty()) depth_file_.emplace(depth_path_, Type::float32, width, height);
  if (!id_path_.empty()) id_file_.emplace(id_path_, Type::uint32, width, height);
}

void ChannelFiles::write_rows() {
  if (thickness_file_) thickness_file_->write(thickness_);
  if (depth_file_) depth_file_->write(depth_);
  if (id_file_) id_file_->write(id_);
}

void ChannelFiles::finish() {
  if (thickness_file_) thickness_file_->finish();
  if (depth_file_) depth_file_->finish();
  if (id_file_) id_file_->finish();
}

}  // namespace atomesh::cli
