// A Material as .crb (crb_format.h). Use core/material_file.h, which knows both formats.
// `bytes` is the whole file, `path` its name in messages.
#pragma once

#include "core/material_file.h"

namespace atomesh {

Material read_crb(std::string_view bytes, const std::string& path, const MaterialParts& parts, Progress& progress);
// The material must have no problem (find_problem).
void write_crb(const std::string& path, const Material& material, bool compress, Progress& progress);
std::vector<SectionInfo> list_crb_sections(std::string_view bytes, const std::string& path);

}  // namespace atomesh
