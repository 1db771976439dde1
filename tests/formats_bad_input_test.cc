// Broken OBJ, PLY and glTF files: one clear line each, whatever they claim, and nothing outside their folder.
#include <doctest/doctest.h>

#include <filesystem>

#include "scenes/load.h"
#include "tests/formats_harness.h"
#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

using nlohmann::json;
using test::TemporaryFolder;

// The message, after checks that it is one line and names the file; "loaded" if there is none.
std::string message_of(const std::string& path) {
  try {
    load_scene(path);
  } catch (const Error& error) {
    const std::string message = error.what();
    CHECK(message.starts_with(path));
    CHECK(message.find('\n') == std::string::npos);
    return message.substr(path.size());
  }
  return "loaded";
}

void check_message(const TemporaryFolder& folder, const char* name, const std::string& content,
                   const std::string& keyword) {
  test::write_text(folder.file(name), content);
  const std::string message = message_of(folder.file(name));
  CAPTURE(keyword);
  CAPTURE(message);
  CHECK(message.find(keyword) != std::string::npos);
}

void check_ply(const std::string& from, const std::string& to, const std::string& keyword) {
  const TemporaryFolder folder;
  check_message(folder, "bad.ply", varied(from, to, test::box_ply(false)), keyword);
}

// pointer: a JSON pointer into the box.
void check_gltf(const char* pointer, const json& value, const std::string& keyword) {
  const TemporaryFolder folder;
  test::write_text(folder.file("box.bin"), test::box_buffer());
  json gltf = test::box_gltf();
  gltf[json::json_pointer(pointer)] = value;
  CAPTURE(std::string(pointer));
  check_message(folder, "bad.gltf", gltf.dump(), keyword);
}

TEST_CASE("formats: PLY headers and contents that do not hold") {
  const TemporaryFolder folder;
  check_message(folder, "empty.ply", "", "is empty");
  check_message(folder, "words.ply", "just some words", "not a PLY file");
  check_message(folder, "short.ply", "ply\nformat ascii 1.0\n", "no line end_header");
  check_ply("format ascii 1.0", "comment nothing", "names no format");
  check_ply("format ascii 1.0", "format ebcdic 1.0", "names no format");
  check_ply("property float z", "property float w", "no x, y and z");
  check_ply("property float z", "property quad z", "the line \"property quad z\"");
  for (const char* count : {"1000", "4294967295", "18446744073709551615"}) {
    check_ply("element vertex 12", std::string("element vertex ") + count, "asks for more");
    check_ply("element face 3", std::string("element face ") + count, "asks for more");
  }
  check_ply("element vertex 12", "element vertex -1", "the line \"element vertex -1\"");
  check_ply("element vertex 12", "element vertex 99999999999999999999", "the line");
  check_ply("element face 3\nproperty list uchar int vertex_indices\n", "", "no geometry");
  check_ply("uchar int vertex_indices\n", "uchar int \xB1indices\xD9", "the line");
  check_ply("4 8 9 10 11", "4 8 9 10 12", "out of range");
  const std::string binary = test::box_ply(true);
  check_message(folder, "cut.ply", binary.substr(0, binary.size() - 60), "asks for more");
}

TEST_CASE("formats: OBJ that is no scene") {
  const TemporaryFolder folder;
  check_message(folder, "empty.obj", "", "is empty");
  check_message(folder, "words.obj", "just some words\nand more of them\n", ": ");
  check_message(folder, "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", ": ");
  check_message(folder, "range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ": ");
  check_message(folder, "huge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n", ": ");
  check_message(folder, "far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", "above 1e15");
  test::write_text(folder.file("a.mtl"), "newmtl m\nKd 2 0 0\n");
  check_message(folder, "white.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
                "\"m\": Kd must be between 0 and 1");
}

TEST_CASE("formats: glTF references, counts and values that do not hold") {
  check_gltf("/asset/version", "1.0", "only glTF 2");
  check_gltf("/extensionsRequired", {"EXT_velvet"}, "\"EXT_velvet\": not supported");
  check_gltf("/nodes/1/mesh", 3, "nodes[1].mesh is 3, and there are 3 meshes");
  check_gltf("/nodes/1/mesh", "x", "nodes[1].mesh is not a whole number");
  check_gltf("/nodes/1/children", {2}, "has a parent already");
  check_gltf("/nodes/1/children", {1}, "has a parent already");
  check_gltf("/nodes/1/children", {99}, "is 99");
  check_gltf("/nodes/1/matrix", {1, 2}, "has not 16 numbers");
  check_gltf("/nodes/1/scale", {0, 1, 1}, "singular");
  check_gltf("/nodes/0/camera", 1, "nodes[0].camera is 1");
  check_gltf("/cameras/0/perspective/yfov", 3.2, "yfov must be between");
  check_gltf("/scenes", json::array(), "has no scenes");
  check_gltf("/scene", 1, "scene is 1");
  check_gltf("/meshes/0/primitives", json::array(), "has no primitives");
  check_gltf("/meshes/0/primitives/0/material", 3, "is 3, and there are 3 materials");
  check_gltf("/meshes/0/primitives/0/indices", 0, "type is not SCALAR");
  check_gltf("/meshes/0/primitives/0/attributes/POSITION", 6, "type is not VEC3");
  check_gltf("/meshes/0/primitives/0/attributes", json::object(), "has no POSITION");
  check_gltf("/accessors/0/componentType", 5123, "component type 5123");
  check_gltf("/accessors/0/componentType", 5124, "no component type");
  for (const uint64_t count : {uint64_t{7}, uint64_t{1} << 28})
    check_gltf("/accessors/6/count", count, "reaches beyond");
  check_gltf("/accessors/6/count", uint64_t{1} << 60, "too large");
  check_gltf("/accessors/3/count", 3, "another length than POSITION");
  check_gltf("/accessors/0/byteOffset", 280, "reaches beyond");
  check_gltf("/accessors/0/byteOffset", ~uint64_t{0}, "too large");
  check_gltf("/accessors/0", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1 << 27}}, "no buffer holds");
  check_gltf("/bufferViews/0/byteLength", 301, "beyond its buffer");
  check_gltf("/buffers/0/byteLength", 1 << 30, ": ");
  check_gltf("/materials/0/emissiveFactor", {2, 0, 0}, "emissiveFactor must be between 0 and 1");
  check_gltf("/materials/0/emissiveFactor", {1, 0}, "not a colour");
  check_gltf("/materials/2/pbrMetallicRoughness/metallicFactor", -1, "metallicFactor must be between 0 and 1");
  check_gltf("/materials", json::object(), ": ");
}

