// Textures in scene files: the ways in which formats refer to pictures and to the places in them, and to what is none.
#include <doctest/doctest.h>

#include <filesystem>

#include "core/image_io.h"
#include "scenes/export.h"
#include "scenes/load.h"
#include "scenes/own_file.h"
#include "tests/formats_harness.h"
#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;
using glm::dvec2;
using glm::dvec3;
using nlohmann::json;
using test::TemporaryFolder;
using test::write_text;

// Two texels: red, then blue.
std::string png() {
  Image image(2, 1);
  image.rgb = {1, 0, 0, 0, 0, 1};
  return encode_image("wood.png", image);
}

const std::string kColor = "<color>0.25 0.5 0.75 1</color>";
const std::string kImages =
    "<library_images><image id=\"img\"><init_from>wood.png</init_from></image></library_images><library_effects>";

// kDocument with a texture on its grey triangle, found by sampler and surface.
std::string textured_dae(const std::string& image = "wood.png") {
  std::string text = varied(kColor, "<texture texture=\"samp\" texcoord=\"UV\"/>");
  text = varied("<library_effects>", varied("wood.png", image, kImages), text);
  text = varied("<effect id=\"grey-fx\"><profile_COMMON>",
                "<effect id=\"grey-fx\"><profile_COMMON><newparam sid=\"surf\"><surface type=\"2D\"><init_from>img"
                "</init_from></surface></newparam><newparam sid=\"samp\"><sampler2D><source>surf</source></sampler2D>"
                "</newparam>",
                text);
  const auto source = [](const std::string& id, const std::string& numbers) {
    return "<source id=\"" + id + "\"><float_array id=\"" + id + "a\" count=\"6\">" + numbers +
           "</float_array><technique_common><accessor source=\"#" + id +
           "a\" count=\"3\" stride=\"2\"><param name=\"S\" type=\"float\"/><param name=\"T\" "
           "type=\"float\"/></accessor>"
           "</technique_common></source>";
  };
  text = varied("<vertices id=\"tv\">",
                source("first", "0 0 1 0 0 1") + source("other", ".5 .5 .75 .5 .5 .75") + "<vertices id=\"tv\">", text);
  return varied("offset=\"1\"/><p>0 0 1 0 2 1</p>",
                "offset=\"1\"/><input semantic=\"TEXCOORD\" source=\"#first\" offset=\"2\" set=\"0\"/>"
                "<input semantic=\"TEXCOORD\" source=\"#other\" offset=\"2\" set=\"3\"/>"
                "<p>0 0 0 1 0 1 2 1 2</p>",
                text);
}

struct Loaded {
  TemporaryFolder folder;
  Scene scene;

  explicit Loaded(const std::string& text, const std::string& name = "scene.dae",
                  const std::vector<std::pair<std::string, std::string>>& files = {{"wood.png", png()}}) {
    write_text(folder.file(name), text);
    for (const auto& [file, bytes] : files) write_text(folder.file(file), bytes);
    scene = load_scene(folder.file(name));
  }
  const Material& material(const std::string& name) const {
    for (const Material& m : scene.materials) {
      if (m.name == name) return m;
    }
    FAIL("no material " << name);
    return scene.materials[0];
  }
  const Mesh& mesh(const std::string& name) const {
    for (const Mesh& m : scene.meshes) {
      if (m.name == name) return m;
    }
    FAIL("no mesh " << name);
    return scene.meshes[0];
  }
};

void check_wood(const Loaded& loaded, const Material& material) {
  REQUIRE(material.texture == 0);
  CHECK(material.kind == Material::Kind::kDiffuse);
  const Texture& texture = loaded.scene.textures[0];
  CHECK(texture.width == 2);
  CHECK(texture.height == 1);
  CHECK(texture.texels == std::vector<uint32_t>{0x0000ff, 0xff0000});
}

std::string error_of_file(const std::string& text, const std::string& name,
                          const std::vector<std::pair<std::string, std::string>>& files = {{"wood.png", png()}}) {
  try {
    const Loaded loaded(text, name, files);
  } catch (const Error& e) {
    const std::string message = e.what();
    CHECK(message.find('\n') == std::string::npos);
    return message.substr(message.rfind('/') + 1);
  }
  return "loaded";
}

}  // namespace

