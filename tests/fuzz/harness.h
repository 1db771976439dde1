// One reader of files, as it is fuzzed: by libFuzzer, and by tests/hostile_files_test.cc on what libFuzzer has found.
//
// A new one is a file tests/fuzz/NAME.cc with one Harness in it, and a line in CMakeLists.txt; seeds, if the shipped scenes are
// none, go to tests/fuzz/seeds/NAME, and what it finds to tests/fuzz/regressions/NAME.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"

namespace lanewise::fuzz {

// Reads the bytes as the file that the program would be given, and uses what it gets. Lets errors that tell a user what is wrong
// pass; anything else that is thrown is a finding, as is all that a sanitizer, a limit of time or of memory stops.
struct Harness {
  // read gets the path of a file with these bytes, in a folder of its own that also has wood.png, a picture for textures.
  Harness(std::string name, std::string extension, std::function<void(const std::string& path)> read);

  // render: whether a scene is used, not only read; that takes ten times as long.
  void run(std::string_view bytes, bool render = true) const;

  std::string name;
  std::string extension;  // of the file, with its dot
  std::function<void(const std::string& path)> read;
};

// All that are linked in, in the order of their names.
std::vector<const Harness*> harnesses();

// Does with a scene that was loaded what the commands do: looks for what may be wrong with it, compiles a plan and renders a few
// pixels; the last two only if it has few primitives.
void use(const Scene& scene);

// The same with a file of radiance, around a mirror.
void use_sky(const std::string& path);

}  // namespace lanewise::fuzz
