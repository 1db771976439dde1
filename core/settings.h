// What a user chooses for a render, apart from the scene. The command line fills it; its defaults are the program's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lanewise {

enum class View { kFile, kFit };  // the file's camera, or the course program's framing of the whole scene
enum class Direct { kMis, kLight, kBsdf, kHemisphere };  // how direct light is estimated (kHemisphere: -H)
enum class BsdfSampling { kVndf, kNdf, kCosine };        // how microfacets choose a direction
enum class Accel { kPlan, kTree };  // where rays look for geometry: as the plan chooses; all in trees
enum class Fresnel { kExact, kSchlick, kCourse };
enum class Allocation { kEven, kNoise };  // which pixels get how many samples: see core/sample_shares.h
enum class Sampler { kSobol, kRandom };  // where a path's numbers come from: see kernels/rng-inl.h

// How the course program's microfacet lobe departs from Beckmann's with Smith's shadowing: kernels/microfacet-inl.h has the
// formulas. (Its reflectances are Fresnel::kCourse.)
struct CourseLobe {
  bool masking = false;  // its Lambda, which has pi for sqrt(pi), and 1 / (1 + Lambda + Lambda) for G
  bool clamp = false;    // its D, which takes no cosine above 1 - 1e-5: polished metals go dark

  bool any() const { return masking || clamp; }
};

// Samples of a picture. A pixel with the largest share of them (core/sample_shares.h) has less than 2^63, where the numbers of its
// second estimate begin (core/dimensions.h).
constexpr uint64_t kMaxSpp = uint64_t{1} << 59;

// A rectangle of pixels of the whole picture; row 0 is at the top.
struct Window {
  uint32_t x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Window&) const = default;
};

struct Settings {
  uint32_t width = 480;
  uint32_t height = 360;
  Window crop;                 // -p: the part to render, within the picture; width 0: all of it
  uint64_t spp = 16;           // camera samples per pixel, in [1, kMaxSpp]; their mean with allocation; the most of them with -a, --noise, --time
  uint64_t first_sample = 0;   // --samples: the number of a pixel's first
  uint32_t light_samples = 1;  // per light at every vertex, >= 1
  uint32_t max_depth = 5;      // most scattering events on a path; 0: only light seen directly
  std::optional<uint32_t> only_bounce;  // only light that has been scattered this many times, <= max_depth
  uint32_t threads = 0;                 // 0: all the machine has
  uint32_t wave = 4096;                 // paths in flight per thread, a multiple of kLanes
  uint64_t seed = 0;
  Sampler sampler = Sampler::kSobol;
  Allocation allocation = Allocation::kEven;  // not with -a or --noise, which have their own
  Accel accel = Accel::kPlan;
  View view = View::kFile;
  double lens_radius = 0;     // -b: of a thin lens, in scene units; 0: a pinhole
  double focal_distance = 1;  // -d: along the view axis, of the plane that the lens shows sharp, > 0
  bool autofocus = false;     // focal_distance becomes that of what is at the picture's centre
  Direct direct = Direct::kMis;
  bool light_paths = true;  // where they pay: see core/plan_light_paths.h
  bool reuse = true;        // paths of neighbouring pixels: see core/path_reuse.h
  bool connect = true;      // connections by way of mirror and glass spheres: see core/plan_connections.h
  BsdfSampling bsdf_sampling = BsdfSampling::kVndf;
  Fresnel fresnel = Fresnel::kExact;
  CourseLobe course;
  uint32_t adaptive_batch = 0;       // -a: samples between two decisions; 0: off
  double adaptive_tolerance = 0.05;  // stop a pixel when 1.96 sigma / sqrt(n) <= tolerance * mean
  double noise = 0;                  // --noise: relative standard error to stop a pixel at, by NoiseFilm's rule; 0: off
  double seconds = 0;                // --time: of rendering; 0: as many as it takes
  bool estimate_error = false;       // what `lanewise render` does unless told not to

  // The pixels that are rendered, and the result's size.
  Window window() const { return crop.width > 0 ? crop : Window{0, 0, width, height}; }

  // Whether light that has been scattered this many times belongs in the picture.
  bool shows(uint32_t scatterings) const { return !only_bounce || *only_bounce == scatterings; }
};

}  // namespace lanewise