TEST_CASE("textures: COLLADA by sampler and surface, by the image's id, and as 1.5 has it") {
  const Loaded loaded(textured_dae());
  check_wood(loaded, loaded.material("grey"));
  CHECK(loaded.material("grey").reflectance == dvec3(1.0));
  CHECK(loaded.scene.textures[0].name == "wood.png");
  REQUIRE(loaded.mesh("shape").texcoords.size() == 1);
  CHECK(loaded.mesh("shape").texcoords[0] == std::array{dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)});
  CHECK(loaded.mesh("lamp-node").texcoords.empty());

  // A mirroring node turns its triangles' windings around, and what their corners have.
  const Loaded mirrored(varied("<translate>1 2 3</translate>", "<scale>-1 1 1</scale>", textured_dae()));
  const Mesh& mesh = mirrored.mesh("shape");
  for (size_t c = 0; c < 3; ++c) {
    const dvec3& at = mesh.positions[mesh.triangles[0][c]];  // the file's (x, y), which are its coordinates too
    CHECK(mesh.texcoords[0][c] == dvec2(-at.x, at.y));
  }
  CHECK(mesh.texcoords[0][1] == dvec2(0, 1));

  const Loaded by_id(varied("texture=\"samp\"", "texture=\"img\"", textured_dae()));
  check_wood(by_id, by_id.material("grey"));
  const Loaded newer(
      varied("<source>surf</source>", "<instance_image url=\"#img\"/>",
             varied("<init_from>wood.png</init_from>", "<init_from><ref>wood.png</ref></init_from>", textured_dae())));
  check_wood(newer, newer.material("grey"));
}

TEST_CASE("textures: a binding says which of COLLADA's sets of coordinates") {
  const std::string bound = "<instance_material symbol=\"surface\" target=\"#grey\"";
  const auto with_set = [&](const std::string& semantic, int set) {
    return Loaded(varied(bound + "/>",
                         bound + "><bind_vertex_input semantic=\"" + semantic +
                             "\" input_semantic=\"TEXCOORD\" input_set=\"" + std::to_string(set) +
                             "\"/></instance_material>",
                         textured_dae()))
        .mesh("shape")
        .texcoords.at(0)[0];
  };
  CHECK(with_set("UV", 3) == dvec2(0.5, 0.5));
  CHECK(with_set("UV", 0) == dvec2(0, 0));
  CHECK(with_set("another", 3) == dvec2(0, 0));
}

TEST_CASE("textures: pictures are found by name, escapes and paths of other machines, in the scene's folder alone") {
  for (const std::string name : {"./wood.png", "file:///home/someone/wood.png", "C:\\art\\wood.png", "%77ood.png"}) {
    CAPTURE(name);
    const Loaded loaded(textured_dae(name));
    check_wood(loaded, loaded.material("grey"));
  }
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "scene");
  write_text(folder.file("wood.png"), png());
  write_text(folder.file("scene/scene.dae"), textured_dae("../wood.png"));
  const Scene outside = load_scene(folder.file("scene/scene.dae"));
  CHECK(has_notice(outside, "\"../wood.png\" is no file in the scene's folder"));
  CHECK(has_notice(outside, "\"grey\" is rendered as diffuse grey 0.5: its texture is missing"));
  CHECK(outside.textures.empty());
  fs::create_symlink(folder.file("wood.png"), folder.file("scene/wood.png"));
  CHECK(load_scene(folder.file("scene/scene.dae")).textures.empty());
  CHECK(find_own_file(folder.file("scene/scene.dae"), "") == "");
  CHECK(find_own_file(folder.file("scene/scene.dae"), "%00") == "");
}

TEST_CASE("textures: broken references and pictures are errors that say where") {
  CHECK(error_of_file(varied("<source>surf</source>", "<source>x</source>", textured_dae()), "scene.dae")
            .find("refers to \"x\", but no surface <newparam> has that sid") != std::string::npos);
  CHECK(error_of_file(varied("texture=\"samp\"", "texture=\"x\"", textured_dae()), "scene.dae")
            .find("refers to \"x\", but no sampler and no <image> is called so") != std::string::npos);
  CHECK(error_of_file(varied("<init_from>img</init_from>", "<init_from>x</init_from>", textured_dae()), "scene.dae")
            .find("refers to \"x\", but no <image> has that id") != std::string::npos);
  CHECK(error_of_file(textured_dae(" "), "scene.dae").find("names no file in an <init_from>") != std::string::npos);
  CHECK(error_of_file(varied("1 0 1 2 1 2", "1 0 1 2 1 7", textured_dae()), "scene.dae")
            .find("texture coordinate index 7 is out of range: there are 3") != std::string::npos);
  CHECK(error_of_file(textured_dae(), "scene.dae", {{"wood.png", "no picture"}}) ==
        "wood.png: cannot read: damaged picture (unknown image type)");
  CHECK(error_of_file(textured_dae(), "scene.dae", {{"wood.png", png().substr(0, 50)}})
            .starts_with("wood.png: cannot read: damaged picture"));
  std::string vast = png();
  vast.replace(16, 8, std::string("\0\0\x42\x68\0\0\x42\x68", 8));
  CHECK(error_of_file(textured_dae(), "scene.dae", {{"wood.png", vast}}) ==
        "wood.png: cannot read: absurd size 17000x17000");
}

TEST_CASE("textures: OBJ, where Kd multiplies them") {
  const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
  for (const auto& [mtl, reflectance] :
       {std::pair{"newmtl m\nmap_Kd wood.png\n", dvec3(1.0)},
        std::pair{"newmtl m\nKd 0.5 1 0.25\nmap_Kd wood.png\n", dvec3(0.5, 1, 0.25)}}) {
    const Loaded loaded(obj, "a.obj", {{"a.mtl", mtl}, {"wood.png", png()}});
    check_wood(loaded, loaded.material("m"));
    CHECK(loaded.material("m").reflectance == reflectance);
    REQUIRE(loaded.scene.meshes.size() == 1);
    CHECK(loaded.scene.meshes[0].texcoords.at(0) == std::array{dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)});
  }
}

