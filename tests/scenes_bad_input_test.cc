// Broken scene files: one clear line each, and soon.
#include <chrono>

#include "tests/scenes_harness.h"

namespace lanewise {
namespace {

void check_error(const std::string& document, const std::string& keyword) {
  const auto start = std::chrono::steady_clock::now();
  const std::string message = error_of(document);
  CAPTURE(keyword);
  CAPTURE(message);
  CHECK(message.find(keyword) != std::string::npos);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

void check_varied(const std::string& from, const std::string& to, const std::string& keyword) {
  check_error(varied(from, to), keyword);
}

std::string repeated(const std::string& text, size_t times) {
  std::string all;
  for (size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST_CASE("scenes: files that are no scene") {
  CHECK_THROWS_WITH_AS(load_scene("no/such/file.dae"), "no/such/file.dae: no such file", Error);
  const std::string folder = std::filesystem::temp_directory_path().string();
  CHECK_THROWS_WITH_AS(load_scene(folder), (folder + ": is a directory, not a scene file").c_str(), Error);
  CHECK_THROWS_WITH_AS(load_scene("/dev/null"), "/dev/null: is not a readable file", Error);
  CHECK(error_of(kDocument, ".fbx").find("unknown scene format \".fbx\"") != std::string::npos);
  CHECK(error_of("", ".dae").find("is empty") != std::string::npos);
  check_error("just some words", "not well-formed XML");
  check_error(std::string("\x7F"
                          "ELF\0\1\2",
                          7),
              "not UTF-8");
  check_error("<!DOCTYPE html><html><head><meta charset=utf-8></head></html>", "HTML");
  check_error("<html><body>404 not found</body></html>", "root element is \"html\"");
  for (const size_t size : {size_t{100}, size_t{500}, size_t{1000}, size_t{2000}, kDocument.size() - 20}) {
    check_error(kDocument.substr(0, size), "truncated");
  }
}

TEST_CASE("scenes: an unreadable file") {
  const TemporaryFile file(kDocument);
  std::filesystem::permissions(file.path(), std::filesystem::perms::none);
  if (std::ifstream(file.path())) return;  // a superuser may read all
  CHECK_THROWS_WITH_AS(load_scene(file.path()), (file.path() + ": cannot be opened: Permission denied").c_str(), Error);
}

TEST_CASE("scenes: errors name the line, the element and its id") {
  CHECK(error_of(varied("0 0 0 1 0 0 0 1 0</float", "0 0 0\n\n1 zero 0 0 1 0</float")) ==
        ":26: <float_array> \"tpa\": \"zero\" is not a number");
  CHECK(error_of(varied("url=\"#grey-fx\"", "url=\"#grey\"")) ==
        ":13: <instance_effect> in material \"grey\": refers to \"#grey\", but no <effect> has that id");
}

TEST_CASE("scenes: nothing to render") {
  check_error("<COLLADA/>", "no <visual_scene>");
  check_varied("<node id=\"camera-node\"><instance_camera url=\"#cam\"/></node>", "", "no camera");
  CHECK_THROWS_AS(check_light(load_text(varied("3 2 1</radiance>", "0 0 0</radiance>"))), Error);
  std::string empty = varied("<instance_geometry url=\"#lamp\"/>", "");
  empty = varied("<instance_geometry url=\"#ball\"/>", "", empty);
  empty = varied("<node id=\"shape\">",
                 "<node id=\"shape\"/><node id=\"elsewhere\"/></visual_scene><visual_scene><node>", empty);
  check_error(empty, "no geometry");
}

TEST_CASE("scenes: broken references") {
  check_varied("target=\"#grey\"", "target=\"#gray\"", "no <material> has that id");
  check_varied("target=\"#grey\"", "target=\"grey\"", "must begin with #");
  check_varied("target=\"#grey\"", "", "has no attribute target");
  check_varied("symbol=\"surface\"", "symbol=\"other\"", "\"surface\" is bound to no material");
  check_varied("url=\"#grey-fx\"", "url=\"#nothing\"", "no <effect> has that id");
  check_varied("<instance_effect url=\"#grey-fx\"/>", "", "no <instance_effect>");
  check_varied("url=\"#tri\"", "url=\"other.dae#tri\"", "must begin with #");
  check_varied("url=\"#tri\"", "url=\"#cam\"", "no <geometry> has that id");
  check_varied("url=\"#cam\"", "url=\"#tri\"", "no <camera> has that id");
  check_varied("url=\"#vs\"", "url=\"#vz\"", "no <visual_scene> has that id");
  check_varied("source=\"#tv\"", "source=\"#lv\"", "refers to another mesh");
  check_varied("source=\"#tv\"", "source=\"#tp\"", "no <vertices> has that id");
  check_varied("source=\"#tp\"", "source=\"#tx\"", "no <source> has that id");
  check_varied("source=\"#tn\"", "source=\"#tx\"", "no <source> has that id");
  check_varied("source=\"#tpa\"", "source=\"#tx\"", "no <float_array> has that id");
  check_varied("<technique_common><accessor source=\"#tpa\" count=\"3\" stride=\"3\"/></technique_common>", "",
               "no <accessor>");
  check_varied("<vertices id=\"tv\"><input semantic=\"POSITION\" source=\"#tp\"/></vertices>", "", "no <vertices>");
  check_varied("<input semantic=\"POSITION\" source=\"#tp\"/>", "", "no input POSITION");
  check_varied("<input semantic=\"VERTEX\" source=\"#tv\" offset=\"0\"/>", "", "no input VERTEX");
  check_varied("<node id=\"spare\"/>", "<node id=\"spare\"><instance_geometry url=\"#none\"/></node>", "loaded");
  check_varied("<translate>1", "<instance_light url=\"#moon\"/><translate>1", "no <light> has that id");
  check_varied("<translate>1", "<instance_node url=\"#moon\"/><translate>1", "no <node> has that id");
}

TEST_CASE("scenes: counts and indices") {
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 1 0 3 1</p>", "vertex index 3 is out of range: there are 3");
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 1 2 2 1</p>", "normal index 2 is out of range: there are 2");
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 -1 0 2 1</p>", "\"-1\" is not an index");
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 1.5 0 2 1</p>", "\"1.5\" is not an index");
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 4294967296 0 2 1</p>", "out of range");
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 99999999999999999999999 0 2 1</p>", "out of range");
  check_varied("<p>0 0 1 0 2 1</p>", "<p>0 0 1 0 2</p>", "not a multiple of 6");
  check_varied("<p>0 0 1 0 2 1</p>", "", "claims 1 primitives, has 0");
  check_varied("count=\"1\"><input semantic=\"VERTEX\" source=\"#tv\"",
               "count=\"x\"><input semantic=\"VERTEX\" source=\"#tv\"", "not a whole number");
  check_varied("source=\"#tn\" offset=\"1\"", "source=\"#tn\" offset=\"18446744073709551615\"", "offset");
  check_varied("id=\"tpa\" count=\"9\"", "id=\"tpa\" count=\"12\"", "claims 12 numbers, has 9");
  check_varied("id=\"tpa\" count=\"9\"", "id=\"tpa\" count=\"1000000000000\"", "claims 1000000000000 numbers, has 9");
  check_varied("id=\"tpa\" count=\"9\"", "id=\"tpa\" count=\"99999999999999999999\"", "not a whole number");
  check_varied("source=\"#tpa\" count=\"3\"", "source=\"#tpa\" count=\"4\"", "reach beyond");
  check_varied("source=\"#tpa\" count=\"3\"", "source=\"#tpa\" count=\"1000000000000\"", "reach beyond");
  check_varied("source=\"#tpa\" count=\"3\"", "source=\"#tpa\" count=\"18446744073709551615\"", "reach beyond");
  check_varied("source=\"#tpa\" count=\"3\"", "source=\"#tpa\" offset=\"18446744073709551615\" count=\"3\"",
               "reach beyond");
  check_varied("source=\"#tpa\" count=\"3\"", "source=\"#tpa\"", "has no attribute count");
  check_varied("count=\"3\" stride=\"3\"", "count=\"3\" stride=\"0\"", "stride is too short");
  check_varied("count=\"3\" stride=\"3\"", "count=\"3\" stride=\"18446744073709551615\"", "reach beyond");
  const std::string list = "<polylist count=\"1\"><input semantic=\"VERTEX\" source=\"#tv\"/>";
  check_varied("<triangles material=\"surface\"",
               list + "<vcount>4</vcount><p>0 1 2</p></polylist><triangles material=\"surface\"",
               "asks for 4 vertices, <p> has 3");
  check_varied("<triangles material=\"surface\"",
               list + "<vcount>4294967295</vcount><p>0 1 2</p></polylist><triangles material=\"surface\"",
               "asks for 4294967295");
  check_varied("<triangles material=\"surface\"",
               list + "<vcount>2</vcount><p>0 1</p></polylist><triangles material=\"surface\"",
               "polygon of 2 vertices");
  check_varied("<triangles material=\"surface\"",
               list + "<vcount>3 3</vcount><p>0 1 2 0 1 2</p></polylist><triangles material=\"surface\"",
               "claims 1 primitives, has 2");
}

TEST_CASE("scenes: numbers") {
  for (const char* word : {"word", "1,5", "0x10", "1e", "--1", "+-1", "1.0.0"}) {
    check_varied("0 0 0 1 0 0 0 1 0</float", "0 0 0 1 " + std::string(word) + " 0 0 1 0</float", "is not a number");
  }
  for (const char* huge : {"nan", "NaN", "INF", "-inf", "1e999", "-1e400", "1e99999999999"}) {
    check_varied("0 0 0 1 0 0 0 1 0</float", "0 0 0 1 " + std::string(huge) + " 0 0 1 0</float",
                 "is not a finite number");
  }
  check_varied("0 0 0 1 0 0 0 1 0</float", "0 0 0 1e16 0 0 0 1 0</float", "above 1e15");
  check_varied("<translate>1 2 3</translate>", "<scale>1e200 1e200 1e200</scale><scale>1e200 1e200 1e200</scale>",
               "too large");
}

TEST_CASE("scenes: transforms") {
  const auto transform = [](const std::string& element, const std::string& keyword) {
    check_varied("<translate>1 2 3</translate>", element, keyword);
  };
  transform("<matrix>1 0 0 0 0 1 0 0 0 0 1 0</matrix>", "16 numbers expected, not 12");
  transform("<matrix>1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1</matrix>", "singular");
  transform("<matrix>1 2 3 0 2 4 6 0 0 0 1 0 0 0 0 1</matrix>", "singular");
  transform("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0</matrix>", "last row");
  transform("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 x</matrix>", "\"x\" is not a number");
  transform("<scale>1 0 1</scale>", "singular");
  transform("<translate>1 2</translate>", "3 numbers expected, not 2");
  transform("<rotate>0 0 0 90</rotate>", "no direction");
  transform("<rotate>0 0 1</rotate>", "4 numbers expected");
  transform("<lookat>1 1 1 1 1 1 0 0 1</lookat>", "no direction");
  transform("<lookat>0 0 0 0 0 1 0 0 1</lookat>", "no direction");
  transform("<skew>90 1 0 0 0 1 0</skew>", "singular");
  transform("<skew>10 1 0 0 1 0 0</skew>", "singular");
  check_varied("<translate>5 0 0</translate>", "<scale>1 1 1.01</scale>", "scales a sphere unevenly");
  check_varied("<translate>5 0 0</translate>", "<skew>10 1 0 0 0 1 0</skew>", "scales a sphere unevenly");
  check_varied("meter=\"1\"", "meter=\"0\"", "a unit of \"0\" metres");
  check_varied("meter=\"1\"", "meter=\"inch\"", "not a finite number");
  check_varied("Z_UP", "W_UP", "none of X_UP, Y_UP and Z_UP");
}

TEST_CASE("scenes: values out of range") {
  for (const char* radius : {"0", "-1", "nan", "", "1 2"}) {
    check_varied("<radius>.5</radius>", "<radius>" + std::string(radius) + "</radius>",
                 "<radius> in geometry \"ball\"");
  }
  check_varied("<radius>.5</radius>", "", "no <radius>");
  for (const char* fov : {"0", "-20", "180", "400"}) {
    check_varied("<xfov>60", "<xfov>" + std::string(fov), "between 0 and 180");
  }
  check_varied("<xfov>60", "<xfov>179.99999999", "too close to 0 or 180");
  check_varied("<xfov>60</xfov>", "", "neither");
  check_varied("<aspect_ratio>1.5", "<aspect_ratio>0", "between 0.001 and 1000");
  check_error(varied("<perspective>", "<orthographic>", varied("</perspective>", "</orthographic>")), "orthographic");
  check_varied("<color>0.25", "<color>1.25", "between 0 and 1");
  check_varied("<color>0.25", "<color>-0.25", "between 0 and 1");
  check_varied("<color>0.25 0.5 0.75 1", "<color>0.25 0.5", "3 numbers");
  check_varied("<radiance>3", "<radiance>-3", "negative");
  check_varied("<radiance>3 2 1</radiance>", "", "no <radiance>");
  const auto cgl = [](const std::string& element, const std::string& keyword) {
    check_varied("</profile_COMMON></effect>",
                 "</profile_COMMON><extra><technique profile=\"CGL\">" + element + "</technique></extra></effect>",
                 keyword);
  };
  cgl("<velvet/>", "<velvet> in effect \"grey-fx\": unknown CGL material");
  cgl("<glass><ior>0</ior></glass>", "above 0");
  cgl("<glass><ior>-1.5</ior></glass>", "above 0");
  cgl("<glass/>", "no <ior>");
  cgl("<glass><ior>1.5</ior><roughness>-1</roughness></glass>", "must be between 0 and 1000");
  cgl("<glass><ior>1.5</ior><transmittance>1 1 2</transmittance></glass>", "between 0 and 1");
  cgl("<mirror><reflectance>1 1 1.5</reflectance></mirror>", "between 0 and 1");
  cgl("<microfacet><alpha>0</alpha><eta>1 1 1</eta><k>1 1 1</k></microfacet>", "above 0");
  cgl("<microfacet><alpha>-.1</alpha><eta>1 1 1</eta><k>1 1 1</k></microfacet>", "above 0");
  cgl("<microfacet><alpha>1e-60</alpha><eta>1 1 1</eta><k>1 1 1</k></microfacet>", "above 0");
  cgl("<microfacet><alpha>.1</alpha><eta>1 0 1</eta><k>1 1 1</k></microfacet>", "above 0");
  cgl("<microfacet><alpha>.1</alpha><eta>1 1 1</eta><k>1 -1 1</k></microfacet>", "negative");
  cgl("<microfacet><alpha>.1</alpha><eta>1 1 1</eta></microfacet>", "no <k>");
}

TEST_CASE("scenes: nodes without end") {
  check_varied("<translate>1 2 3</translate>", "<instance_node url=\"#shape\"/>", "contains itself");
  check_error(
      varied("<translate>1 2 3", "<instance_node url=\"#spare\"/><translate>1 2 3",
             varied("<node id=\"spare\"/>", "<node id=\"spare\"><node><instance_node url=\"#spare\"/></node></node>")),
      "contains itself");
  check_varied("<node id=\"shape\">",
               repeated("<node>", 100'000) + repeated("</node>", 100'000) + "<node id=\"shape\">",
               "nested more than 1000 deep");
  CHECK(load_text(
            varied("<node id=\"shape\">", repeated("<node>", 900) + repeated("</node>", 900) + "<node id=\"shape\">"))
            .triangle_count() == 2);
  // Elements that mean nothing may nest as they like.
  CHECK(load_text(
            varied("<node id=\"shape\">", repeated("<x>", 100'000) + repeated("</x>", 100'000) + "<node id=\"shape\">"))
            .triangle_count() == 2);

  std::string doubling = "<node id=\"n0\"><instance_geometry url=\"#lamp\"/></node>";
  std::string chain = doubling;
  for (int i = 1; i <= 2000; ++i) {
    const std::string head = "<node id=\"n" + std::to_string(i) + "\">";
    const std::string instance = "<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>";
    if (i <= 60) doubling += head + instance + instance + "</node>";
    chain += head + instance + "</node>";
  }
  const std::string use60 = varied("<translate>1 2 3", "<instance_node url=\"#n60\"/><translate>1 2 3");
  check_error(varied("<node id=\"spare\"/>", doubling, use60), "1 million nodes");
  const std::string use2000 = varied("<translate>1 2 3", "<instance_node url=\"#n2000\"/><translate>1 2 3");
  check_error(varied("<node id=\"spare\"/>", chain, use2000), "1000 deep");
}

TEST_CASE("scenes: entity bombs") {
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE COLLADA [<!ENTITY a \"ha\">";
  for (char c = 'b'; c <= 'z'; ++c) {
    bomb +=
        std::string("<!ENTITY ") + c + " \"" + repeated(std::string("&") + static_cast<char>(c - 1) + ";", 10) + "\">";
  }
  check_error(varied("<?xml version=\"1.0\" encoding=\"utf-8\"?>", bomb + "]>"), "entity declarations");
}

TEST_CASE("scenes: every prefix of a file gives an error, not a crash") {
  for (size_t size = 0; size + 12 < kDocument.size(); size += 7) CHECK(error_of(kDocument.substr(0, size)) != "loaded");
}

}  // namespace
}  // namespace lanewise
