// Two pictures held against each other: what `compare` does and `render --reference` ends with.
#pragma once

#include <string>

#include "app/cli/json.h"
#include "app/cli/session.h"
#include "core/image.h"

namespace atomesh::cli {

struct PictureComparison {
  bool passed = false;
  Json json;  // {max, rmse, psnr, pixels_over}, all null for pictures of different sizes
};

// Reads both files, prints the figures, and writes the difference picture when `difference_path` is not empty and they
// differ by more than `tolerance` (or at all, with `always`). Pictures of different sizes fail.
PictureComparison compare_pictures(const std::string& picture, const std::string& reference, double tolerance,
                                   const std::string& difference_path, bool always, Session& session);

}  // namespace atomesh::cli
