#include "core/image_io.h"

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "core/types.h"
#include "tests/temporary_folder.h"

namespace lanewise {
namespace {

using test::TemporaryFolder;

// Radiance over many orders of magnitude, from a fixed seed.
Image noisy_image(uint32_t width, uint32_t height) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> exponent(-12, 6);
  Image image(width, height);
  for (float& v : image.rgb) v = std::exp2(exponent(rng));
  return image;
}

std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.rgb.size() == b.rgb.size() &&
         std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

TEST_CASE("image_io: float formats keep every bit") {
  const TemporaryFolder folder;
  Image image = noisy_image(37, 11);
  image.rgb[0] = std::numeric_limits<float>::infinity();
  image.rgb[1] = -1.5f;
  image.rgb[2] = std::numeric_limits<float>::denorm_min();
  image.rgb[3] = std::numeric_limits<float>::quiet_NaN();
  for (const char* name : {"a.exr", "a.pfm", "A.PFM"}) {
    CAPTURE(name);
    write_image(folder.file(name), image);
    CHECK(same_bits(read_image(folder.file(name)), image));
  }
}

TEST_CASE("image_io: .png is sRGB, rounded to nearest") {
  const TemporaryFolder folder;
  Image image(5, 1);
  // 0.5 is 187.5160 / 255 in sRGB, and 0.214041 is 127.5 / 255.
  image.rgb = {0, 0.5f, 1, 0.21403f, 0.21406f, 2, -1, NAN, INFINITY, 0.0031308f, 1e-9f, 0.9999f, 0.1f, 0.2f, 0.3f};
  write_image(folder.file("a.png"), image);
  const Image back = read_image(folder.file("a.png"));
  const auto code = [&](size_t i) {
    const double v = back.rgb[i];
    return std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055));
  };
  const long expected[] = {0, 188, 255, 127, 128, 255, 0, 0, 0, 10, 0, 255};
  for (size_t i = 0; i < std::size(expected); ++i) {
    CAPTURE(i);
    CHECK(code(i) == expected[i]);
  }
  // Reading and writing once more changes nothing.
  const std::string bytes = test::read_text(folder.file("a.png"));
  write_image(folder.file("b.png"), back);
  CHECK(test::read_text(folder.file("b.png")) == bytes);
}

TEST_CASE("image_io: .hdr keeps the brightest channel to a relative 1/256, and the mean") {
  const TemporaryFolder folder;
  const Image image = noisy_image(64, 64);
  write_image(folder.file("a.hdr"), image);
  const Image back = read_image(folder.file("a.hdr"));
  double sum = 0, sum_back = 0, worst = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    const float brightest = *std::max_element(&image.rgb[i], &image.rgb[i] + 3);
    for (size_t c = 0; c < 3; ++c) {
      worst = std::max(worst, std::fabs(double{back.rgb[i + c]} - image.rgb[i + c]) / brightest);
      sum += image.rgb[i + c];
      sum_back += back.rgb[i + c];
    }
  }
  CHECK(worst <= 1.0 / 256);
  CHECK(sum_back / sum == doctest::Approx(1).epsilon(2e-4));
}

TEST_CASE("image_io: .hdr takes any float") {
  const TemporaryFolder folder;
  Image image(2, 2);
  image.rgb = {NAN, INFINITY, -1, 3e38f, 1, 0, 1e-30f, 1e-40f, 0, 0.998f, 0.9999f, 0.5f};
  write_image(folder.file("a.hdr"), image);
  const Image back = read_image(folder.file("a.hdr"));
  CHECK(back.rgb[0] == 0);
  CHECK(back.rgb[1] == 0);
  CHECK(back.rgb[2] == 0);
  CHECK(back.rgb[3] == doctest::Approx(1e38).epsilon(0.004));
  CHECK(back.rgb[6] == doctest::Approx(1e-30).epsilon(0.004));
  CHECK(back.rgb[10] == 1);  // rounds up into the next exponent
  CHECK(back.rgb[11] == 0.5f);
}

TEST_CASE("image_io: .hdr with run-length encoded lines") {
  const TemporaryFolder folder;
  // One line of 8 pixels: red a run of 128, green a run of 64, blue three values then a run of 0, the exponent that
  // of 1.
  const std::string line("\x02\x02\x00\x08\x88\x80\x88\x40\x03\x01\x02\x03\x85\x00\x88\x81", 16);
  const std::string header = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
  test::write_text(folder.file("a.hdr"), header + line);
  const Image image = read_image(folder.file("a.hdr"));
  REQUIRE(image.width == 8);
  CHECK(image.rgb[0] == 1);
  CHECK(image.rgb[1] == 0.5f);
  CHECK(image.rgb[2] == 1 / 128.0f);
  CHECK(image.rgb[3 * 7 + 2] == 0);
  for (size_t n = 0; n < line.size(); ++n) {
    test::write_text(folder.file("a.hdr"), header + line.substr(0, n));
    CHECK_THROWS_AS(read_image(folder.file("a.hdr")), Error);
  }
}

