#include "tools/libraries.h"

#include <OpenEXR/OpenEXRConfig.h>
#include <assimp/version.h>
#include <hwy/highway.h>
#include <oneapi/tbb/version.h>

#include <CLI/Version.hpp>
#include <glm/detail/setup.hpp>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "tools/text.h"

namespace lanewise {

std::vector<Library> libraries() {
  return {
      {"Highway", print("%d.%d.%d", HWY_MAJOR, HWY_MINOR, HWY_PATCH)},
      {"oneTBB", TBB_runtime_version()},
      {"OpenEXR", OPENEXR_VERSION_STRING},
      {"Assimp", print("%u.%u.%u", aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch())},
      {"pugixml", print("%d.%d", PUGIXML_VERSION / 1000, PUGIXML_VERSION / 10 % 100)},
      {"CLI11", CLI11_VERSION},
      {"nlohmann-json",
       print("%d.%d.%d", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"GLM", print("%d.%d.%d.%d", GLM_VERSION_MAJOR, GLM_VERSION_MINOR, GLM_VERSION_PATCH, GLM_VERSION_REVISION)},
      {"stb_image", LANEWISE_STB_IMAGE_VERSION},
      {"stb_image_write", LANEWISE_STB_IMAGE_WRITE_VERSION},
  };
}

}  // namespace lanewise