namespace {

// box_gltf with a picture on its floor, whose places are the x and z of the file's normals (0, 1, 0): set 1.
json textured_gltf(const json& image) {
  json gltf = test::box_gltf();
  gltf["images"] = {image};
  gltf["textures"] = {{{"source", 0}}};
  gltf["materials"][2]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 1}};
  json at = gltf["accessors"][1];
  at["type"] = "VEC2";
  gltf["accessors"].push_back(at);
  gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = gltf["accessors"].size() - 1;
  return gltf;
}

const char* const kDataUri =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA"
    "DUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg==";

}  // namespace

TEST_CASE("textures: glTF from a file, a data: URI and a buffer; its v is down") {
  const std::string buffer = test::box_buffer();
  for (const char* uri : {"wood.png", kDataUri}) {
    const Loaded loaded(textured_gltf({{"uri", uri}}).dump(), "a.gltf", {{"wood.png", png()}, {"box.bin", buffer}});
    check_wood(loaded, loaded.material("grey"));
    CHECK(loaded.material("grey").reflectance == dvec3(0.75, 0.5, 0.25));
    // (0, 1), (0, 0) and (1, 0), three corners' normals as pairs, from the top.
    CHECK(loaded.mesh("floor").texcoords.at(0) == std::array{dvec2(0, 0), dvec2(0, 1), dvec2(1, 1)});
    CHECK(loaded.mesh("tilted").texcoords.empty());
  }
  json gltf = textured_gltf({{"bufferView", 2}, {"mimeType", "image/png"}});
  gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", png().size()}});
  gltf["buffers"][0]["byteLength"] = buffer.size() + png().size();
  const Loaded loaded(test::glb(gltf, buffer + png()), "a.glb");
  check_wood(loaded, loaded.material("grey"));
  const Loaded beside(gltf.dump(), "a.gltf", {{"box.bin", buffer + png()}});
  check_wood(beside, beside.material("grey"));
}

TEST_CASE("textures: what glTF may say wrongly of a picture") {
  const std::vector<std::pair<std::string, std::string>> files = {{"wood.png", png()}, {"box.bin", test::box_buffer()}};
  const auto error = [&](const json& gltf) { return error_of_file(gltf.dump(), "a.gltf", files); };
  CHECK(error(textured_gltf({{"uri", "data:image/png,abc"}})) ==
        "a.gltf: images[0].uri is a data: URI without ;base64,");
  CHECK(error(textured_gltf({{"uri", "data:image/png;base64,*"}})).ends_with("is a data: URI that is not base64"));
  CHECK(error(textured_gltf({{"uri", "data:image/png;base64,AAAA"}})).find("image 0: cannot read") !=
        std::string::npos);
  json gltf = textured_gltf({{"uri", "wood.png"}});
  gltf["textures"][0]["source"] = 4;
  CHECK(error(gltf) == "a.gltf: textures[0].source is 4, and there are 1 images");
  gltf = textured_gltf({{"uri", "wood.png"}});
  gltf["accessors"].back()["count"] = 3;
  CHECK(error(gltf).ends_with("TEXCOORD_1 has another length than POSITION"));
  gltf = textured_gltf({{"uri", "gone.png"}});
  const Loaded missing(gltf.dump(), "a.gltf", files);
  CHECK(has_notice(missing.scene, "\"gone.png\" is no file in the scene's folder"));
  CHECK(missing.material("grey").reflectance == 0.5 * dvec3(0.75, 0.5, 0.25));
  gltf = textured_gltf({{"uri", "wood.png"}});
  gltf["textures"][0]["sampler"] = 0;
  gltf["samplers"] = {{{"wrapS", 33071}}};
  CHECK(has_notice(Loaded(gltf.dump(), "a.gltf", files).scene, "not to be repeated"));
}

TEST_CASE("textures: JPEG, and pictures for other renderers are what is rendered") {
  const Loaded loaded(textured_dae());
  Settings settings;
  const ExportedScene mitsuba = export_mitsuba(loaded.scene, settings, "parts");
  CHECK(mitsuba.text.find("<texture type=\"bitmap\" name=\"reflectance\">") != std::string::npos);
  const ExportedScene pbrt = export_pbrt(loaded.scene, settings, "parts");
  CHECK(pbrt.text.find("\"texture reflectance\" \"albedo") != std::string::npos);
  const TemporaryFolder folder;
  bool found = false;
  for (const ExportedFile& file : mitsuba.files) {
    if (!file.path.ends_with(".pfm")) continue;
    found = true;
    write_text(folder.file("albedo.pfm"), file.bytes);
    const Image map = read_image(folder.file("albedo.pfm"));
    CHECK(map.rgb == ZeroedVector<float>{1, 0, 0, 0, 0, 1});
  }
  CHECK(found);
}

}  // namespace lanewise