TEST_CASE("image_io: .pfm of either byte order, grey or coloured") {
  const TemporaryFolder folder;
  test::write_text(folder.file("a.pfm"), std::string("Pf\n1 2\n1.0\n") + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
  const Image image = read_image(folder.file("a.pfm"));
  CHECK(image.rgb == ZeroedVector<float>{2, 2, 2, 1, 1, 1});  // the file's last row is the top one
}

TEST_CASE("image_io: .exr carries the metadata as string attributes") {
  const TemporaryFolder folder;
  write_image(folder.file("a.exr"), Image(4, 4), {{"command", "lanewise render 'a b.dae' -s 3"}, {"spp", "3"}});
  const std::string bytes = test::read_text(folder.file("a.exr"));
  const std::string value = "lanewise render 'a b.dae' -s 3";
  const std::string attribute =
      std::string("command\0string\0", 15) + static_cast<char>(value.size()) + std::string(3, '\0') + value;
  CHECK(bytes.find(attribute) != std::string::npos);
  CHECK(bytes.find(std::string("spp\0string\0\1\0\0\0", 15) + "3") != std::string::npos);
}

TEST_CASE("image_io: damaged and foreign files are one-line errors that name the file") {
  const TemporaryFolder folder;
  const Image image = noisy_image(40, 30);
  for (const char* extension : {".png", ".exr", ".pfm", ".hdr"}) {
    CAPTURE(extension);
    const std::string path = folder.file(std::string("a") + extension);
    write_image(path, image);
    const std::string whole = test::read_text(path);
    std::vector<std::string> contents = {"", "P", "<html>not a picture</html>\n", std::string(5000, '\0')};
    for (const size_t keep : {whole.size() / 2, whole.size() / 10, size_t{20}})
      contents.push_back(whole.substr(0, keep));
    for (const std::string& content : contents) {
      CAPTURE(content.size());
      test::write_text(path, content);
      const std::string error = error_of([&] { read_image(path); });
      CHECK(error.starts_with(path + ": cannot read: "));
      CHECK(error.find('\n') == std::string::npos);
    }
    std::filesystem::remove(path);
    CHECK(error_of([&] { read_image(path); }).starts_with(path + ": cannot read: "));
    std::filesystem::create_directory(path);
    CHECK(error_of([&] { read_image(path); }) == path + ": cannot read: Is a directory");
  }
  CHECK_THROWS_AS(read_image(folder.file("a.gif")), UsageError);
}

TEST_CASE("image_io: absurd sizes are refused before anything is allocated") {
  const TemporaryFolder folder;
  test::write_text(folder.file("a.pfm"), "PF\n999999999 999999999\n-1\n");
  CHECK_THROWS_AS(read_image(folder.file("a.pfm")), Error);
  test::write_text(folder.file("a.pfm"), "PF\n0 5\n-1\n");
  CHECK_THROWS_AS(read_image(folder.file("a.pfm")), Error);
  test::write_text(folder.file("a.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\n");
  CHECK_THROWS_AS(read_image(folder.file("a.hdr")), Error);
}

TEST_CASE("image_io: a name must have one of the four extensions") {
  for (const char* good : {"a.png", "b/c.EXR", "x.y.pfm", "a.Hdr"}) CHECK_NOTHROW(check_image_extension(good));
  for (const char* bad : {"a", "a.jpg", "png", ".png", "a.png.txt", "a.", ""}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(check_image_extension(bad), UsageError);
  }
}

TEST_CASE("image_io: writability is known without writing") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("folder.png"));
  test::write_text(folder.file("file"), "");
  CHECK_NOTHROW(check_image_writable(folder.file("new.png")));
  CHECK_THROWS_AS(check_image_writable(folder.file("folder.png")), Error);
  CHECK_THROWS_AS(check_image_writable(folder.file("none/new.png")), Error);
  CHECK_THROWS_AS(check_image_writable(folder.file("file/new.png")), Error);
  CHECK_THROWS_AS(check_image_writable(folder.file(std::string(300, 'x') + ".png")), Error);
  CHECK(folder.names().size() == 2);
  if (::geteuid() == 0) return;  // whom permissions do not stop
  test::write_text(folder.file("locked.png"), "old");
  ::chmod(folder.file("locked.png").c_str(), 0444);
  CHECK_THROWS_AS(check_image_writable(folder.file("locked.png")), Error);
  ::chmod(folder.path().c_str(), 0555);
  CHECK_THROWS_AS(check_image_writable(folder.file("new.png")), Error);
  ::chmod(folder.path().c_str(), 0755);
}

// No file may grow beyond so many bytes: a disk that is full.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int) = nullptr;
};

TEST_CASE("image_io: a write that fails half way leaves the old file and nothing else") {
  const TemporaryFolder folder;
  const Image image = noisy_image(100, 100);
  for (const char* extension : {".png", ".exr", ".pfm", ".hdr"}) {
    CAPTURE(extension);
    const std::string path = folder.file(std::string("a") + extension);
    test::write_text(path, "old");
    std::string error;
    {
      const FileSizeLimit full_disk(1000);
      error = error_of([&] { write_image(path, image); });
    }
    CHECK(error == path + ": cannot write: File too large");
    CHECK(test::read_text(path) == "old");
    CHECK(folder.names().size() == 1);
    write_image(path, image);
    CHECK(read_image(path).width == 100);
    std::filesystem::remove(path);
  }
}

TEST_CASE("image_io: links are written through, and devices directly") {
  const TemporaryFolder folder;
  test::write_text(folder.file("real.png"), "old");
  std::filesystem::create_symlink("real.png", folder.file("link.png"));
  write_image(folder.file("link.png"), Image(2, 2));
  CHECK(std::filesystem::is_symlink(folder.file("link.png")));
  CHECK(read_image(folder.file("real.png")).width == 2);
  std::filesystem::create_symlink("/dev/full", folder.file("full.png"));
  CHECK(error_of([&] { write_image(folder.file("full.png"), Image(2, 2)); }) ==
        folder.file("full.png") + ": cannot write: No space left on device");
}

}  // namespace
}  // namespace lanewise
