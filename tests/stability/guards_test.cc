// The guards that remove_guards.py takes out are still where its lists say.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

size_t occurrences(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_SUITE("stability") {
  TEST_CASE("guards: the text of each occurs once in its file") {
    const char* root = std::getenv("LANEWISE_SOURCE_DIR");
    const std::filesystem::path source(root ? root : ".");
    if (!std::filesystem::exists(source / "tests/stability/guards")) {
      MESSAGE("skipped: LANEWISE_SOURCE_DIR does not name the checkout");
      return;
    }
    size_t guards = 0;
    for (const auto& list : std::filesystem::directory_iterator(source / "tests/stability/guards")) {
      for (const nlohmann::json& guard : nlohmann::json::parse(test::read_text(list.path().string()))) {
        const std::string file = guard["file"], text = guard["replace"];
        CAPTURE(list.path().string());
        CAPTURE(file);
        CAPTURE(text);
        CHECK(occurrences(test::read_text((source / file).string()), text) == 1);
        CHECK(guard["with"] != text);
        CHECK(!guard["why"].get<std::string>().empty());
        CHECK(!guard["test"].get<std::string>().empty());
        ++guards;
      }
    }
    CHECK(guards > 0);
  }
}

}  // namespace lanewise
