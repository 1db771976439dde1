#include "scenes/json_value.h"

#include <cmath>

#include "core/types.h"

namespace lanewise {

JsonValue JsonValue::operator[](const char* key) const {
  JsonValue member(*this, (where_.empty() ? "" : ".") + std::string(key));
  if (!present()) return member;
  if (!json_->is_object()) fail("is not an object");
  const auto found = json_->find(key);
  if (found != json_->end()) member.json_ = &*found;
  return member;
}

std::vector<JsonValue> JsonValue::elements() const {
  std::vector<JsonValue> list;
  if (!present()) return list;
  if (!json_->is_array()) fail("is not a list");
  for (size_t i = 0; i < json_->size(); ++i) list.push_back(at(i));
  return list;
}

JsonValue JsonValue::at(size_t index) const {
  JsonValue element(*this, '[' + std::to_string(index) + ']');
  element.json_ = &json_->at(index);
  return element;
}

double JsonValue::number(double otherwise) const {
  if (!present()) return otherwise;
  if (!json_->is_number() || !std::isfinite(json_->get<double>())) fail("is not a number");
  return json_->get<double>();
}

uint64_t JsonValue::count(uint64_t otherwise) const {
  if (!present()) return otherwise;
  if (!json_->is_number_unsigned()) fail("is not a whole number");
  return json_->get<uint64_t>();
}

size_t JsonValue::index(const JsonValue& list) const {
  if (!present()) fail("is missing");
  const size_t size = list.present() && list.json_->is_array() ? list.json_->size() : 0, found = count(0);
  if (found >= size) {
    fail("is " + std::to_string(found) + ", and there are " + std::to_string(size) + ' ' + list.where_);
  }
  return found;
}

glm::dvec3 JsonValue::color(const glm::dvec3& otherwise) const {
  if (!present()) return otherwise;
  const std::vector<JsonValue> values = elements();
  if (values.size() != 3 && values.size() != 4) fail("is not a colour of three or four numbers");
  return {values[0].number(0), values[1].number(0), values[2].number(0)};
}

std::string JsonValue::text(const std::string& otherwise) const {
  if (!present()) return otherwise;
  if (!json_->is_string()) fail("is not a text");
  return json_->get<std::string>();
}

void JsonValue::fail(const std::string& message) const {
  throw Error(*file_ + ": " + (where_.empty() ? "the JSON" : where_) + ' ' + message);
}

}  // namespace lanewise
