// `lanewise convert` from outside: what it writes reads back as the scene. LANEWISE_BINARY names the program.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <pugixml.hpp>
#include <sstream>

#include "core/framing.h"
#include "core/plan.h"
#include "scenes/load.h"
#include "tests/formats_harness.h"
#include "tests/program.h"
#include "tests/scenes_harness.h"
#include "tests/subprocess.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using glm::dvec3;
using test::box;
using test::nothing_to_test;
using test::ProcessResult;
using test::program;
using test::TemporaryFolder;
using Arguments = std::vector<std::string>;

ProcessResult convert(const TemporaryFolder& folder, const Arguments& arguments) {
  Arguments all = {"convert"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return test::run_process(program(), all, folder.path());
}

pugi::xml_document read_xml(const std::string& path) {
  pugi::xml_document document;
  REQUIRE(document.load_file(path.c_str()));
  return document;
}

std::string value(pugi::xml_node node, const char* name) {
  return node.find_child_by_attribute("name", name).attribute("value").value();
}

dvec3 triple(const std::string& text) {
  dvec3 v(NAN);
  std::istringstream(text) >> v.x >> v.y >> v.z;
  return v;
}

// The bsdf that the shape refers to, without its two-sided wrapping.
pugi::xml_node bsdf_of(const pugi::xml_document& document, pugi::xml_node shape) {
  const char* id = shape.child("ref").attribute("id").value();
  const pugi::xml_node found = document.child("scene").find_child_by_attribute("bsdf", "id", id);
  return found.child("bsdf") ? found.child("bsdf") : found;
}

TEST_CASE("convert command: Mitsuba's file has the scene's shapes, materials and camera") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const ProcessResult result =
      convert(folder, {box(), "-f", "box.xml", "-r", "64", "48", "-s", "9", "-m", "7", "--view", "fit"});
  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  const pugi::xml_document document = read_xml(folder.file("box.xml"));
  const pugi::xml_node root = document.child("scene");
  CHECK(value(root, "samples") == "9");
  CHECK(value(root, "depth") == "8");
  CHECK(value(root.child("integrator"), "rr_depth") == "5");

  Settings settings;
  settings.width = 64;
  settings.height = 48;
  settings.view = View::kFit;
  const Scene scene = load_scene(box());
  const Framing framing = frame(scene, settings);
  const pugi::xml_node sensor = root.child("sensor"), look_at = sensor.child("transform").child("lookat");
  const double fov = std::stod(value(sensor, "fov"));
  CHECK(std::tan(fov * std::numbers::pi / 360) == doctest::Approx(24 * framing.pixel));
  const dvec3 origin = triple(look_at.attribute("origin").value()),
              target = triple(look_at.attribute("target").value());
  CHECK(glm::length(origin - framing.eye - bounds(scene).center()) < 1e-12);
  CHECK(glm::length(glm::normalize(origin - target) - framing.back) < 1e-12);
  CHECK(triple(look_at.attribute("up").value()) == framing.up);
  CHECK(value(sensor.child("film"), "width") == "64");

  size_t meshes = 0, spheres = 0, lights = 0;
  for (const pugi::xml_node shape : root.children("shape")) {
    const bool mesh = std::string(shape.attribute("type").value()) == "ply";
    const uint32_t material = mesh ? scene.meshes[meshes].material : scene.spheres[spheres].material;
    const Material& m = scene.materials[material];
    const pugi::xml_node bsdf = bsdf_of(document, shape);
    CAPTURE(m.name);
    if (mesh) {
      const Scene part = load_scene(folder.file(value(shape, "filename")));
      CHECK(part.triangle_count() == scene.meshes[meshes].triangles.size());
      ++meshes;
    } else {
      CHECK(triple(value(shape, "center")) == scene.spheres[spheres].center);
      CHECK(std::stod(value(shape, "radius")) == scene.spheres[spheres].radius);
      ++spheres;
    }
    if (m.kind == Material::Kind::kEmission) {
      ++lights;
      CHECK(triple(value(shape.child("emitter"), "radiance")) == m.radiance);
      CHECK(triple(value(bsdf, "reflectance")) == dvec3(0.0));
    } else if (m.kind == Material::Kind::kDiffuse) {
      CHECK(triple(value(bsdf, "reflectance")) == m.reflectance);
    } else if (m.kind == Material::Kind::kMirror) {
      CHECK(std::string(bsdf.attribute("type").value()) == "conductor");
      CHECK(triple(value(bsdf, "specular_reflectance")) == m.reflectance);
    } else {
      CHECK(std::string(bsdf.attribute("type").value()) == "dielectric");
      CHECK(std::stod(value(bsdf, "int_ior")) == m.ior);
    }
  }
  CHECK(meshes == scene.meshes.size());
  CHECK(spheres == 2);
  CHECK(lights == 1);
}

