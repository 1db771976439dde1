// One small box in each format that is read: made here, so that what the formats say of it is in one place.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lanewise::test {

// The floor, a ball's stand-in (a tilted square with normals of its own) and a lamp; coordinates that floats hold.
struct Quad {
  const char* name;
  float corners[12];
  float normals[12];
  bool has_normals;
};
inline const Quad kQuads[] = {
    {"floor", {-1, 0, -1, -1, 0, 1, 1, 0, 1, 1, 0, -1}, {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}, false},
    {"tilted", {-.5, .25, 0, .5, .25, 0, .5, 1, -.5, -.5, 1, -.5}, {0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0}, true},
    {"lamp", {-.5, 2, -.5, .5, 2, -.5, .5, 2, .5, -.5, 2, .5}, {0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1, 0}, false},
};

inline std::string numbers(const float* values, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i) text += (i ? " " : "") + nlohmann::json(values[i]).dump();
  return text;
}

inline const std::string kMtl =
    "newmtl grey\nKd 0.75 0.5 0.25\nnewmtl shiny\nillum 3\nKs 0.75 0.75 0.5\nnewmtl glow\nKe 4 3 2\n";

inline std::string box_obj() {
  std::string text = "mtllib box.mtl\n";
  const char* materials[] = {"grey", "shiny", "glow"};
  for (int q = 0; q < 3; ++q) {
    text += std::string("o ") + kQuads[q].name + "\nusemtl " + materials[q] + "\n";
    for (int i = 0; i < 4; ++i) text += "v " + numbers(kQuads[q].corners + 3 * i, 3) + "\n";
    for (int i = 0; i < 4; ++i) text += "vn " + numbers(kQuads[q].normals + 3 * i, 3) + "\n";
    text += "f";
    for (int i = 1; i <= 4; ++i) {
      const std::string v = std::to_string(4 * q + i);
      text += " " + v + (kQuads[q].has_normals ? "//" + v : "");
    }
    text += "\n";
  }
  return text;
}

// The twin of box_obj; materials in CGL's words, z up so that the world is the file's.
inline std::string box_dae() {
  const char* effects[] = {
      "<profile_COMMON><technique><lambert><diffuse><color>0.75 0.5 0.25 1</color></diffuse></lambert></technique>"
      "</profile_COMMON>",
      "<extra><technique profile=\"CGL\"><mirror><reflectance>0.75 0.75 0.5</reflectance></mirror></technique></extra>",
      "<extra><technique profile=\"CGL\"><emission><radiance>4 3 2</radiance></emission></technique></extra>"};
  std::string fx, materials, geometries, nodes;
  for (int q = 0; q < 3; ++q) {
    const std::string id = kQuads[q].name;
    fx += "<effect id=\"" + id + "-fx\">" + effects[q] + "</effect>";
    materials += "<material id=\"" + id + "-m\"><instance_effect url=\"#" + id + "-fx\"/></material>";
    const auto source = [&](const char* what, const float* values) {
      return "<source id=\"" + id + what + "\"><float_array id=\"" + id + what + "a\" count=\"12\">" +
             numbers(values, 12) + "</float_array><technique_common><accessor source=\"#" + id + what +
             "a\" count=\"4\" stride=\"3\"/></technique_common></source>";
    };
    geometries += "<geometry id=\"" + id + "\"><mesh>" + source("p", kQuads[q].corners) +
                  source("n", kQuads[q].normals) + "<vertices id=\"" + id +
                  "v\"><input semantic=\"POSITION\" source=\"#" + id + "p\"/></vertices><polylist material=\"" + id +
                  "-m\" count=\"1\"><input semantic=\"VERTEX\" source=\"#" + id + "v\" offset=\"0\"/>" +
                  (kQuads[q].has_normals ? "<input semantic=\"NORMAL\" source=\"#" + id + "n\" offset=\"0\"/>" : "") +
                  "<vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry>";
    nodes += "<node id=\"" + id + "-node\" name=\"" + id + "\"><instance_geometry url=\"#" + id + "\"/></node>";
  }
  return "<COLLADA version=\"1.4.1\"><asset><up_axis>Z_UP</up_axis></asset>"
         "<library_cameras><camera id=\"cam\"><optics><technique_common><perspective><xfov>60</xfov>"
         "<aspect_ratio>1.5</aspect_ratio></perspective></technique_common></optics></camera></library_cameras>"
         "<library_effects>" +
         fx + "</library_effects><library_materials>" + materials + "</library_materials><library_geometries>" +
         geometries +
         "</library_geometries><library_visual_scenes><visual_scene id=\"vs\"><node id=\"camera\"><translate>0 1 "
         "4</translate><instance_camera url=\"#cam\"/></node>" +
         nodes + "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#vs\"/></scene></COLLADA>";
}

