// VTK's readers as ours are: what they would print goes into exceptions and notes, not to the terminal.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"

class vtkAlgorithm;

namespace atomesh::cli {

// Runs a reader of `path`: cancellable, its complaints an InputError, its warnings added to `notes`.
void run_vtk_reader(vtkAlgorithm& reader, const std::string& path, Progress& progress, std::vector<std::string>& notes);

}  // namespace atomesh::cli
