// The parameter file (.crf) of the window: its name, loading as one step that can be undone, saving, and the last ones.
#pragma once

#include <QStringList>
#include <optional>
#include <string>

#include "app/gui/document.h"

namespace atomesh::gui {

class Workspace;

// The file that `typed` means: "default" or nothing is the data set's name with .crf in the place of its extension; a
// name without folder lies beside the data set; .crf is added to a name without extension. Throws UsageError for
// "default" without a data set.
std::string parameter_file_path(const QString& typed, const std::optional<Document>& document);

// All parameters become those of the file (what it leaves out, the defaults), as one step of the history. Throws
// InputError with file and line, and changes nothing then.
void load_parameter_file(Workspace& workspace, const std::string& path);
// Throws InputError or Error when it cannot be written; an existing file that is no parameter file is not replaced.
void save_parameter_file(Workspace& workspace, const std::string& path);

// Last used first, absolute, those that still exist; kept with the program's settings.
QStringList recent_parameter_files();

}  // namespace atomesh::gui
