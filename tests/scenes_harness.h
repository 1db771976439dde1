// A small COLLADA document to vary, and loading from text through a temporary file.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/types.h"
#include "scenes/load.h"

namespace lanewise {

// A camera, an emissive triangle, a grey triangle with normals, and a sphere of a default material.
inline const std::string kDocument = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_cameras><camera id="cam"><optics><technique_common><perspective>
<xfov>60</xfov><aspect_ratio>1.5</aspect_ratio><znear>0.1</znear>
</perspective></technique_common></optics></camera></library_cameras>
<library_lights><light id="sun"><technique_common><point><color>1 1 1</color></point></technique_common></light></library_lights>
<library_effects>
<effect id="grey-fx"><profile_COMMON><technique sid="c"><lambert><diffuse><color>0.25 0.5 0.75 1</color></diffuse></lambert></technique></profile_COMMON></effect>
<effect id="glow-fx"><extra><technique profile="CGL"><emission><radiance>3 2 1</radiance></emission></technique></extra></effect>
</library_effects>
<library_materials>
<material id="grey"><instance_effect url="#grey-fx"/></material>
<material id="glow"><instance_effect url="#glow-fx"/></material>
</library_materials>
<library_geometries>
<geometry id="lamp"><mesh>
<source id="lp"><float_array id="lpa" count="9">0 0 5 0 1 5 1 0 5</float_array>
<technique_common><accessor source="#lpa" count="3" stride="3"/></technique_common></source>
<vertices id="lv"><input semantic="POSITION" source="#lp"/></vertices>
<triangles material="glow" count="1"><input semantic="VERTEX" source="#lv" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry>
<geometry id="tri"><mesh>
<source id="tp"><float_array id="tpa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#tpa" count="3" stride="3"/></technique_common></source>
<source id="tn"><float_array id="tna" count="6">0 0 2 0 0 0</float_array>
<technique_common><accessor source="#tna" count="2" stride="3"/></technique_common></source>
<vertices id="tv"><input semantic="POSITION" source="#tp"/></vertices>
<triangles material="surface" count="1"><input semantic="VERTEX" source="#tv" offset="0"/><input semantic="NORMAL" source="#tn" offset="1"/><p>0 0 1 0 2 1</p></triangles>
</mesh></geometry>
<geometry id="ball"><extra><technique profile="CGL"><sphere><radius>.5</radius></sphere></technique></extra></geometry>
</library_geometries>
<library_nodes><node id="spare"/></library_nodes>
<library_visual_scenes><visual_scene id="vs">
<node id="camera-node"><instance_camera url="#cam"/></node>
<node id="lamp-node"><instance_geometry url="#lamp"/></node>
<node id="shape"><translate>1 2 3</translate><instance_geometry url="#tri"><bind_material><technique_common><instance_material symbol="surface" target="#grey"/></technique_common></bind_material></instance_geometry></node>
<node id="ball-node"><translate>5 0 0</translate><instance_geometry url="#ball"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#vs"/></scene>
</COLLADA>
)";

// kDocument with a part of it, which must occur, replaced.
inline std::string varied(const std::string& from, const std::string& to, std::string document = kDocument) {
  const size_t at = document.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return document.replace(at, from.size(), to);
}

// A file of this content that goes away with the object.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content, const std::string& extension = ".dae")
      : path_((std::filesystem::temp_directory_path() /
               ("lanewise_scene_" + std::to_string(getpid()) + '_' + std::to_string(counter_++) + extension))
                  .string()) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  static inline int counter_ = 0;
  std::string path_;
};

inline Scene load_text(const std::string& document) { return load_scene(TemporaryFile(document).path()); }

// The message that loading throws, after checks that it is one line and names the file.
inline std::string error_of(const std::string& document, const std::string& extension = ".dae") {
  const TemporaryFile file(document, extension);
  try {
    load_scene(file.path());
  } catch (const Error& error) {
    const std::string message = error.what();
    CHECK(message.starts_with(file.path()));
    CHECK(message.find('\n') == std::string::npos);
    return message.substr(file.path().size());
  }
  return "loaded";
}

inline bool has_notice(const Scene& scene, const std::string& part) {
  for (const std::string& notice : scene.notices) {
    if (notice.find(part) != std::string::npos) return true;
  }
  return false;
}

}  // namespace lanewise
