// Files that mean harm, or are broken: what the fuzzers found, seeds cut short, and scenes that name what is not theirs.
#include <doctest/doctest.h>
#include <malloc.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "core/image_stb.h"
#include "scenes/load.h"
#include "tests/formats_harness.h"
#include "tests/fuzz/harness.h"
#include "tests/scene_paths.h"
#include "tests/scenes_harness.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;

// Of the process: the most memory that it has had, in MiB, since it was last set back.
void forget_peak() { std::ofstream("/proc/self/clear_refs") << '5'; }
double memory_mib(const std::string& line) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == line && status >> kib) return kib / 1024;
  }
  return 0;
}

// Ends in an Error or loads, soon and in little memory: the harness lets nothing else pass.
void check_harmless(const fuzz::Harness& harness, const std::string& bytes, const std::string& what) {
  CAPTURE(what);
  const auto start = std::chrono::steady_clock::now();
  forget_peak();
  const double before = memory_mib("VmRSS:");
  CHECK_NOTHROW(harness.run(bytes));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  CHECK(took.count() < 10);
  CHECK(memory_mib("VmHWM:") - before < 2048);
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

TEST_CASE("hostile files: what the fuzzers found") {
  size_t found = 0;
  for (const fuzz::Harness* harness : fuzz::harnesses()) {
    for (const fs::path& file : files_in(test::source_dir() / "tests/fuzz/regressions" / harness->name)) {
      check_harmless(*harness, test::read_text(file), file.string());
      ++found;
    }
  }
  CHECK(found > 0);
}

TEST_CASE("hostile files: seeds, whole and cut short") {
#ifdef NDEBUG
  constexpr size_t kCuts = 60;
#else
  constexpr size_t kCuts = 8;
#endif
  CHECK(fuzz::harnesses().size() >= 11);
  for (const fuzz::Harness* harness : fuzz::harnesses()) {
    const auto seeds = files_in(test::source_dir() / "tests/fuzz/seeds" / harness->name);
    CHECK_MESSAGE(!seeds.empty(), harness->name);
    for (const fs::path& file : seeds) {
      const std::string whole = test::read_text(file);
      check_harmless(*harness, whole, file.string());
      for (size_t cut = 0; cut < kCuts; ++cut) {
        const size_t size = whole.size() * cut / kCuts;
        check_harmless(*harness, whole.substr(0, size),
                       file.string() + ", its first " + std::to_string(size) + " bytes");
      }
    }
  }
}

// Hears of every opening of the files that it watches, and of every change in folders.
class Watch {
 public:
  Watch() : fd_(::inotify_init1(IN_NONBLOCK)) { REQUIRE(fd_ >= 0); }
  ~Watch() { ::close(fd_); }
  void openings(const std::string& file) { add(file, IN_OPEN | IN_ACCESS); }
  void changes(const std::string& folder) {
    add(folder, IN_CREATE | IN_MODIFY | IN_ATTRIB | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO | IN_CLOSE_WRITE);
  }
  // Since the last call.
  bool heard() const {
    char events[4096];
    bool any = false;
    while (::read(fd_, events, sizeof events) > 0) any = true;
    return any;
  }

 private:
  void add(const std::string& path, uint32_t events) { REQUIRE(::inotify_add_watch(fd_, path.c_str(), events) >= 0); }

  int fd_;
};

// A folder for a scene, beside things that are none of its business, with ways out.
struct Trap {
  test::TemporaryFolder folder;
  const std::string inner = folder.file("inner");
  Watch watch;

  Trap() {
    fs::create_directory(inner);
    for (const char* name : {"secret.png", "secret.mtl", "secret.bin"}) {
      // Each would do, if it were read.
      const std::string bytes = name == std::string("secret.png")   ? test::read_text(seed("png/rgb.png"))
                                : name == std::string("secret.mtl") ? "newmtl grey\nKd 1 0 0\n"
                                                                    : std::string(1000, '\0');
      test::write_text(folder.file(name), bytes);
      watch.openings(folder.file(name));
    }
    REQUIRE(::mkfifo((inner + "/pipe").c_str(), 0600) == 0);
    watch.openings(inner + "/pipe");
    fs::create_symlink(folder.path(), inner + "/out");
    fs::create_symlink("/dev/zero", inner + "/zero");
    for (const char* extension : {".png", ".mtl", ".bin"}) {
      fs::create_symlink(folder.file(std::string("secret") + extension), inner + "/link" + extension);
    }
    watch.changes(folder.path().string());
  }

  static std::string seed(const std::string& name) { return (test::source_dir() / "tests/fuzz/seeds" / name).string(); }

  // What a scene may call something outside, or something that never ends.
  std::vector<std::string> names(const std::string& extension) const {
    const std::string secret = "secret" + extension, absolute = folder.file(secret);
    return {"../" + secret,
            absolute,
            "file:" + absolute,
            "file://" + absolute,
            "%2e%2e/" + secret,
            "..\\" + secret,
            "out/" + secret,
            "./out/../../" + secret,
            "link" + extension,
            "pipe",
            "zero",
            "/dev/zero",
            "/etc/passwd",
            "file:///etc/passwd",
            "../inner/zero",
            "http://localhost/" + secret,
            "https://localhost:1/x" + extension,
            "|cat " + absolute,
            ".",
            "..",
            ""};
  }

  // What loading says: the error, or the notices. Reads the scene alone and changes nothing.
  std::string load(const std::string& name, const std::string& text,
                   const std::vector<std::pair<std::string, std::string>>& files = {}) {
    for (const auto& [file, bytes] : files) test::write_text(inner + '/' + file, bytes);
    test::write_text(inner + '/' + name, text);
    Watch folder_watch;
    folder_watch.changes(inner);
    watch.heard();
    std::string said;
    try {
      const Scene scene = load_scene(inner + '/' + name);
      CHECK(scene.textures.empty());
      for (const std::string& notice : scene.notices) said += notice + '\n';
    } catch (const Error& error) {
      said = error.what();
    }
    CHECK_FALSE(watch.heard());
    CHECK_FALSE(folder_watch.heard());
    return said;
  }
};

TEST_CASE("hostile files: the watch hears what these tests listen for") {
  Trap trap;
  trap.watch.heard();
  test::read_text(trap.inner + "/link.png");
  CHECK(trap.watch.heard());
  CHECK_FALSE(trap.watch.heard());
  test::write_text(trap.folder.file("new"), "");
  CHECK(trap.watch.heard());
}

TEST_CASE("hostile files: COLLADA reads no picture, document or entity that is not its own") {
  Trap trap;
  const std::string textured = test::read_text(Trap::seed("collada/textured.dae"));
  for (const std::string& name : trap.names(".png")) {
    CAPTURE(name);
    const std::string said = trap.load("a.dae", varied("wood.png", name, textured));
    const bool refused = said.find("is no file in the scene's folder: not read") != std::string::npos ||
                         said.find("names no file in an <init_from>") != std::string::npos;
    CHECK(refused);
  }
  for (const char* url : {"../secret.dae#tri", "file:///etc/passwd#tri", "http://localhost/secret.dae#tri"}) {
    CAPTURE(url);
    CHECK(trap.load("a.dae", varied("url=\"#tri\"", std::string("url=\"") + url + '"')).find("must begin with #") !=
          std::string::npos);
  }
  const auto with_doctype = [](const std::string& doctype) {
    return varied("<COLLADA", "<!DOCTYPE COLLADA " + doctype + "><COLLADA",
                  varied("0 0 0 1 0 0 0 1 0", "0 0 0 &x; 0 0 0 1 0"));
  };
  for (const std::string& doctype :
       {"[<!ENTITY x SYSTEM \"file://" + trap.folder.file("secret.png") + "\">]",
        "[<!ENTITY % x SYSTEM \"" + trap.folder.file("secret.png") + "\">%x;]",
        std::string("[<!ENTITY a \"1 1 1 1 1 1 1 1\"><!ENTITY x \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]")}) {
    CAPTURE(doctype);
    CHECK(trap.load("a.dae", with_doctype(doctype)).find("entity declarations are not accepted") != std::string::npos);
  }
  CHECK(trap.load("a.dae", with_doctype("SYSTEM \"../secret.png\"")).find("\"&x;\" is not a number") !=
        std::string::npos);
}

TEST_CASE("hostile files: OBJ reads no material library or picture that is not its own") {
  Trap trap;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n";
  for (const std::string& name : trap.names(".mtl")) {
    if (name.empty()) continue;
    CAPTURE(name);
    CHECK(trap.load("a.obj", "mtllib " + name + '\n' + obj).find("not read") != std::string::npos);
  }
  for (const std::string& name : trap.names(".png")) {
    if (name.empty()) continue;
    CAPTURE(name);
    CHECK(trap.load("a.obj", "mtllib a.mtl\n" + obj, {{"a.mtl", "newmtl grey\nmap_Kd " + name + '\n'}})
              .find("is no file in the scene's folder: not read") != std::string::npos);
  }
}

TEST_CASE("hostile files: glTF reads no buffer or picture that is not its own") {
  Trap trap;
  const nlohmann::json gltf = nlohmann::json::parse(test::read_text(Trap::seed("gltf/box.gltf")));
  for (const char* list : {"buffers", "images"}) {
    for (const std::string& name : trap.names(list == std::string("images") ? ".png" : ".bin")) {
      CAPTURE(list);
      CAPTURE(name);
      nlohmann::json changed = gltf;
      changed[list][0]["uri"] = name;
      CHECK(trap.load("a.gltf", changed.dump()).find("is no file in the scene's folder") != std::string::npos);
    }
  }
}

// Text times over.
std::string repeated(const std::string& text, size_t times) {
  std::string all;
  for (size_t i = 0; i < times; ++i) all += text;
  return all;
}

TEST_CASE("hostile files: small files that ask for much are refused, soon") {
  const auto refused = [](const std::string& harness, const std::string& bytes, const std::string& why) {
    const test::TemporaryFolder folder;
    for (const fuzz::Harness* h : fuzz::harnesses()) {
      if (h->name != harness) continue;
      check_harmless(*h, bytes, why);
      test::write_text(folder.file("input" + h->extension), bytes);
      CHECK_THROWS_WITH_AS(h->read(folder.file("input" + h->extension)), doctest::Contains(why.c_str()), Error);
    }
  };
  // A few nodes, each of which holds the next twice.
  std::string nodes = "<node id=\"n0\"><instance_geometry url=\"#tri\"/></node>";
  for (int i = 1; i < 19; ++i) {
    const std::string inner = "<instance_node url=\"#n" + std::to_string(i - 1) + "\"/>";
    nodes += "<node id=\"n" + std::to_string(i) + "\">" + inner + inner + "</node>";
  }
  const std::string many = varied("<p>0 0 1 0 2 1</p>", "<p>" + repeated("0 0 1 0 2 1 ", 100) + "</p>",
                                  varied("material=\"surface\" count=\"1\"", "material=\"grey\""));
  const auto doubled = [&](const std::string& document) {
    return varied("<node id=\"spare\"/>", nodes,
                  varied("<node id=\"ball-node\">", "<node><instance_node url=\"#n18\"/></node><node id=\"ball-node\">",
                         document));
  };
  refused("collada", doubled(many), "more than 2^23 triangles beyond the file's own");
  const std::string part = "<triangles><input semantic=\"VERTEX\" source=\"#tv\" offset=\"0\"/><p/></triangles>";
  refused("collada",
          doubled(varied("<triangles material=\"surface\"", repeated(part, 10) + "<triangles material=\"surface\"")),
          "more than 1 million nodes and meshes");
  const std::string input = "<input semantic=\"TEXCOORD\" source=\"#uv\" offset=\"2\"/>";
  refused("collada",
          varied("<input semantic=\"TEXCOORD\"", repeated(input, 20) + "<input semantic=\"TEXCOORD\"",
                 test::read_text(Trap::seed("collada/textured.dae"))),
          "more than 16 sets of texture coordinates");

  const std::string little = test::read_text(Trap::seed("ply/little.ply")),
                    big = test::read_text(Trap::seed("ply/big.ply"));
  const std::string lists = "property list uint int ";
  for (const std::string& ply : {little, big}) {
    // The first list's length is then of its first index, too.
    refused("ply", varied("property list uchar int ", lists, ply), "a list of it is shorter");
  }
  const std::string ascii = test::read_text(Trap::seed("ply/ascii.ply"));
  refused("ply", varied("\n4 0 1 2 3", "\n4000000000 0 1 2 3", ascii), "a list of it is shorter");
  refused("ply", varied("\n4 0 1 2 3", "\n\n4 0 1 2 3", ascii), "a line of it is not that of an element");

  nlohmann::json gltf = nlohmann::json::parse(test::read_text(Trap::seed("gltf/least.gltf")));
  gltf["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 20}, {"type", "VEC3"}});
  for (int i = 0; i < 8; ++i) {
    gltf["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 1}}}});
  }
  refused("gltf", gltf.dump(), "many more vertices and indices than it has bytes");
  gltf = nlohmann::json::parse(test::read_text(Trap::seed("gltf/least.gltf")));
  for (int i = 0; i < 1000; ++i) gltf["meshes"][0]["primitives"].push_back(gltf["meshes"][0]["primitives"][0]);
  for (int i = 1; i < 1100; ++i) {
    gltf["nodes"].push_back({{"mesh", 0}});
    gltf["scenes"][0]["nodes"].push_back(i);
  }
  refused("gltf", gltf.dump(), "brings the file to more than 1 million meshes");

  for (const char* harness : {"png", "texture"}) {
    std::string png = test::read_text(Trap::seed("png/rgb.png"));
    png.replace(16, 8, std::string("\0\0\x1f\xff\0\0\x1f\xff", 8));
    refused(harness, png, "absurd size 8191x8191");
  }
  std::string jpeg = test::read_text(Trap::seed("texture/progressive.jpg"));
  const size_t frame = jpeg.find("\xff\xc2");
  REQUIRE(frame != std::string::npos);
  refused("texture", jpeg.replace(frame + 5, 4, "\x2f\xff\x2f\xff"), "absurd size 12287x12287");
  const auto found = [](const std::string& name) {
    return test::read_text((test::source_dir() / "tests/fuzz/regressions" / name).string());
  };
  refused("texture", found("texture/huffman-table-too-long"), "a Huffman table of more than 255 codes");
  refused("ply", found("ply/element-named-by-a-number"), "its header has the line");
  refused("png", found("png/chunk-longer-than-file"), "a chunk leaves the file");
  refused("exr", found("exr/attribute-longer-than-file"), "its header leaves the file");
  refused("exr", found("exr/channels-longer-than-attribute"), "its header leaves the file");
  // All rows of a picture of a gigabyte are missing.
  std::string exr = test::read_text(Trap::seed("exr/none.exr"));
  const size_t window = exr.find("dataWindow");
  REQUIRE(window != std::string::npos);
  exr.replace(window + 29, 8, std::string("\xff\x1f\0\0\xff\x1f\0\0", 8));
  refused("exr", exr, "cannot read");
}

TEST_CASE("hostile files: a JPEG without its Huffman tables decodes the same whatever memory holds") {
  const std::string whole = test::read_text(Trap::seed("texture/baseline.jpg"));
  std::string without;
  for (size_t at = 0; at < whole.size();) {
    const bool table = whole.compare(at, 2, "\xff\xc4") == 0;
    const size_t length =
        table ? 2 + (static_cast<uint8_t>(whole[at + 2]) << 8) + static_cast<uint8_t>(whole[at + 3]) : 1;
    if (!table) without += whole[at];
    at += length;
  }
  REQUIRE(without.size() + 20 < whole.size());
  std::vector<std::string> seen;
  for (const int fill : {0x01, 0x55, 0xfe}) {
    mallopt(M_PERTURB, fill);
    try {
      const Texture texture = decode_texture(without, 1 << 20);
      seen.emplace_back(reinterpret_cast<const char*>(texture.texels.data()), 4 * texture.texels.size());
    } catch (const Error& e) {
      seen.emplace_back(e.what());
    }
  }
  mallopt(M_PERTURB, 0);
  CHECK(seen[0] == seen[1]);
  CHECK(seen[0] == seen[2]);
}

}  // namespace
}  // namespace lanewise
