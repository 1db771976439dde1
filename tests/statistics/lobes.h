// The directions that a surface scatters to, as two parameters in which what is sampled is neither narrow nor far out.
#pragma once

#include <functional>

#include "kernels/reference/shade_microfacet.h"
#include "tests/statistics/chi_square.h"

namespace lanewise::test::lobes {

using Vec = reference::Vec3<double>;

// A path that arrives at a surface at so many degrees from its normal, and the frame in which its next direction is looked
// at: x towards the viewer.
struct Arrival {
  Path<float> path;
  Vec x, y, z;
  Vec wo;  // in the frame

  Arrival(const Vec& normal, double degrees);

  // The direction of travel in the frame. Its largest component comes from the other two, which a float direction holds to
  // more digits.
  Vec next(const PathState& s, uint32_t i) const;
};

const Vec kUp(0, 0, 1), kTilted(0.48, -0.6, 0.64), kDown(-0.1, 0.2, -0.97);

// Whatever of a direction in the frame: a density, or f cos.
using OfDirection = std::function<double(const Vec& wi)>;

// Over squared cosine and azimuth, in which cos / pi is even.
Domain hemisphere(const OfDirection& value);

// Over the slopes of the half vector in units of alpha, in which a Beckmann lobe is equally wide for every alpha. wi is
// above the surface.
Domain lobe(const Vec& wo, double alpha, const OfDirection& value);

inline reference::MicrofacetPair<double> evaluate(BsdfSampling strategy, const Vec& wo, const Vec& wi, double alpha) {
  Settings settings;
  settings.bsdf_sampling = strategy;
  return reference::evaluate_microfacet<double>(settings, wo, wi, alpha);
}

}  // namespace lanewise::test::lobes