// The buffer of box_gltf: for each quad corners and normals, then six indices.
inline std::string box_buffer() {
  std::string bytes;
  const auto append = [&](const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); };
  for (const Quad& quad : kQuads) {
    append(quad.corners, sizeof quad.corners);
    append(quad.normals, sizeof quad.normals);
  }
  const uint16_t indices[] = {0, 1, 2, 0, 2, 3};
  append(indices, sizeof indices);
  return bytes;
}

// Its buffer is box.bin. Materials stand in another order than meshes use them.
inline nlohmann::json box_gltf() {
  using nlohmann::json;
  json gltf = json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
    "nodes": [{"name": "camera", "camera": 0, "translation": [0, 1, 4]}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7358, "aspectRatio": 1.5, "znear": 0.1}}],
    "materials": [
      {"name": "glow", "emissiveFactor": [1, 0.75, 0.5],
       "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}},
      {"name": "shiny", "pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.75, 0.5, 1], "roughnessFactor": 0}},
      {"name": "grey", "pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.5, 0.25, 1], "metallicFactor": 0}}],
    "bufferViews": [{"buffer": 0, "byteLength": 288}, {"buffer": 0, "byteOffset": 288, "byteLength": 12}],
    "buffers": [{"byteLength": 300, "uri": "box.bin"}]})");
  gltf["cameras"][0]["perspective"]["yfov"] = 2 * std::atan(std::tan(std::acos(-1.0) / 6) / 1.5);
  for (int q = 0; q < 3; ++q) {
    json attributes = {{"POSITION", 2 * q}};
    if (kQuads[q].has_normals) attributes["NORMAL"] = 2 * q + 1;
    gltf["meshes"].push_back({{"primitives", {{{"attributes", attributes}, {"indices", 6}, {"material", 2 - q}}}}});
    gltf["nodes"].push_back({{"name", kQuads[q].name}, {"mesh", q}});
    for (int part = 0; part < 2; ++part) {
      gltf["accessors"].push_back({{"bufferView", 0},
                                   {"byteOffset", 96 * q + 48 * part},
                                   {"componentType", 5126},
                                   {"count", 4},
                                   {"type", "VEC3"}});
    }
  }
  gltf["accessors"].push_back({{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}});
  return gltf;
}

inline std::string word(uint32_t value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }

// In one piece; the JSON's buffer must have no uri.
inline std::string glb(nlohmann::json gltf, std::string buffer) {
  if (gltf.contains("buffers")) gltf["buffers"][0].erase("uri");
  std::string text = gltf.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  buffer.append((4 - buffer.size() % 4) % 4, '\0');
  const auto size = static_cast<uint32_t>(28 + text.size() + buffer.size());
  return "glTF" + word(2) + word(size) + word(static_cast<uint32_t>(text.size())) + "JSON" + text +
         word(static_cast<uint32_t>(buffer.size())) + std::string("BIN\0", 4) + buffer;
}

// All quads as one mesh without materials.
inline std::string box_ply(bool binary) {
  std::string text = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") +
                     " 1.0\ncomment a box\nelement vertex 12\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 3\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Quad& quad : kQuads) {
    for (int i = 0; i < 4; ++i) {
      if (binary) text.append(reinterpret_cast<const char*>(quad.corners + 3 * i), 12);
      if (!binary) text += numbers(quad.corners + 3 * i, 3) + "\n";
    }
  }
  for (uint32_t q = 0; q < 3; ++q) {
    const uint32_t first = 4 * q;
    if (binary) text += '\4' + word(first) + word(first + 1) + word(first + 2) + word(first + 3);
    if (!binary) {
      text += "4";
      for (uint32_t i = 0; i < 4; ++i) text += " " + std::to_string(first + i);
      text += "\n";
    }
  }
  return text;
}

// Writes all of them: box.dae, box.obj, box.mtl, box.gltf, box.bin, box.glb, box.ply and binary.ply.
inline void write_boxes(const TemporaryFolder& folder) {
  write_text(folder.file("box.dae"), box_dae());
  write_text(folder.file("box.obj"), box_obj());
  write_text(folder.file("box.mtl"), kMtl);
  write_text(folder.file("box.gltf"), box_gltf().dump());
  write_text(folder.file("box.bin"), box_buffer());
  write_text(folder.file("box.glb"), glb(box_gltf(), box_buffer()));
  write_text(folder.file("box.ply"), box_ply(false));
  write_text(folder.file("binary.ply"), box_ply(true));
}

}  // namespace lanewise::test
