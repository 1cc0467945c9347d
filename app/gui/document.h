// What is open in the window: a file, and the parts of its material that are in memory.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/read_mesh.h"
#include "core/geometry.h"
#include "core/material.h"
#include "core/material_file.h"
#include "core/progress.h"
#include "preprocess/pipeline.h"

namespace atomesh::gui {

// material: .crb, .crt; mesh: .vtu, .vtk, PLOT3D, TetGen; atoms: everything else that is read; picture: a PNG that
// atomesh made, which stands for the material and the view it shows.
enum class FileKind { material, mesh, atoms, picture };
// By content where that tells, else by extension. Throws InputError when the file cannot be read.
FileKind file_kind(const std::string& path);

// A snapshot: never changed once made, so that every thread may look at it.
struct Document {
  std::string path;  // absolute
  FileKind kind = FileKind::material;
  std::shared_ptr<const Material> material;  // never null
  MaterialParts parts;                       // those that `material` holds, as far as the file has them
  std::optional<PipelineReport> pipeline;    // when atoms were preprocessed in this window
  std::optional<cli::MeshFileReport> mesh;   // when it is a mesh file
  std::vector<std::string> notes;            // what a person should know, one sentence each
  std::vector<StageTime> times;              // reading, or the stages of preprocessing
  std::vector<std::string> species() const;  // names, in the order of the table of species
  bool angstroms() const { return material->atoms.size() > 0; }  // a mesh file does not say its unit
};

// Whether everything of `wanted` is among `parts`.
bool covers(const MaterialParts& parts, const MaterialParts& wanted);
MaterialParts united(const MaterialParts& a, const MaterialParts& b);

// A material or mesh file; of a .crb only `parts` are read (of the others, all). Throws InputError; UsageError for an
// atoms file, which goes through preprocessing.
Document open_document(const std::string& path, const MaterialParts& parts, Progress& progress);
// The same document with at least these parts; the file is read again where any is missing. What is there stays the
// same object where nothing is. Throws InputError when the file is no longer what it was.
Document with_parts(const Document& document, const MaterialParts& wanted, Progress& progress);

}  // namespace atomesh::gui
