// --channel NAME=FILE.npy: per-pixel numbers beside the picture.
#pragma once

#include <string>
#include <vector>

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
  void write(int width, int height) const;

 private:
  std::string thickness_path_;
  std::string depth_path_;
  std::string id_path_;
  std::vector<float> thickness_;
  std::vector<float> depth_;
  std::vector<Index> id_;
};

}  // namespace atomesh::cli
