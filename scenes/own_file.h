// Which files a scene may have read.
#pragma once

#include <string>

namespace lanewise {

// Whether the file, links followed, is a regular one in the folder of the scene's file, or below.
bool is_own_file(const std::string& scene, const std::string& file);

// The path of the file that a scene calls by that name, relative to its folder, or of the file of the same base name there
// (exporters leave paths of the machine that they ran on): own files only. Percent-escapes and a file: in front are
// understood. "" if there is none.
std::string find_own_file(const std::string& scene, const std::string& name);

}  // namespace lanewise
