#include "tools/version_report.h"

#include <vector>

#include "core/isa.h"
#include "core/mpi_messenger.h"
#include "core/render.h"
#include "tools/libraries.h"
#include "tools/version.h"

namespace lanewise {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#elif defined(__GNUC__)
  return "GCC " __VERSION__;
#else
  return "an unknown compiler";
#endif
}

}  // namespace

std::string version_report() {
  std::vector<std::string> libraries_text;
  for (const Library& library : libraries()) libraries_text.push_back(library.name + " " + library.version);
  if (!mpi_library().empty()) libraries_text.push_back(mpi_library());
  return std::string("lanewise ") + kVersion + "\n" +                                        //
         "built by " + compiler() + ", " LANEWISE_BUILD_TYPE "\n" +                          //
         "instruction sets: " + joined(compiled_isas()) + "; here " + chosen_isa() + "\n" +  //
         "libraries: " + joined(libraries_text);
}

}  // namespace lanewise
