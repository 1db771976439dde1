// What a COLLADA file means: geometry, transforms, materials, cameras, lights.
#include <cmath>
#include <numbers>

#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

using glm::dvec3;

bool near(const dvec3& a, const dvec3& b, double tolerance = 1e-12) {
  return glm::length(a - b) <= tolerance * (1 + glm::length(b));
}

const Mesh& mesh_named(const Scene& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name == name) return mesh;
  }
  FAIL(name);
  return scene.meshes[0];
}

dvec3 corner(const Mesh& mesh, size_t triangle, size_t c) { return mesh.positions[mesh.triangles[triangle][c]]; }

dvec3 face_normal(const Mesh& mesh, size_t triangle = 0) {
  const dvec3 p = corner(mesh, triangle, 0);
  return glm::normalize(glm::cross(corner(mesh, triangle, 1) - p, corner(mesh, triangle, 2) - p));
}

// The grey triangle (0 0 0, 1 0 0, 0 1 0) under a transform.
Mesh transformed(const std::string& elements, const std::string& document = kDocument) {
  return mesh_named(load_text(varied("<translate>1 2 3</translate>", elements, document)), "shape");
}

void check_corners(const std::string& elements, const dvec3& a, const dvec3& b, const dvec3& c) {
  CAPTURE(elements);
  const Mesh mesh = transformed(elements);
  CHECK(near(corner(mesh, 0, 0), a));
  CHECK(near(corner(mesh, 0, 1), b));
  CHECK(near(corner(mesh, 0, 2), c));
}

// The document with other primitives in the place of the grey triangle's, over 6 vertices.
Scene with_primitives(const std::string& primitives) {
  std::string document = varied(
      "<triangles material=\"surface\" count=\"1\"><input semantic=\"VERTEX\" source=\"#tv\" offset=\"0\"/><input "
      "semantic=\"NORMAL\" source=\"#tn\" offset=\"1\"/><p>0 0 1 0 2 1</p></triangles>",
      primitives);
  document = varied("\"tpa\" count=\"9\">0 0 0 1 0 0 0 1 0<",
                    "\"tpa\" count=\"18\">0 0 0 2 0 0 2 2 0 0 2 0 -1 1 0 1 1 5<", document);
  return load_text(varied("#tpa\" count=\"3\"", "#tpa\" count=\"6\"", document));
}

const std::string kVertexInput = "<input semantic=\"VERTEX\" source=\"#tv\" offset=\"0\"/>";

TEST_CASE("collada: the document that the tests vary") {
  const Scene scene = load_text(kDocument);
  CHECK(scene.triangle_count() == 2);
  REQUIRE(scene.spheres.size() == 1);
  CHECK(scene.spheres[0].center == dvec3(5, 0, 0));
  CHECK(scene.spheres[0].radius == 0.5);
  CHECK(scene.materials[scene.spheres[0].material].reflectance == dvec3(0.5));
  CHECK(has_notice(scene, "has no material"));
  const Mesh& shape = mesh_named(scene, "shape");
  CHECK(scene.materials[shape.material].name == "grey");
  CHECK(scene.materials[shape.material].kind == Material::Kind::kDiffuse);
  CHECK(scene.materials[shape.material].reflectance == dvec3(0.25, 0.5, 0.75));
  const Material& glow = scene.materials[mesh_named(scene, "lamp-node").material];
  CHECK(glow.kind == Material::Kind::kEmission);
  CHECK(glow.radiance == dvec3(3, 2, 1));
  const Bounds box = bounds(scene);
  CHECK(box.lo == dvec3(0, -0.5, -0.5));
  CHECK(box.hi == dvec3(5.5, 3, 5));
}

TEST_CASE("collada: normals are of unit length, or the face's where the file has none") {
  const Mesh mesh = transformed("<translate>1 2 3</translate>");
  REQUIRE(mesh.normals.size() == 1);
  for (const dvec3& n : mesh.normals[0]) CHECK(n == dvec3(0, 0, 1));  // the third one is 0 0 0 in the file
  CHECK(mesh_named(load_text(kDocument), "lamp-node").normals.empty());
  // A normal leans against a stretch.
  const std::string leaning = varied("count=\"6\">0 0 2 ", "count=\"6\">1 0 1 ");
  CHECK(near(transformed("<scale>2 1 1</scale>", leaning).normals[0][0], glm::normalize(dvec3(0.5, 0, 1))));
  CHECK(near(transformed("<scale>2 1 1</scale>", leaning).normals[0][2], dvec3(0, 0, 1)));
}

