// Opening a picture: from a PNG that atomesh made to the view it shows, and to the data on this machine.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/cli/picture_text.h"
#include "app/gui/document.h"
#include "core/progress.h"

namespace atomesh::gui {

// A file that was found for a picture.
struct PictureData {
  // same:   the file the picture was made of, byte for byte
  // remade: a material of the same atoms by the same options, preprocessed another time
  // atoms:  the atoms file the picture's material was made from; it must be preprocessed, with picture_options()
  // other:  a file of that name with another content
  enum class Match { same, remade, atoms, other };
  std::string path;  // absolute
  Match match = Match::same;
};

struct PictureState {
  cli::PictureOrigin origin;
  // The best there is, in the order of Match; nothing where no file of that name is found.
  std::optional<PictureData> data;
  std::vector<std::string> searched;  // absolute paths, in the order they were looked at
};

// Looks where the PNG says, beside the PNG, and in both folders for the atoms file and a material of its name. Throws
// InputError for a PNG without parameters (see read_picture_origin()), CancelledError.
PictureState read_picture_state(const std::string& png, Progress& progress = no_progress());

// What to say where `data` is nothing or Match::other: which file is wanted, where it was looked for.
std::string missing_data_text(const PictureState& state, const std::string& png);

// Whether this document is what the picture shows (Match::same or remade), so that nothing needs to be opened.
bool shows(const PictureState& state, const Document& document, Progress& progress = no_progress());

// How the atoms of the picture were preprocessed, "carve" → "2.6"; empty for meshes.
std::vector<std::pair<std::string, std::string>> picture_options(const PictureState& state);

}  // namespace atomesh::gui
