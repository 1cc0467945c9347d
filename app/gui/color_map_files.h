// Colour maps as files: ParaView's JSON, and pictures of a strip of colours.
#pragma once

#include <string>

#include "core/color_map.h"

namespace atomesh::gui {

struct ColorMapFile {
  ColorMap map;
  bool opacities = false;  // whether the file says any; else they are 1
  std::string note;        // what a person should know, a sentence; "" nothing
};

// By content. Throws InputError for a file that cannot be read or is neither.
//   JSON: the first map of the list that has RGBPoints; Points are its opacities. Scalars are brought to [0,1].
//   PNG:  the middle row from left to right, or, of a picture higher than wide, the middle column from below.
// Maps of more than 32 entries are thinned out (fewer_entries()).
ColorMapFile read_color_map_file(const std::string& path);

// As a list of one map for ParaView, named `name`, with its opacities. Throws Error with the system's reason.
void write_color_map_file(const std::string& path, const ColorMap& map, const std::string& name);

}  // namespace atomesh::gui
