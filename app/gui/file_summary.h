// What a file is, told from its first bytes, and what to do with several at once. Without widgets.
#pragma once

#include <QString>
#include <QStringList>
#include <cstdint>
#include <string>

#include "app/gui/document.h"

namespace atomesh::gui {

struct FileSummary {
  std::string path;
  FileKind kind = FileKind::atoms;
  QString text;     // "Atoms file, dat, 1.2 MB"; "Material (.crb): 25,725 atoms, 138,720 tetrahedra; 4.1 MB"
  QString problem;  // why it cannot be opened and what to do; "" when it can, as far as one sees
};
// Reads the head of the file only, whatever its size. Never throws.
FileSummary summarize_file(const std::string& path);

// Files that are given at once, by a drop or on the command line: one to open, one with parameters for it.
struct FileChoice {
  QString data;        // "" when none
  QString parameters;  // a .crf; "" when none
  QString problem;     // which to leave out, when there are too many; the others are "" then
};
FileChoice choose_files(const QStringList& paths);

}  // namespace atomesh::gui
