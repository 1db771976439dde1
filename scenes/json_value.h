// A value of a JSON file that remembers where it stands, so that what is wrong with it can be said.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lanewise {

// Values that are not there are absent, and so is what is asked of them; the readers then give `otherwise`. All throw
// Error "FILE: materials[3].alphaMode MESSAGE" for values of another kind. The file's name and the JSON must outlive
// it.
class JsonValue {
 public:
  JsonValue(const std::string& file, const nlohmann::json& root) : file_(&file), json_(&root) {}

  bool present() const { return json_ != nullptr; }
  JsonValue operator[](const char* key) const;
  std::vector<JsonValue> elements() const;
  JsonValue at(size_t index) const;  // of a list that has such an element

  double number(double otherwise) const;                // finite
  uint64_t count(uint64_t otherwise) const;             // a whole number, not negative
  size_t index(const JsonValue& list) const;            // of an element of the list; must be there
  glm::dvec3 color(const glm::dvec3& otherwise) const;  // of three numbers; a fourth, alpha, may follow and is left out
  std::string text(const std::string& otherwise) const;

  const nlohmann::json& json() const { return *json_; }
  [[noreturn]] void fail(const std::string& message) const;

 private:
  JsonValue(const JsonValue& parent, const std::string& step) : file_(parent.file_), where_(parent.where_ + step) {}

  const std::string* file_;
  std::string where_;
  const nlohmann::json* json_ = nullptr;
};

}  // namespace lanewise
