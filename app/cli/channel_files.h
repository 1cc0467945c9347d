// --channel NAME=FILE.npy: per-pixel numbers beside the picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/write_npy.h"
#include "core/parameters.h"
#include "render/renderer.h"

namespace atomesh::cli {

// Where each wanted channel goes, and the room for it while the picture is drawn.
class ChannelFiles {
 public:
  // Throws UsageError for an unknown channel, one that the mode does not have, or a file that is no .npy.
  ChannelFiles(const std::vector<std::string>& words, Mode mode);

  // Points into this object.
  Channels channels();

  // The files of a picture of that size; then, as often as there are rows, what channels() hold of them, from the top;
  // then the files get their names. Without finish() nothing is left.
  void begin(int width, int height);
  void write_rows();
  void finish();

 private:
  std::optional<NpyWriter> thickness_file_;
  std::optional<NpyWriter> depth_file_;
  std::optional<NpyWriter> id_file_;
  std::string thickness_path_;
  std::string depth_path_;
  std::string id_path_;
  std::vector<float> thickness_;
  std::vector<float> depth_;
  std::vector<Index> id_;
};

}  // namespace atomesh::cli
