// Where the scenes are that tests load.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace lanewise::test {

inline std::filesystem::path source_dir() {
  const char* folder = std::getenv("LANEWISE_SOURCE_DIR");
  return folder != nullptr ? folder : ".";
}

inline std::filesystem::path shipped_scene(const char* name) { return source_dir() / "scenes" / name; }

// The course's scenes, which do not come with the project; the folder need not exist.
inline std::filesystem::path course_scenes() {
  const char* folder = std::getenv("LANEWISE_COURSE_SCENES");
  return folder != nullptr ? std::filesystem::path(folder) : source_dir() / "../shared/scenes";
}

}  // namespace lanewise::test
