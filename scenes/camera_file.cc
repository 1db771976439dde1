#include "scenes/camera_file.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/types.h"

namespace lanewise {
namespace {

using glm::dvec3;
using nlohmann::json;

// As of scene coordinates: beyond it squares of distances lose all meaning as floats.
constexpr double kMaxCoordinate = 1e15;

class CameraReader {
 public:
  explicit CameraReader(std::string path) : path_(std::move(path)) {
    std::ifstream file(path_);
    if (!file) throw Error(path_ + ": cannot be read");
    file.peek();  // a folder opens, but does not read
    if (!file) throw Error(path_ + ": cannot be read");
    try {
      json_ = json::parse(file);
    } catch (const json::parse_error& e) {
      throw Error(path_ + ": not JSON: byte " + std::to_string(e.byte));
    } catch (const json::out_of_range&) {
      fail("a number is beyond the range of a double");
    }
    if (!json_.is_object()) fail("a camera is a JSON object with eye, target and xfov");
  }

  Camera read(const dvec3& default_up) const {
    for (const auto& [key, value] : json_.items()) {
      if (key != "eye" && key != "target" && key != "up" && key != "xfov" && key != "aspect") {
        fail("unknown member \"" + key + "\"");
      }
    }
    const dvec3 eye = point("eye"), target = point("target");
    const dvec3 up = json_.contains("up") ? point("up") : default_up;
    const double degrees = number("xfov"), aspect = json_.contains("aspect") ? number("aspect") : 4.0 / 3.0;
    if (eye == target) fail("eye and target are the same point");
    if (!(degrees > 0 && degrees < 180)) fail("xfov must be between 0 and 180 degrees");
    if (!(aspect >= 1e-3 && aspect <= 1e3)) fail("aspect must be between 0.001 and 1000");
    const dvec3 back = glm::normalize(eye - target), side = glm::cross(up, back);
    if (!(glm::length(side) > 1e-9 * glm::length(up))) fail("up is zero or points along the view");

    Camera camera;
    camera.name = path_;
    camera.xfov = degrees * std::numbers::pi / 180;
    camera.aspect = aspect;
    const dvec3 right = glm::normalize(side);
    camera.to_world = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                                 glm::dvec4(eye, 1));
    return camera;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(path_ + ": " + what); }

  double number(const std::string& key) const {
    const auto found = json_.find(key);
    if (found == json_.end() || !found->is_number()) fail(key + " must be a number");
    return found->get<double>();
  }

  dvec3 point(const std::string& key) const {
    const auto found = json_.find(key);
    const auto good = [](const json& x) { return x.is_number() && std::abs(x.get<double>()) <= kMaxCoordinate; };
    if (found == json_.end() || !found->is_array() || found->size() != 3 || !good((*found)[0]) || !good((*found)[1]) ||
        !good((*found)[2])) {
      fail(key + " must be three numbers, none above 1e15");
    }
    return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
  }

  std::string path_;
  json json_;
};

}  // namespace

Camera load_camera(const std::string& path, const glm::dvec3& default_up) {
  return CameraReader(path).read(default_up);
}

}  // namespace lanewise
