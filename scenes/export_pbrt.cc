#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/image_io.h"
#include "scenes/export.h"
#include "scenes/quoted.h"

namespace lanewise {
namespace {

using Kind = Material::Kind;

// Names that the file shows in comments.
std::string printable(const std::string& name) {
  std::string shown;
  for (const char c : name) shown += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  return shown;
}

class Writer {
 public:
  Writer(const Scene& scene, const Settings& settings, const std::string& folder)
      : scene_(scene), settings_(settings), folder_(folder) {}

  ExportedScene write() {
    add_view();
    text_ += "WorldBegin\n";
    for (size_t i = 0; i < scene_.materials.size(); ++i) add_material(i);
    for (size_t i = 0; i < scene_.meshes.size(); ++i) add_mesh(i);
    for (const Sphere& sphere : scene_.spheres) add_sphere(sphere);
    if (scene_.environment.width > 0)
      result_.losses.push_back("the environment map is left out: pbrt has another mapping");
    return std::move(result_);
  }

 private:
  // pbrt's LookAt has the view's right on the left of ours: the mirroring before it is of the camera's space alone.
  void add_view() {
    const Framing framing = frame(scene_, settings_);
    const glm::dvec3 eye = bounds(scene_).center() + framing.eye;
    const double side = std::min(settings_.width, settings_.height);
    const double fov = 2 * std::atan(framing.pixel * side / 2) * 180 / std::numbers::pi;
    text_ += "Scale -1 1 1\nLookAt " + exact(eye) + "  " + exact(eye - framing.back) + "  " + exact(framing.up) + "\n";
    text_ += "Camera \"perspective\" \"float fov\" [" + exact(fov) + "]";
    if (settings_.lens_radius > 0) {
      text_ += " \"float lensradius\" [" + exact(settings_.lens_radius) + "] \"float focaldistance\" [" +
               exact(settings_.focal_distance) + "]";
    }
    text_ += "\nFilm \"rgb\" \"integer xresolution\" [" + std::to_string(settings_.width) +
             "] \"integer yresolution\" [" + std::to_string(settings_.height) +
             "] \"string filename\" \"picture.exr\"\n" +
             "PixelFilter \"box\" \"float xradius\" [0.5] \"float yradius\" [0.5]\n" +
             "Sampler \"halton\" \"integer pixelsamples\" [" + std::to_string(settings_.spp) + "]\n" +
             "Integrator \"path\" \"integer maxdepth\" [" + std::to_string(settings_.max_depth) + "]\n\n";
  }

  void add_material(size_t index) {
    const Material& m = scene_.materials[index];
    if (m.texture != kNoTexture) add_albedo_map(index);
    text_ += "\n# " + printable(m.name) + "\nMakeNamedMaterial \"material" + std::to_string(index) + "\" ";
    const auto lost = [&](const char* what) { result_.losses.push_back("material " + quoted(m.name) + ' ' + what); };
    switch (m.kind) {
      case Kind::kDiffuse:
        text_ += "\"string type\" \"diffuse\" " +
                 (m.texture == kNoTexture ? rgb("reflectance", m.reflectance)
                                          : "\"texture reflectance\" \"albedo" + std::to_string(index) + "\"");
        break;
      case Kind::kEmission:
        text_ += "\"string type\" \"diffuse\" " + rgb("reflectance", glm::dvec3(0.0));
        break;
      case Kind::kMirror:
        text_ += "\"string type\" \"conductor\" " + rgb("reflectance", m.reflectance) + " \"float roughness\" [0]";
        lost("is a mirror: pbrt's is a metal, with that reflectance head on");
        break;
      case Kind::kGlass:
        text_ += "\"string type\" \"dielectric\" \"float eta\" [" + exact(m.ior) + "]";
        if (is_rough_glass(m)) {
          text_ += " \"float roughness\" [" + exact(m.roughness) + "] \"bool remaproughness\" false";
          lost("is rough glass of Beckmann's distribution: pbrt's is GGX");
        }
        if (m.reflectance != glm::dvec3(1.0) || m.transmittance != glm::dvec3(1.0))
          lost("is tinted glass: pbrt has none");
        break;
      case Kind::kMicrofacet:
        text_ += "\"string type\" \"conductor\" " + spectrum("eta", m.eta) + " " + spectrum("k", m.k) +
                 " \"float roughness\" [" + exact(m.alpha) + "] \"bool remaproughness\" false";
        lost("has Beckmann's distribution: pbrt's is GGX");
        break;
    }
    text_ += "\n";
  }

  void add_albedo_map(size_t index) {
    const std::string path = albedo_path(folder_, index);
    result_.files.push_back({path, encode_image(path, albedo_map(scene_, scene_.materials[index]))});
    text_ += "\nTexture \"albedo" + std::to_string(index) + "\" \"spectrum\" \"imagetexture\" \"string filename\" \"" +
             path + "\"\n";
  }

  // Emitters without normals: which side emits is the winding's to say.
  void add_mesh(size_t index) {
    const Mesh& mesh = scene_.meshes[index];
    const std::string path = mesh_path(folder_, index);
    result_.files.push_back({path, ply_file(mesh, scene_.materials[mesh.material].kind != Kind::kEmission)});
    begin(mesh.name, mesh.material);
    text_ += "  Shape \"plymesh\" \"string filename\" \"" + path + "\"\nAttributeEnd\n";
  }

  void add_sphere(const Sphere& sphere) {
    begin(sphere.name, sphere.material);
    text_ += "  Translate " + exact(sphere.center) + "\n  Shape \"sphere\" \"float radius\" [" + exact(sphere.radius) +
             "]\nAttributeEnd\n";
  }

  void begin(const std::string& name, uint32_t material) {
    const Material& m = scene_.materials[material];
    text_ +=
        "\n# " + printable(name) + "\nAttributeBegin\n  NamedMaterial \"material" + std::to_string(material) + "\"\n";
    if (m.kind == Kind::kEmission) text_ += "  AreaLightSource \"diffuse\" " + rgb("L", m.radiance) + "\n";
  }

  static std::string rgb(const std::string& name, const glm::dvec3& value) {
    return "\"rgb " + name + "\" [" + exact(value) + "]";
  }

  // Between the ends of the visible range, beyond which pbrt takes a list of values for 0.
  static std::string spectrum(const std::string& name, const glm::dvec3& v) {
    return "\"spectrum " + name + "\" [360 " + exact(v.z) + " 466 " + exact(v.z) + " 549 " + exact(v.y) + " 614 " +
           exact(v.x) + " 830 " + exact(v.x) + "]";
  }

  const Scene& scene_;
  const Settings& settings_;
  const std::string& folder_;
  ExportedScene result_;
  std::string& text_ = result_.text;
};

}  // namespace

ExportedScene export_pbrt(const Scene& scene, const Settings& settings, const std::string& folder) {
  return Writer(scene, settings, folder).write();
}

}  // namespace lanewise
