// A Lanewise scene in Embree, the fastest library for rays alone, as the yardstick of traversal_bench.
#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "core/scene.h"
#include "perf/ray_sets.h"

namespace lanewise::perf {

// All meshes in one Embree geometry (so that it builds one tree) and all spheres in another (as its own sphere points),
// built at high quality for single rays, in the plan's coordinates. Geometry and primitive ids follow the plan's order.
class EmbreeScene {
 public:
  EmbreeScene(const Scene& scene, const double (&center)[3]);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  double build_seconds() const { return build_seconds_; }

  // Closest hits (rtcIntersect1) of the rays in their order; tfar is +inf on entry and the distance, or +inf, after.
  void intersect(std::vector<RTCRayHit>& rays) const;
  // Any hits (rtcOccluded1): tfar is -inf after where there is one.
  void occluded(std::vector<RTCRay>& rays) const;

 private:
  RTCDevice device_;
  RTCScene scene_;
  double build_seconds_ = 0;
};

// The set's rays from the first; shadow rays end at 1 in units of their direction.
std::vector<RTCRay> embree_rays(const RaySet& set);

}  // namespace lanewise::perf
