#include "tests/fresnel_harness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/fresnel_harness.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// n is a multiple of kLanes in both.
void Dielectrics(Fresnel model, const float* c, const float* n_i, const float* n_t, size_t n, float* f, float* cos_t) {
  const DF d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Dielectric r = FresnelDielectric(model, hn::LoadU(d, c + i), hn::LoadU(d, n_i + i), hn::LoadU(d, n_t + i));
    hn::StoreU(r.reflectance, d, f + i);
    hn::StoreU(r.cos_t, d, cos_t + i);
  }
}

void Conductors(Fresnel model, const float* c, const float* eta, const float* k, size_t n, float* f) {
  const DF d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::StoreU(FresnelConductor(model, hn::LoadU(d, c + i), hn::LoadU(d, eta + i), hn::LoadU(d, k + i)), d, f + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
namespace {

HWY_EXPORT(Dielectrics);
HWY_EXPORT(Conductors);

void pad(test::FresnelInputs& in) {
  while (in.c.size() % kLanes != 0) in.add(in.c.back(), in.a.back(), in.b.back());
}

}  // namespace

namespace test {

DielectricOutputs dielectrics(Fresnel model, FresnelInputs in) {
  pad(in);
  DielectricOutputs out{std::vector<float>(in.c.size()), std::vector<float>(in.c.size())};
  HWY_DYNAMIC_DISPATCH(Dielectrics)
  (model, in.c.data(), in.a.data(), in.b.data(), in.c.size(), out.f.data(), out.cos_t.data());
  return out;
}

std::vector<float> conductors(Fresnel model, FresnelInputs in) {
  pad(in);
  std::vector<float> f(in.c.size());
  HWY_DYNAMIC_DISPATCH(Conductors)(model, in.c.data(), in.a.data(), in.b.data(), in.c.size(), f.data());
  return f;
}

}  // namespace test
}  // namespace lanewise
#endif