TEST_CASE("convert command: meshes read back with their corners and normals, emitters without normals") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  test::write_boxes(folder);
  CHECK(convert(folder, {"box.dae", "-f", "a.xml", "-b", "0.25", "-d", "3"}).exit_code == 0);
  CHECK(convert(folder, {"box.dae", "-f", "flat.xml", "--normals", "flat"}).exit_code == 0);
  CHECK(convert(folder, {"box.dae", "-f", "smooth.xml", "--normals", "smooth"}).exit_code == 0);
  const Scene scene = load_scene(folder.file("box.dae"));
  for (size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    const std::string name = "/" + std::to_string(i) + ".ply";
    const Mesh& mesh = scene.meshes[i];
    const Scene part = load_scene(folder.file("a_meshes" + name));
    REQUIRE(part.meshes.size() == 1);
    REQUIRE(part.meshes[0].triangles.size() == mesh.triangles.size());
    CHECK(part.meshes[0].normals.empty() == mesh.normals.empty());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int c = 0; c < 3; ++c) {
        CHECK(part.meshes[0].positions[part.meshes[0].triangles[t][c]] == mesh.positions[mesh.triangles[t][c]]);
        if (!mesh.normals.empty()) CHECK(part.meshes[0].normals[t][c] == mesh.normals[t][c]);
      }
    }
    CHECK(load_scene(folder.file("flat_meshes" + name)).meshes[0].normals.empty());
    const bool emits = scene.materials[mesh.material].kind == Material::Kind::kEmission;
    CHECK(load_scene(folder.file("smooth_meshes" + name)).meshes[0].normals.empty() == emits);
  }
  const pugi::xml_document written = read_xml(folder.file("a.xml"));
  const pugi::xml_node sensor = written.child("scene").child("sensor");
  CHECK(std::string(sensor.attribute("type").value()) == "thinlens");
  CHECK(value(sensor, "aperture_radius") == "0.25");
  CHECK(value(sensor, "focus_distance") == "3");
}

TEST_CASE("convert command: pbrt's file, and what is told to be lost in it") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  test::write_boxes(folder);
  const ProcessResult result = convert(folder, {"box.dae", "-f", "box.pbrt", "-r", "60", "40", "-m", "3", "-s", "4"});
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("is a mirror: pbrt's is a metal") != std::string::npos);
  const std::string text = test::read_text(folder.file("box.pbrt"));
  for (const char* part :
       {"Scale -1 1 1\nLookAt 0 1 4  0 1 3  0 1 0\n", "\"integer maxdepth\" [3]", "\"integer pixelsamples\" [4]",
        "\"string type\" \"diffuse\" \"rgb reflectance\" [0.75 0.5 0.25]",
        "AreaLightSource \"diffuse\" \"rgb L\" [4 3 2]", "Shape \"plymesh\" \"string filename\" \"box_meshes/2.ply\"",
        "\"conductor\" \"rgb reflectance\" [0.75 0.75 0.5]"}) {
    CAPTURE(std::string(part));
    CHECK(text.find(part) != std::string::npos);
  }
  const size_t at = text.find("\"float fov\" [");
  REQUIRE(at != std::string::npos);
  const double fov = std::stod(text.substr(at + 13));  // of the shorter side
  CHECK(std::tan(fov * std::numbers::pi / 360) == doctest::Approx(std::tan(std::numbers::pi / 6) / 1.5));
  CHECK(std::count(text.begin(), text.end(), '[') == std::count(text.begin(), text.end(), ']'));
  CHECK(convert(folder, {box(), "-f", "spheres.pbrt"}).exit_code == 0);
  const std::string spheres = test::read_text(folder.file("spheres.pbrt"));
  CHECK(spheres.find("\"string type\" \"dielectric\" \"float eta\" [1.5]") != std::string::npos);
  CHECK(spheres.find("Shape \"sphere\" \"float radius\" [") != std::string::npos);
}

