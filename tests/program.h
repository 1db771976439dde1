// The program that tests of commands run: LANEWISE_BINARY names it, LANEWISE_SOURCE_DIR the checkout.
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace lanewise::test {

inline std::string environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return std::filesystem::absolute(value ? value : otherwise).string();
}

inline std::string program() { return environment("LANEWISE_BINARY", "./lanewise"); }

// A small scene of the checkout.
inline std::string box() { return environment("LANEWISE_SOURCE_DIR", ".") + "/scenes/cornell_spheres.dae"; }

inline bool nothing_to_test() {
  if (std::filesystem::exists(program())) return false;
  MESSAGE("skipped: no program at " << program());
  return true;
}

}  // namespace lanewise::test
