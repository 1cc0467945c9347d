// What VTK's readers believe without looking: checked before they are let near a file.
#pragma once

#include <string>

namespace atomesh::cli {

// Throws InputError when a .vtk or .vtu ("format") is of another kind than its name says, announces more points, cells
// or values than its bytes can hold, or (.vtk before version 5) lists cells that run over the end of their list.
void check_vtk_file(const std::string& path, const std::string& format);

}  // namespace atomesh::cli