TEST_CASE("collada: normals may belong to vertices") {
  std::string document =
      varied("<input semantic=\"POSITION\" source=\"#tp\"/>",
             "<input semantic=\"POSITION\" source=\"#tp\"/><input semantic=\"NORMAL\" source=\"#tn\"/>");
  document =
      varied("<input semantic=\"NORMAL\" source=\"#tn\" offset=\"1\"/><p>0 0 1 0 2 1</p>", "<p>0 1 2</p>", document);
  CHECK(error_of(document).find("fewer normals than positions") != std::string::npos);
  document = varied("count=\"6\">0 0 2 0 0 0<", "count=\"9\">0 0 1 0 1 0 1 0 0<", document);
  document = varied("#tna\" count=\"2\"", "#tna\" count=\"3\"", document);
  const Mesh mesh = transformed("", document);
  CHECK(mesh.normals[0][0] == dvec3(0, 0, 1));
  CHECK(mesh.normals[0][1] == dvec3(0, 1, 0));
  CHECK(mesh.normals[0][2] == dvec3(1, 0, 0));
}

TEST_CASE("collada: every transform element, and their order") {
  check_corners("", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  check_corners("<translate>1 2 3</translate>", {1, 2, 3}, {2, 2, 3}, {1, 3, 3});
  check_corners("<rotate>0 0 7 90</rotate>", {0, 0, 0}, {0, 1, 0}, {-1, 0, 0});
  check_corners("<rotate>1 1 1 120</rotate>", {0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  check_corners("<rotate>0 1 0 -30</rotate>", {0, 0, 0}, {std::sqrt(0.75), 0, 0.5}, {0, 1, 0});
  check_corners("<scale>2 3 4</scale>", {0, 0, 0}, {2, 0, 0}, {0, 3, 0});
  check_corners("<matrix>0 -1 0 5 2 0 0 6 0 0 1 7 0 0 0 1</matrix>", {5, 6, 7}, {5, 8, 7}, {4, 6, 7});
  check_corners("<lookat>1 2 3 0 2 3 0 0 1</lookat>", {1, 2, 3}, {1, 3, 3}, {1, 2, 4});
  check_corners("<skew>45 0 1 0 1 0 0</skew>", {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  check_corners("<translate>1 0 0</translate><scale>2 2 2</scale>", {1, 0, 0}, {3, 0, 0}, {1, 2, 0});
  check_corners("<scale>2 2 2</scale><translate>1 0 0</translate>", {2, 0, 0}, {4, 0, 0}, {2, 2, 0});
  check_corners("<scale>1e-200 1e-200 1e-200</scale><scale>1e200 1e200 1e200</scale>", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  // Axes at 60 degrees: the skewed axis is turned by the angle, and volume stays.
  const Mesh skewed = transformed("<skew>20 0 1 0 0.8660254037844386 0.5 0</skew>");
  const dvec3 y = glm::normalize(corner(skewed, 0, 2));
  CHECK(std::acos(y.y) * 180 / std::numbers::pi == doctest::Approx(20));
  CHECK(y.x > 0);
  CHECK(glm::length(glm::cross(corner(skewed, 0, 1), corner(skewed, 0, 2))) == doctest::Approx(1));
}

TEST_CASE("collada: quarter turns are exact") {
  for (const char* angle : {"90", "-270", "450"}) {
    const Mesh mesh = transformed("<rotate>0 0 1 " + std::string(angle) + "</rotate>");
    CHECK(corner(mesh, 0, 1) == dvec3(0, 1, 0));
    CHECK(corner(mesh, 0, 2) == dvec3(-1, 0, 0));
  }
  CHECK(corner(transformed("<rotate>1 0 0 180</rotate>"), 0, 2) == dvec3(0, -1, 0));
}

TEST_CASE("collada: mirrored transforms keep the front in front") {
  const Mesh mesh = transformed("<scale>-1 1 1</scale>");
  CHECK(face_normal(mesh) == dvec3(0, 0, 1));
  CHECK(mesh.normals[0][0] == dvec3(0, 0, 1));
  const Mesh below = transformed("<scale>1 1 -1</scale>");
  CHECK(face_normal(below) == dvec3(0, 0, -1));
  CHECK(below.normals[0][0] == dvec3(0, 0, -1));
  CHECK(face_normal(transformed("<scale>-1 -1 -1</scale>")) == dvec3(0, 0, -1));
}

TEST_CASE("collada: nested nodes, instanced nodes and several geometries in one") {
  const std::string inner =
      "<translate>1 0 0</translate><node id=\"inner\"><scale>2 2 2</scale>"
      "<instance_geometry url=\"#lamp\"/><instance_geometry url=\"#lamp\"/></node>";
  Scene scene = load_text(varied("<translate>1 2 3</translate>", inner));
  CHECK(scene.triangle_count() == 4);
  CHECK(corner(mesh_named(scene, "inner"), 0, 0) == dvec3(1, 0, 10));
  std::string document =
      varied("<node id=\"spare\"/>",
             "<node id=\"spare\"><translate>0 0 1</translate><instance_geometry url=\"#ball\"/></node>");
  document = varied("<translate>1 2 3</translate>",
                    "<scale>3 3 3</scale><instance_node url=\"#spare\"/><instance_node url=\"#spare\"/>", document);
  scene = load_text(document);
  REQUIRE(scene.spheres.size() == 3);
  CHECK(near(scene.spheres[0].center, {0, 0, 3}));
  CHECK(scene.spheres[0].radius == doctest::Approx(1.5));
}

TEST_CASE("collada: spheres take rotations, reflections and even scales") {
  const Scene scene = load_text(varied("<translate>5 0 0</translate>",
                                       "<rotate>1 2 3 40</rotate><scale>-2 2 2</scale><translate>1 0 0</translate>"));
  CHECK(scene.spheres[0].radius == doctest::Approx(1));
  CHECK(glm::length(scene.spheres[0].center) == doctest::Approx(2));
}

TEST_CASE("collada: axes and unit") {
  const auto shape = [](const std::string& asset) {
    return corner(
        mesh_named(load_text(varied("<unit name=\"meter\" meter=\"1\"/><up_axis>Z_UP</up_axis>", asset)), "shape"), 0,
        0);
  };
  CHECK(near(shape("<up_axis>Z_UP</up_axis>"), {1, 2, 3}));
  CHECK(near(shape("<up_axis> Y_UP </up_axis>"), {1, -3, 2}));
  CHECK(near(shape(""), {1, -3, 2}));
  CHECK(near(shape("<up_axis>X_UP</up_axis>"), {-2, -3, 1}));
  CHECK(near(shape("<unit meter=\"0.01\" name=\"centimeter\"/><up_axis>Z_UP</up_axis>"), {0.01, 0.02, 0.03}));
  CHECK(load_text(varied("meter=\"1\"", "meter=\"0.01\"")).spheres[0].radius == doctest::Approx(0.005));
}

TEST_CASE("collada: primitives") {
  const std::string start = " material=\"surface\" count=\"";
  CHECK(with_primitives("<triangles" + start + "2\">" + kVertexInput + "<p>0 1 2 0 2 3</p></triangles>")
            .triangle_count() == 3);
  const Scene list = with_primitives("<polylist" + start + "2\">" + kVertexInput +
                                     "<vcount>4 5</vcount><p>0 1 2 3 0 1 2 3 4</p></polylist>");
  CHECK(list.triangle_count() == 1 + 2 + 3);
  const Mesh& fans = mesh_named(list, "shape");
  for (size_t i = 0; i < fans.triangles.size(); ++i) CHECK(face_normal(fans, i) == dvec3(0, 0, 1));
  const Scene polygons = with_primitives("<polygons" + start + "2\">" + kVertexInput +
                                         "<p>0 1 2 3</p><ph><p>0 1 2</p><h>0 1 3</h></ph></polygons>");
  CHECK(polygons.triangle_count() == 1 + 2 + 1);
  CHECK(has_notice(polygons, "holes"));
  const Scene strip = with_primitives("<tristrips" + start + "1\">" + kVertexInput + "<p>0 1 3 2 5</p></tristrips>");
  CHECK(strip.triangle_count() == 1 + 3);
  CHECK(face_normal(mesh_named(strip, "shape"), 0) == dvec3(0, 0, 1));
  CHECK(face_normal(mesh_named(strip, "shape"), 1) == dvec3(0, 0, 1));
  CHECK(with_primitives("<trifans" + start + "2\">" + kVertexInput + "<p>0 1 2 3</p><p>0 1 2</p></trifans>")
            .triangle_count() == 4);
  const Scene lines = with_primitives("<lines" + start + "1\">" + kVertexInput + "<p>0 1</p></lines>");
  CHECK(lines.triangle_count() == 1);
  CHECK(has_notice(lines, "lines"));
}

TEST_CASE("collada: a mesh keeps only the vertices of its own primitives") {
  const std::string input = "\"surface\" count=\"1\">" + kVertexInput;
  const Scene scene =
      with_primitives("<triangles material=" + input + "<p>0 1 2</p></triangles><triangles material=" + input +
                      "<p>3 2 0</p></triangles>");
  REQUIRE(scene.meshes.size() == 3);
  CHECK(scene.meshes[1].positions.size() == 3);
  CHECK(corner(scene.meshes[2], 0, 0) == dvec3(1, 4, 3));
}

TEST_CASE("collada: input offsets, strides, accessor offsets and unnamed parameters") {
  std::string document = varied("count=\"9\">0 0 0 1 0 0 0 1 0<", "count=\"17\">9 9 0 7 0 0 8 1 7 0 0 8 0 7 1 0 8<");
  document = varied("<accessor source=\"#tpa\" count=\"3\" stride=\"3\"/>",
                    "<accessor source=\"#tpa\" offset=\"2\" count=\"3\" stride=\"5\"><param name=\"X\" "
                    "type=\"float\"/><param type=\"float\"/>"
                    "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>",
                    document);
  document = varied("source=\"#tv\" offset=\"0\"", "source=\"#tv\" offset=\"3\"", document);
  document = varied("<p>0 0 1 0 2 1</p>", "<p>9 0 9 0 9 0 9 1 9 1 9 2</p>", document);
  const Mesh mesh = transformed("", document);
  CHECK(corner(mesh, 0, 1) == dvec3(1, 0, 0));
  CHECK(corner(mesh, 0, 2) == dvec3(0, 1, 0));
}

TEST_CASE("collada: numbers in all their forms, comments among them, and CDATA") {
  const Mesh mesh = transformed("", varied("0 0 0 1 0 0 0 1 0</float",
                                           "0.0 -0\n\t+0 <!-- one -->1e0 1e-999 0.<![CDATA[ .0E5 10.0e-1 ]]>0</float"));
  CHECK(corner(mesh, 0, 1) == dvec3(1, 0, 0));
  CHECK(corner(mesh, 0, 2) == dvec3(0, 1, 0));
}

TEST_CASE("collada: unknown elements and a byte order mark mean nothing") {
  CHECK(load_text("\xEF\xBB\xBF" + kDocument).triangle_count() == 2);
  CHECK(load_text(varied("<library_nodes>",
                         "<library_force_fields><force_field id=\"tri\"/></library_force_fields><library_nodes>"))
            .triangle_count() == 2);
}

TEST_CASE("collada: cameras") {
  const auto camera = [](const std::string& optics) {
    return load_text(varied("<xfov>60</xfov><aspect_ratio>1.5</aspect_ratio>", optics)).cameras.at(0);
  };
  const double degree = std::numbers::pi / 180;
  CHECK(camera("<xfov>60</xfov><aspect_ratio>1.5</aspect_ratio>").xfov == doctest::Approx(60 * degree));
  CHECK(camera("<xfov>60</xfov><aspect_ratio>1.5</aspect_ratio>").aspect == 1.5);
  CHECK(camera("<xfov>60</xfov>").aspect == doctest::Approx(4.0 / 3));
  CHECK(std::tan(camera("<yfov>60</yfov>").xfov / 2) == doctest::Approx(4.0 / 3 * std::tan(30 * degree)));
  CHECK(std::tan(camera("<yfov>60</yfov><aspect_ratio>2</aspect_ratio>").xfov / 2) ==
        doctest::Approx(2 * std::tan(30 * degree)));
  CHECK(camera("<xfov>90</xfov><yfov>60</yfov>").aspect == doctest::Approx(std::sqrt(3.0)));
  const Camera placed =
      load_text(
          varied("<node id=\"camera-node\">",
                 "<node id=\"camera-node\"><translate>0 -5 1</translate><rotate>1 0 0 90</rotate><scale>3 3 3</scale>"))
          .cameras.at(0);
  CHECK(near(dvec3(placed.to_world[3]), {0, -5, 1}));
  CHECK(near(-dvec3(placed.to_world[2]), {0, 1, 0}));
  CHECK(near(dvec3(placed.to_world[1]), {0, 0, 1}));
}

Material cgl(const std::string& element, const std::string& notice = "") {
  const Scene scene =
      load_text(varied("</profile_COMMON></effect>", "</profile_COMMON><extra><technique profile=\"CGL\">" + element +
                                                         "</technique></extra></effect>"));
  if (!notice.empty()) CHECK(has_notice(scene, notice));
  return scene.materials[mesh_named(scene, "shape").material];
}

TEST_CASE("collada: CGL materials") {
  CHECK(cgl("<mirror><reflectance>.9 .8 .7</reflectance></mirror>").kind == Material::Kind::kMirror);
  CHECK(cgl("<mirror><reflectance>.9 .8 .7</reflectance></mirror>").reflectance == dvec3(.9, .8, .7));
  CHECK(cgl("<mirror/>").reflectance == dvec3(1.0));
  for (const char* name : {"glass", "refraction"}) {
    const Material glass = cgl("<" + std::string(name) +
                               "><reflectance>.9 1 1</reflectance><transmittance>.8 1 1</transmittance>"
                               "<roughness>0</roughness><ior>1.45</ior></" +
                               name + ">");
    CHECK(glass.kind == Material::Kind::kGlass);
    CHECK(glass.reflectance == dvec3(.9, 1, 1));
    CHECK(glass.transmittance == dvec3(.8, 1, 1));
    CHECK(glass.ior == 1.45);
  }
  CHECK(cgl("<glass><ior>2</ior><roughness>.3</roughness></glass>").transmittance == dvec3(1.0));
  CHECK(cgl("<glass><ior>2</ior><roughness>.3</roughness></glass>").roughness == 0.3);
  const Material metal = cgl("<microfacet><alpha>.25</alpha><eta>.2 .4 1.3</eta><k>3 2 1</k></microfacet>");
  CHECK(metal.kind == Material::Kind::kMicrofacet);
  CHECK(metal.alpha == 0.25);
  CHECK(metal.eta == dvec3(.2, .4, 1.3));
  CHECK(metal.k == dvec3(3, 2, 1));
  CHECK(cgl("<emission><radiance>10 9 8</radiance></emission>").radiance == dvec3(10, 9, 8));
  CHECK(cgl("<diffuse><albedo>.1 .2 .3</albedo></diffuse>").reflectance == dvec3(.1, .2, .3));
  CHECK(cgl("<lambertian><reflectance>.1 .2 .3</reflectance></lambertian>").kind == Material::Kind::kDiffuse);
}

Material common(const std::string& shader, const std::string& notice = "") {
  const Scene scene = load_text(varied("<lambert><diffuse><color>0.25 0.5 0.75 1</color></diffuse></lambert>", shader));
  if (!notice.empty()) CHECK(has_notice(scene, notice));
  return scene.materials[mesh_named(scene, "shape").material];
}

TEST_CASE("collada: common materials") {
  for (const std::string name : {"phong", "lambert", "blinn", "constant"}) {
    CHECK(common("<" + name +
                 "><emission><color>0 0 0 1</color></emission><diffuse><color>.1 .2 .3</color></diffuse></" + name +
                 ">")
              .reflectance == dvec3(.1, .2, .3));
  }
  CHECK(common("<phong><emission><color>4 5 6 1</color></emission></phong>").radiance == dvec3(4, 5, 6));
  CHECK(common("<phong/>").reflectance == dvec3(0.0));
  CHECK(common("", "no common profile").reflectance == dvec3(0.5));
  const std::string param = "<lambert><diffuse><param ref=\"tone\"/></diffuse></lambert>";
  const std::string document = varied("<lambert><diffuse><color>0.25 0.5 0.75 1</color></diffuse></lambert>", param);
  CHECK(error_of(document).find("\"tone\"") != std::string::npos);
  const Scene scene =
      load_text(varied("<effect id=\"grey-fx\">",
                       "<effect id=\"grey-fx\"><newparam sid=\"tone\"><float3>.4 .5 .6</float3></newparam>", document));
  CHECK(scene.materials[mesh_named(scene, "shape").material].reflectance == dvec3(.4, .5, .6));
}

TEST_CASE("collada: a symbol without a binding is a material's id, a mesh without a symbol takes what is bound") {
  std::string document = varied("material=\"surface\"", "material=\"grey\"");
  document = varied("symbol=\"surface\"", "symbol=\"other\"", document);
  CHECK(load_text(document).materials[mesh_named(load_text(document), "shape").material].name == "grey");
  const Scene scene = load_text(varied("material=\"surface\"", ""));
  CHECK(scene.materials[mesh_named(scene, "shape").material].name == "grey");
}

// The document's light, made a CGL area light, in a node with these transforms.
Scene with_area_light(const std::string& transforms) {
  const std::string document = varied("</technique_common></light>",
                                      "</technique_common><extra><technique profile=\"CGL\"><area><color>7 8 "
                                      "9</color></area></technique></extra></light>");
  return load_text(varied("<node id=\"shape\">",
                          "<node id=\"l\">" + transforms + "<instance_light url=\"#sun\"/></node><node id=\"shape\">",
                          document));
}

TEST_CASE("collada: an area light that stands alone is a square that emits towards -z") {
  const Scene scene = with_area_light("<translate>9 9 9</translate><scale>0.6 0.8 1</scale>");
  const Mesh& light = mesh_named(scene, "sun");
  CHECK(scene.materials[light.material].kind == Material::Kind::kEmission);
  CHECK(scene.materials[light.material].radiance == dvec3(7, 8, 9));
  REQUIRE(light.triangles.size() == 2);
  Bounds box;
  for (const dvec3& p : light.positions) box.add(p);
  CHECK(near(box.lo, {8.7, 8.6, 9}));
  CHECK(near(box.hi, {9.3, 9.4, 9}));
  for (size_t i = 0; i < 2; ++i) CHECK(near(face_normal(light, i), {0, 0, -1}));
  const Scene mirrored = with_area_light("<translate>9 9 9</translate><scale>-1 1 1</scale>");
  CHECK(near(face_normal(mesh_named(mirrored, "sun")), {0, 0, -1}));
}

TEST_CASE("collada: an area light on an emissive mesh is dropped") {
  const Scene scene = with_area_light("<translate>0.3 0.3 5.001</translate><scale>0.6 0.8 1</scale>");
  CHECK(scene.meshes.size() == 2);
  CHECK(has_notice(scene, "area light \"sun\" overlaps the emissive mesh \"lamp-node\""));
  // On a mesh that does not emit it stays.
  CHECK(with_area_light("<translate>1.3 2.3 3.001</translate>").meshes.size() == 3);
}

TEST_CASE("collada: other lights are skipped with a notice") {
  const Scene scene = load_text(varied("<translate>1 2 3</translate>", "<instance_light url=\"#sun\"/>"));
  CHECK(has_notice(scene, "light \"sun\" is not an area light"));
}

}  // namespace
}  // namespace lanewise