TEST_CASE("convert command: eta and k of metals as Mitsuba and pbrt take them") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::string scene = test::environment("LANEWISE_SOURCE_DIR", ".") + "/scenes/cornell_metal.dae";
  const Arguments metal = {scene, "--metal", "gold", "--alpha", "0.05"};
  for (const char* output : {"m.xml", "m.pbrt"}) {
    Arguments all = metal;
    all.insert(all.end(), {"-f", output});
    CHECK(convert(folder, all).exit_code == 0);
  }
  const std::string xml = test::read_text(folder.file("m.xml")), pbrt = test::read_text(folder.file("m.pbrt"));
  CHECK(xml.find("name=\"eta\" value=\"0.21646 0.42833 1.3284\"") != std::string::npos);
  CHECK(xml.find("name=\"alpha\" value=\"0.05\"") != std::string::npos);
  CHECK(xml.find("value=\"beckmann\"") != std::string::npos);
  CHECK(pbrt.find("\"spectrum eta\" [360 1.3284 466 1.3284 549 0.42833 614 0.21646 830 0.21646]") != std::string::npos);
  CHECK(pbrt.find("\"float roughness\" [0.05] \"bool remaproughness\" false") != std::string::npos);
}

TEST_CASE("convert command: rough glass as Mitsuba and pbrt take it, smooth where it is rendered smooth") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::string text = test::read_text(box()), zero = "<roughness>0<";
  const size_t at = text.find(zero);
  REQUIRE(at != std::string::npos);
  for (const std::string roughness : {"0.25", "0.00005"}) {
    CAPTURE(roughness);
    const bool rough = roughness == "0.25";
    const std::string scene = folder.file("a.dae");
    test::write_text(scene, std::string(text).replace(at, zero.size(), "<roughness>" + roughness + "<"));
    REQUIRE(convert(folder, {scene, "-f", "a.xml"}).exit_code == 0);
    const ProcessResult result = convert(folder, {scene, "-f", "a.pbrt"});
    REQUIRE(result.exit_code == 0);
    const std::string xml = test::read_text(folder.file("a.xml")), pbrt = test::read_text(folder.file("a.pbrt"));
    const auto has = [](const std::string& all, const char* part) { return all.find(part) != std::string::npos; };
    CHECK(has(xml, "type=\"roughdielectric\"") == rough);
    CHECK(has(xml, "type=\"dielectric\"") == !rough);
    CHECK(has(xml, "name=\"distribution\" value=\"beckmann\"") == rough);
    CHECK(has(xml, "name=\"alpha\" value=\"0.25\"") == rough);
    CHECK(has(pbrt, "\"float roughness\" [0.25] \"bool remaproughness\" false") == rough);
    CHECK(has(result.out, "is rough glass of Beckmann's distribution") == rough);
  }
}

TEST_CASE("convert command: autofocus is a distance for others") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  REQUIRE(convert(folder, {box(), "-b", "0.01", "--autofocus", "-f", "box.xml"}).exit_code == 0);
  const pugi::xml_document document = read_xml(folder.file("box.xml"));
  Settings settings;
  settings.autofocus = true;
  const double distance = make_plan(load_scene(box()), settings).settings.focal_distance;
  CHECK(std::stod(value(document.child("scene").child("sensor"), "focus_distance")) == doctest::Approx(distance));
}

TEST_CASE("convert command: wrong input gives one line, an exit code and no file") {
  if (nothing_to_test()) return;
  const TemporaryFolder folder;
  const std::pair<Arguments, int> wrong[] = {{{box()}, 2},
                                             {{box(), "-f", "box.obj"}, 2},
                                             {{box(), "-f", "box.xml", "-p", "0", "0", "9", "9"}, 2},
                                             {{box(), "-f", "box.xml", "--camera", "none"}, 2},
                                             {{box(), "-f", "no/folder.xml"}, 1},
                                             {{"none.dae", "-f", "box.xml"}, 1}};
  for (const auto& [arguments, exit_code] : wrong) {
    const ProcessResult result = convert(folder, arguments);
    CAPTURE(result.err);
    CHECK(result.exit_code == exit_code);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  }
  CHECK(folder.names().empty());
  // A file where the meshes' folder would be.
  test::write_text(folder.file("box_meshes"), "mine");
  CHECK(convert(folder, {box(), "-f", "box.xml"}).exit_code == 1);
  CHECK(folder.names().size() == 1);
  CHECK(test::read_text(folder.file("box_meshes")) == "mine");
}

}  // namespace
}  // namespace lanewise
