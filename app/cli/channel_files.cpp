#include "app/cli/channel_files.h"

#include <fmt/format.h>

#include "app/cli/output_file.h"
#include "app/cli/write_npy.h"
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

void ChannelFiles::write(int width, int height) const {
  if (!thickness_path_.empty()) write_npy(thickness_path_, thickness_, width, height);
  if (!depth_path_.empty()) write_npy(depth_path_, depth_, width, height);
  if (!id_path_.empty()) write_npy(id_path_, id_, width, height);
}

}  // namespace atomesh::cli
