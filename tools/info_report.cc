#include "tools/info_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "scenes/inspect.h"
#include "scenes/quoted.h"
#include "tools/text.h"
#include "tools/version.h"

namespace lanewise {
namespace {

using nlohmann::ordered_json;
using Kind = Material::Kind;
using Row = std::vector<std::string>;

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::kDiffuse:
      return "diffuse";
    case Kind::kMirror:
      return "mirror";
    case Kind::kGlass:
      return "glass";
    case Kind::kMicrofacet:
      return "microfacet";
    case Kind::kEmission:
      return "emission";
  }
  return "";
}

struct Value {
  const char* name;
  std::vector<double> numbers;  // one, or three of a colour
};

// Those that its kind uses.
std::vector<Value> values_of(const Material& m) {
  const auto list = [](const glm::dvec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
  switch (m.kind) {
    case Kind::kDiffuse:
    case Kind::kMirror:
      return {{"reflectance", list(m.reflectance)}};
    case Kind::kGlass:
      return {{"ior", {m.ior}},
              {"roughness", {m.roughness}},
              {"reflectance", list(m.reflectance)},
              {"transmittance", list(m.transmittance)}};
    case Kind::kMicrofacet:
      return {{"alpha", {m.alpha}}, {"eta", list(m.eta)}, {"k", list(m.k)}};
    case Kind::kEmission:
      return {{"radiance", list(m.radiance)}};
  }
  return {};
}

std::string number(double value) { return print("%.4g", value + 0.0); }

// One number where all three are the same.
std::string numbers(const glm::dvec3& v) {
  if (v.x == v.y && v.x == v.z) return number(v.x);
  return number(v.x) + " " + number(v.y) + " " + number(v.z);
}

std::string triple(const glm::dvec3& v) { return number(v.x) + " " + number(v.y) + " " + number(v.z); }

std::string values_text(const Scene& scene, const Material& m) {
  std::string text;
  for (const auto& [name, values] : values_of(m)) {
    const glm::dvec3 v = values.size() == 3 ? glm::dvec3(values[0], values[1], values[2]) : glm::dvec3(values[0]);
    text += (text.empty() ? "" : ", ") + std::string(name) + " " + numbers(v);
  }
  if (m.texture != kNoTexture) {
    const Texture& texture = scene.textures[m.texture];
    text += " times " + lanewise::quoted(texture.name) + ", " + std::to_string(texture.width) + " x " +
            std::to_string(texture.height);
  }
  return text;
}

std::string name_text(std::string name) {
  constexpr size_t kLongest = 28;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return name.size() > kLongest ? name.substr(0, kLongest - 3) + "..." : name;
}

// A heading and rows of as many cells; columns from first_number to last_number are aligned to the right.
std::string table(const std::vector<Row>& rows, size_t first_number, size_t last_number) {
  std::vector<size_t> widths(rows[0].size());
  for (const Row& row : rows) {
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text = "\n";
  for (const Row& row : rows) {
    std::string line;
    for (size_t c = 0; c < row.size(); ++c) {
      const std::string blanks(widths[c] - row[c].size(), ' ');
      line += (c > 0 ? "  " : "") + (c >= first_number && c <= last_number ? blanks + row[c] : row[c] + blanks);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string count_of(size_t n, const char* one) {
  return short_count(static_cast<double>(n)) + " " + one + (n == 1 ? "" : "s");
}
std::string meshes_of(size_t n) { return std::to_string(n) + (n == 1 ? " mesh" : " meshes"); }

const char* up_name(const Scene& scene) { return scene.up.y > 0.5 ? "y" : "z"; }

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

}  // namespace

std::string info_text(const Scene& scene) {
  const Bounds box = bounds(scene);
  const glm::dvec3 size = box.hi - box.lo;
  const std::vector<LightFacts> lights = light_facts(scene);
  std::string text = scene.path + ": " + count_of(scene.triangle_count(), "triangle") + " in " +
                     meshes_of(scene.meshes.size()) + ", " + count_of(scene.spheres.size(), "sphere") + ", " +
                     count_of(lights.size(), "light") + ", " + count_of(scene.cameras.size(), "camera") + "\n";
  text += number(size.x) + " x " + number(size.y) + " x " + number(size.z) + ", from " + triple(box.lo) + " to " +
          triple(box.hi) + "; " + up_name(scene) + " is up\n";

  const std::vector<MaterialUse> uses = material_uses(scene);
  std::vector<Row> rows = {{"material", "kind", "triangles", "spheres", "values"}};
  for (size_t i = 0; i < uses.size(); ++i) {
    const Material& m = scene.materials[i];
    rows.push_back({name_text(m.name), kind_name(m.kind), std::to_string(uses[i].triangles),
                    std::to_string(uses[i].spheres), values_text(scene, m)});
  }
  text += table(rows, 2, 3);
  if (!lights.empty()) {
    rows = {{"light", "area", "radiance", "power"}};
    for (const LightFacts& light : lights) {
      rows.push_back({name_text(light.name), number(light.area), numbers(light.radiance), numbers(light.power)});
    }
    text += table(rows, 1, 3);
  }
  rows = {{"camera", "degrees wide", "aspect", "eye", "looks along"}};
  for (const Camera& camera : scene.cameras) {
    rows.push_back({name_text(camera.name), number(degrees(camera.xfov)), number(camera.aspect),
                    triple(glm::dvec3(camera.to_world[3])), triple(-glm::dvec3(camera.to_world[2]))});
  }
  text += table(rows, 1, 2);

  const std::vector<std::string> warnings = scene_warnings(scene);
  if (!scene.notices.empty() || !warnings.empty()) text += "\n";
  for (const std::string& notice : scene.notices) text += "note: " + notice + "\n";
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  return text;
}

std::string info_json(const Scene& scene) {
  const auto list = [](const glm::dvec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
  const Bounds box = bounds(scene);
  ordered_json json = {{"scene", scene.path},
                       {"version", kVersion},
                       {"meshes", scene.meshes.size()},
                       {"triangles", scene.triangle_count()},
                       {"spheres", scene.spheres.size()},
                       {"bounds", {{"lo", list(box.lo)}, {"hi", list(box.hi)}}},
                       {"size", list(box.hi - box.lo)},
                       {"up", up_name(scene)}};
  json["materials"] = ordered_json::array();
  const std::vector<MaterialUse> uses = material_uses(scene);
  for (size_t i = 0; i < uses.size(); ++i) {
    const Material& m = scene.materials[i];
    ordered_json material = {
        {"name", m.name}, {"kind", kind_name(m.kind)}, {"triangles", uses[i].triangles}, {"spheres", uses[i].spheres}};
    for (const auto& [name, values] : values_of(m)) {
      if (values.size() == 1) material[name] = values[0];
      if (values.size() == 3) material[name] = values;
    }
    if (m.texture != kNoTexture) {
      const Texture& texture = scene.textures[m.texture];
      material["texture"] = {{"name", texture.name}, {"width", texture.width}, {"height", texture.height}};
    }
    json["materials"].push_back(material);
  }
  json["lights"] = ordered_json::array();
  for (const LightFacts& light : light_facts(scene)) {
    json["lights"].push_back(
        {{"name", light.name}, {"area", light.area}, {"radiance", list(light.radiance)}, {"power", list(light.power)}});
  }
  json["cameras"] = ordered_json::array();
  for (const Camera& camera : scene.cameras) {
    json["cameras"].push_back({{"name", camera.name},
                               {"xfov", degrees(camera.xfov)},
                               {"aspect", camera.aspect},
                               {"eye", list(glm::dvec3(camera.to_world[3]))},
                               {"view", list(-glm::dvec3(camera.to_world[2]))}});
  }
  json["notices"] = scene.notices;
  json["warnings"] = scene_warnings(scene);
  // Names may hold any bytes; what is not UTF-8 is replaced.
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lanewise
