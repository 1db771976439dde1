#include <algorithm>
#include <cmath>
#include <numbers>
#include <pugixml.hpp>
#include <sstream>

#include "core/image_io.h"
#include "scenes/export.h"

namespace lanewise {
namespace {

using Kind = Material::Kind;

constexpr uint32_t kRouletteDepth = 5;     // as here
constexpr uint32_t kNoRoulette = 1 << 20;  // for paths that do not get as long
constexpr double kDegrees = 180 / std::numbers::pi;

class Writer {
 public:
  Writer(const Scene& scene, const Settings& settings, const std::string& folder)
      : scene_(scene), settings_(settings), folder_(folder) {}

  ExportedScene write() {
    root_ = document_.append_child("scene");
    root_.append_attribute("version") = "3.0.0";
    fallback("samples", std::to_string(settings_.spp));
    fallback("depth", std::to_string(settings_.max_depth + 1));
    fallback("sampler", "multijitter");
    add_integrator();
    add_sensor();
    for (size_t i = 0; i < scene_.materials.size(); ++i) add_material(i);
    for (size_t i = 0; i < scene_.meshes.size(); ++i) add_mesh(i);
    for (const Sphere& sphere : scene_.spheres) add_sphere(sphere);
    if (scene_.environment.width > 0) add_environment();
    std::ostringstream text;
    document_.save(text, "  ");
    result_.text = text.str();
    return std::move(result_);
  }

 private:
  static pugi::xml_node plugin(pugi::xml_node parent, const char* tag, const char* type) {
    pugi::xml_node node = parent.append_child(tag);
    node.append_attribute("type") = type;
    return node;
  }

  static void set(pugi::xml_node node, const char* tag, const char* name, const std::string& value) {
    pugi::xml_node child = node.append_child(tag);
    child.append_attribute("name") = name;
    child.append_attribute("value") = value.c_str();
  }

  static void rgb(pugi::xml_node node, const char* name, const glm::dvec3& value) {
    set(node, "rgb", name, exact(value));
  }

  void fallback(const char* name, const std::string& value) {
    pugi::xml_node node = root_.append_child("default");
    node.append_attribute("name") = name;
    node.append_attribute("value") = value.c_str();
  }

  void add_integrator() {
    const pugi::xml_node node = plugin(root_, "integrator", "path");
    set(node, "integer", "max_depth", "$depth");
    set(node, "integer", "rr_depth",
        std::to_string(settings_.max_depth > kRouletteDepth ? kRouletteDepth : kNoRoulette));
  }

  void add_sensor() {
    const Framing framing = frame(scene_, settings_);
    const Bounds box = bounds(scene_);
    const glm::dvec3 eye = box.center() + framing.eye;
    const bool lens = settings_.lens_radius > 0;
    const pugi::xml_node node = plugin(root_, "sensor", lens ? "thinlens" : "perspective");
    set(node, "string", "fov_axis", "y");
    set(node, "float", "fov", exact(2 * std::atan(framing.pixel * settings_.height / 2) * kDegrees));
    const double reach = glm::length(framing.eye) + box.diagonal();
    set(node, "float", "near_clip", exact(1e-6 * reach));
    set(node, "float", "far_clip", exact(10 * reach));
    if (lens) {
      set(node, "float", "aperture_radius", exact(settings_.lens_radius));
      set(node, "float", "focus_distance", exact(settings_.focal_distance));
    }
    pugi::xml_node transform = pugi::xml_node(node).append_child("transform");
    transform.append_attribute("name") = "to_world";
    pugi::xml_node look_at = transform.append_child("lookat");
    look_at.append_attribute("origin") = exact(eye).c_str();
    look_at.append_attribute("target") = exact(eye - framing.back * reach).c_str();
    look_at.append_attribute("up") = exact(framing.up).c_str();
    set(plugin(node, "sampler", "$sampler"), "integer", "sample_count", "$samples");
    const pugi::xml_node film = plugin(node, "film", "hdrfilm");
    set(film, "integer", "width", std::to_string(settings_.width));
    set(film, "integer", "height", std::to_string(settings_.height));
    set(film, "string", "pixel_format", "rgb");
    set(film, "string", "component_format", "float32");
    plugin(film, "rfilter", "box");
  }