TEST_CASE("formats: glTF that is broken as JSON or in its chunks") {
  const TemporaryFolder folder;
  check_message(folder, "words.gltf", "just some words", "not JSON: byte 1");
  check_message(folder, "list.gltf", "[]", "not an object");
  check_message(folder, "deep.gltf", "{\"extras\": " + std::string(200'000, '[') + std::string(200'000, ']') + "}",
                "nested more than 1000 deep");
  json chain = test::box_gltf();
  for (int i = 0; i < 2000; ++i) chain["nodes"].push_back({{"children", {i + 5}}});
  chain["nodes"].push_back({{"mesh", 0}});
  chain["scenes"][0]["nodes"] = {4};
  check_message(folder, "chain.gltf", chain.dump(), "nested more than 1000 deep");
  const std::string whole = test::glb(test::box_gltf(), test::box_buffer());
  for (size_t size = 0; size + 8 < whole.size(); size += 97) {
    test::write_text(folder.file("cut.glb"), whole.substr(0, size));
    CHECK(message_of(folder.file("cut.glb")) != "loaded");
  }
  std::string longer = whole;
  longer[15] = '\x7F';  // of the JSON's length
  check_message(folder, "long.glb", longer, "truncated");
}

TEST_CASE("formats: files are read from the scene's folder alone") {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "inner");
  test::write_text(folder.file("box.bin"), test::box_buffer());
  test::write_text(folder.file("box.mtl"), test::kMtl);
  json gltf = test::box_gltf();
  for (const std::string& uri :
       {std::string("../box.bin"), folder.file("box.bin"), std::string("link.bin"), std::string("none.bin")}) {
    gltf["buffers"][0]["uri"] = uri;
    fs::remove(folder.path() / "inner/link.bin");
    fs::create_symlink(folder.path() / "box.bin", folder.path() / "inner/link.bin");
    check_message(folder, "inner/out.gltf", gltf.dump(), "is no file in the scene's folder");
  }
  test::write_text(folder.file("inner/box.obj"), varied("box.mtl", "../box.mtl", test::box_obj()));
  const Scene scene = load_scene(folder.file("inner/box.obj"));
  CHECK(has_notice(scene, "\"box.mtl\" is no file in the scene's folder"));
  for (const Material& material : scene.materials) CHECK(material.reflectance == glm::dvec3(0.6f));
}

TEST_CASE("formats: a file with bytes changed is loaded or gives an error") {
  const TemporaryFolder folder;
  test::write_boxes(folder);
#ifdef NDEBUG
  constexpr int kTimes = 60;
#else
  constexpr int kTimes = 4;
#endif
  uint32_t state = 1;
  const auto draw = [&state](size_t below) {  // a linear congruential generator's upper bits
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % below;
  };
  for (const char* name : {"box.obj", "box.ply", "binary.ply", "box.gltf", "box.glb"}) {
    const std::string whole = test::read_text(folder.file(name));
    for (int i = 0; i < kTimes; ++i) {
      std::string changed = whole;
      for (size_t n = 1 + draw(3); n > 0; --n) changed[draw(changed.size())] = static_cast<char>(draw(256));
      const std::string path = folder.file("changed" + std::filesystem::path(name).extension().string());
      test::write_text(path, changed);
      CAPTURE(i);
      message_of(path);  // checks what it is
    }
  }
}

}  // namespace
}  // namespace lanewise
