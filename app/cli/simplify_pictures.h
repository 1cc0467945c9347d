// The pictures of a simplification's certificate: what it changes that an eye could see.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/material.h"
#include "core/progress.h"

namespace atomesh::cli {

// Draws the modes that show tetrahedra, with default parameters, from six views and keeps the pictures.
class SimplifyPictures {
 public:
  static constexpr int size = 256;  // pixels of an edge

  // Of the whole mesh.
  void draw(const Material& material, Progress& progress);
  bool drawn() const { return !pictures_.empty(); }
  std::size_t count() const { return pictures_.size(); }

  struct Difference {
    double max = 0.0;   // largest difference of any channel, channels in [0, 1]
    std::string where;  // mode and view of the picture that has it
  };
  // Of the simplified mesh, held against draw()'s.
  Difference compare(const Material& material, Progress& progress) const;

 private:
  std::vector<Image> pictures_;
};

}  // namespace atomesh::cli