  void add_material(size_t index) {
    const Material& m = scene_.materials[index];
    const bool rough = is_rough_glass(m);
    const char* type = rough                         ? "roughdielectric"
                       : m.kind == Kind::kGlass      ? "dielectric"
                       : m.kind == Kind::kMirror     ? "conductor"
                       : m.kind == Kind::kMicrofacet ? "roughconductor"
                                                     : "diffuse";
    root_.append_child(pugi::node_comment).set_value((' ' + m.name + ' ').c_str());
    pugi::xml_node outer = plugin(root_, "bsdf", m.kind == Kind::kGlass ? type : "twosided");
    outer.append_attribute("id") = id_of(index).c_str();
    const pugi::xml_node node = m.kind == Kind::kGlass ? outer : plugin(outer, "bsdf", type);
    switch (m.kind) {
      case Kind::kDiffuse:
        if (m.texture == kNoTexture) {
          rgb(node, "reflectance", m.reflectance);
        } else {
          add_albedo_map(node, index);
        }
        break;
      case Kind::kEmission:
        rgb(node, "reflectance", glm::dvec3(0.0));
        break;
      case Kind::kMirror:
        set(node, "string", "material", "none");
        rgb(node, "specular_reflectance", m.reflectance);
        break;
      case Kind::kGlass:
        set(node, "float", "int_ior", exact(m.ior));
        set(node, "float", "ext_ior", "1");
        if (rough) {
          set(node, "string", "distribution", "beckmann");
          set(node, "float", "alpha", exact(m.roughness));
        }
        rgb(node, "specular_reflectance", m.reflectance);
        rgb(node, "specular_transmittance", m.transmittance);
        break;
      case Kind::kMicrofacet:
        set(node, "string", "distribution", "beckmann");
        set(node, "float", "alpha", exact(m.alpha));
        rgb(node, "eta", m.eta);
        rgb(node, "k", m.k);
        break;
    }
  }

  void add_albedo_map(pugi::xml_node bsdf, size_t index) {
    const std::string path = albedo_path(folder_, index);
    result_.files.push_back({path, encode_image(path, albedo_map(scene_, scene_.materials[index]))});
    pugi::xml_node node = plugin(bsdf, "texture", "bitmap");
    node.append_attribute("name") = "reflectance";
    set(node, "string", "filename", path);
  }

  // Emitters without normals: which side emits is the winding's to say.
  void add_mesh(size_t index) {
    const Mesh& mesh = scene_.meshes[index];
    const bool smooth = !mesh.normals.empty() && scene_.materials[mesh.material].kind != Kind::kEmission;
    const std::string path = mesh_path(folder_, index);
    result_.files.push_back({path, ply_file(mesh, smooth, true)});
    const pugi::xml_node node = plugin(root_, "shape", "ply");
    set(node, "string", "filename", path);
    set(node, "boolean", "face_normals", smooth ? "false" : "true");
    add_surface(node, mesh.material);
  }

  void add_sphere(const Sphere& sphere) {
    const pugi::xml_node node = plugin(root_, "shape", "sphere");
    set(node, "point", "center", exact(sphere.center));
    set(node, "float", "radius", exact(sphere.radius));
    add_surface(node, sphere.material);
  }

  // In Mitsuba the first and the last row of texels lie at the poles, and y is up. With a row at every half row of ours, of
  // which those between two are their mean, both interpolate to the same. It takes no map of one column.
  void add_environment() {
    const Image& map = scene_.environment;
    Image rows(std::max(map.width, 2u), 2 * map.height + 1);
    for (uint32_t y = 0; y < rows.height; ++y) {
      const uint32_t upper = (std::max(y, 1u) - 1) / 2, lower = std::min(y / 2, map.height - 1);
      for (uint32_t x = 0; x < rows.width; ++x) {
        const float *a = map.pixel(x % map.width, upper), *b = map.pixel(x % map.width, lower);
        for (int k = 0; k < 3; ++k) rows.pixel(x, y)[k] = 0.5f * a[k] + 0.5f * b[k];
      }
    }
    const std::string path = folder_ + "/sky.pfm";
    result_.files.push_back({path, encode_image(path, rows)});
    pugi::xml_node node = plugin(root_, "emitter", "envmap");
    set(node, "string", "filename", path);
    pugi::xml_node transform = node.append_child("transform");
    transform.append_attribute("name") = "to_world";
    transform.append_child("matrix").append_attribute("value") =
        scene_.up.y > 0.5 ? "0 0 1 0  0 1 0 0  -1 0 0 0  0 0 0 1" : "0 0 1 0  1 0 0 0  0 1 0 0  0 0 0 1";
  }

  void add_surface(pugi::xml_node node, uint32_t material) {
    node.append_child("ref").append_attribute("id") = id_of(material).c_str();
    const Material& m = scene_.materials[material];
    if (m.kind == Kind::kEmission) rgb(plugin(node, "emitter", "area"), "radiance", m.radiance);
  }

  static std::string id_of(size_t material) { return "material" + std::to_string(material); }

  const Scene& scene_;
  const Settings& settings_;
  const std::string& folder_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  ExportedScene result_;
};

}  // namespace

ExportedScene export_mitsuba(const Scene& scene, const Settings& settings, const std::string& folder) {
  return Writer(scene, settings, folder).write();
}

}  // namespace lanewise
