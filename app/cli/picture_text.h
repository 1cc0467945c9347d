// What the PNG of a picture says about how it was made: which data it shows, by which parameters. Written into every
// picture, and read back to show the same view again.
#pragma once

#include <optional>
#include <string>

#include "core/image.h"
#include "core/material.h"
#include "core/parameters.h"
#include "core/progress.h"

namespace atomesh::cli {

// What lies over the sample in the picture.
struct PictureParts {
  bool legend = false;
  bool scale_bar = false;
  bool tripod = false;
  bool operator==(const PictureParts&) const = default;
};

// Everything a PNG says.
struct PictureOrigin {
  std::string program;   // "atomesh 0.1.0"
  std::string renderer;  // "cpu"
  Parameters parameters;
  PictureParts parts;
  std::string data;        // the file it shows: as seen from the PNG's folder where that is near, else absolute
  std::string data_hash;   // of that file, see hash_of_data(); "" when the picture's program did not say
  std::string provenance;  // provenance_lines() of what it shows
};

// Tells data files apart whatever they are called and wherever they lie: content_hash_of_file(), but of a .crb only of
// its header and table, which hold the checksums of all the rest. Throws InputError when it cannot be read.
std::string hash_of_data(const std::string& path, Progress& progress = no_progress());

// "input=NAME", then a line "KEY=VALUE" for each option: where a material comes from. The same for the same atoms
// preprocessed again with the same options (input_hash is one of them).
std::string provenance_lines(const Provenance& provenance);

// The texts for the picture `png` of `data` (paths, absolute or from the working directory).
PngText picture_text(const std::string& png, const std::string& data, const std::string& data_hash,
                     const Material& material, const Parameters& parameters, std::string_view renderer,
                     const PictureParts& parts);

// Reads them back. Throws InputError for what is no PNG, a PNG that atomesh did not make, and one whose parameters this
// version does not know.
PictureOrigin read_picture_origin(const std::string& png);

// The parameters of --params: of a .crf, or of a picture that atomesh made.
Parameters read_parameters(const std::string& path);

}  // namespace atomesh::cli
