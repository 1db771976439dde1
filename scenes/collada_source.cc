#include "scenes/collada_source.h"

#include <algorithm>
#include <string>

namespace lanewise::collada {
namespace {

// Parameters without a name are padding; without any parameter a vector is its first values.
std::array<size_t, 3> components(const Document& document, pugi::xml_node accessor, size_t wanted) {
  std::array<size_t, 3> component{0, 1, 2};
  size_t params = 0;
  size_t named = 0;
  for (const pugi::xml_node param : accessor.children("param")) {
    if (param.attribute("name") && named < wanted) component[named++] = params;
    ++params;
  }
  if (named == 0 && params >= wanted) {
    component = {0, 1, 2};
  } else if (params > 0 && named < wanted) {
    document.fail(accessor, std::to_string(wanted) + " components expected, not " + std::to_string(named));
  }
  if (wanted == 2) component[2] = component[1];
  return component;
}

}  // namespace

const std::vector<double>& ArrayCache::array(pugi::xml_node float_array) {
  const auto [place, is_new] = arrays_.try_emplace(float_array.hash_value());
  std::vector<double>& values = place->second;
  if (!is_new) return values;
  values = document_.numbers(float_array);
  const auto count = document_.count(float_array, "count");
  if (count && *count != values.size()) {
    document_.fail(float_array, "claims " + std::to_string(*count) + " numbers, has " + std::to_string(values.size()));
  }
  return values;
}

Source ArrayCache::read(pugi::xml_node source, size_t wanted) {
  const pugi::xml_node accessor = source.child("technique_common").child("accessor");
  if (!accessor) document_.fail(source, "has no <accessor>");
  const std::vector<double>& values = array(document_.refer(accessor, "source", "float_array"));
  Source view;
  view.component = components(document_, accessor, wanted);
  const size_t last_component = *std::ranges::max_element(view.component);
  view.stride = document_.count(accessor, "stride").value_or(1);
  const auto count = document_.count(accessor, "count");
  if (!count) document_.fail(accessor, "has no attribute count");
  view.count = *count;
  const size_t offset = document_.count(accessor, "offset").value_or(0);
  if (view.count == 0) return view;
  if (view.stride <= last_component)
    document_.fail(accessor, "stride is too short for " + std::to_string(wanted) + " components");

  // Divisions, so that no claimed number can overflow.
  const size_t size = values.size();
  const bool fits = offset < size && last_component < size - offset &&
                    view.count - 1 <= (size - offset - last_component - 1) / view.stride;
  if (!fits) {
    document_.fail(accessor, "count, stride and offset reach beyond the array's " + std::to_string(size) + " numbers");
  }
  view.values = values.data() + offset;
  return view;
}

}  // namespace lanewise::collada
