#include "tests/fuzz/harness.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/image_stb.h"
#include "core/plan.h"
#include "core/render.h"
#include "core/types.h"
#include "scenes/default_camera.h"
#include "scenes/environment_file.h"
#include "scenes/export.h"
#include "scenes/inspect.h"

namespace lanewise::fuzz {
namespace {

namespace fs = std::filesystem;

bool is_used = true;  // what is read

std::vector<const Harness*>& registered() {
  static std::vector<const Harness*> all;
  return all;
}

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "lanewise-fuzz-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed");
    path_ = name;
    Image wood(2, 2);
    wood.rgb = {1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 1};
    write("wood.png", encode_png(wood));
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  std::string write(const std::string& name, std::string_view bytes) const {
    const std::string path = (path_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  size_t files() const { return static_cast<size_t>(std::distance(fs::directory_iterator(path_), {})); }

 private:
  fs::path path_;
};

void check_message(const std::string& message, const std::string& path) {
  if (message.find('\n') != std::string::npos) throw std::logic_error("an error of several lines: " + message);
  if (!message.starts_with(fs::path(path).parent_path().string())) {
    throw std::logic_error("an error that names no file: " + message);
  }
}

}  // namespace

Harness::Harness(std::string name_, std::string extension_, std::function<void(const std::string&)> read_)
    : name(std::move(name_)), extension(std::move(extension_)), read(std::move(read_)) {
  registered().push_back(this);
}

void Harness::run(std::string_view bytes, bool render) const {
  is_used = render;
  static const Folder folder;
  const std::string path = folder.write("input" + extension, bytes);
  const size_t before = folder.files();
  try {
    read(path);
  } catch (const Error& error) {
    check_message(error.what(), path);
  }
  if (folder.files() != before) throw std::logic_error("a file is there that was not");
}

std::vector<const Harness*> harnesses() {
  std::vector<const Harness*> all = registered();
  std::ranges::sort(all, {}, [](const Harness* harness) { return harness->name; });
  return all;
}

void use(const Scene& scene) {
  constexpr size_t kMostToInspect = 20'000, kMostToRender = 2'000;
  const size_t primitives = scene.triangle_count() + scene.spheres.size();
  if (primitives > kMostToInspect || !is_used) return;
  scene_warnings(scene);
  light_facts(scene);
  material_uses(scene);
  Settings settings;
  settings.width = 4, settings.height = 3, settings.spp = 1, settings.threads = 1, settings.wave = 16;
  const Plan plan = make_plan(scene, settings);
  if (primitives > kMostToRender || plan.texels.size() > (1 << 16)) return;
  export_mitsuba(scene, settings, "parts");
  export_pbrt(scene, settings, "parts");
  if (render(plan).stats.invalid_samples > 0) throw std::logic_error("a sample that is not a finite, positive number");
}

void use_sky(const std::string& path) {
  Scene scene;
  scene.path = path;
  scene.environment = load_environment(path);
  scene.materials.push_back({.name = "mirror", .kind = Material::Kind::kMirror, .reflectance = glm::dvec3(1)});
  scene.spheres.push_back({});
  scene.cameras.push_back(default_camera(scene));
  finish_scene(scene);
  if (scene.environment.rgb.size() <= (1 << 20)) use(scene);
}

}  // namespace lanewise::fuzz
