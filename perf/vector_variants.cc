#include "perf/vector_variants.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "perf/vector_variants.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "hwy/contrib/math/math-inl.h"
#include "kernels/fresnel-inl.h"
#include "kernels/math-inl.h"
#include "kernels/microfacet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

template <class F>
HWY_INLINE void MapVectors(const float* x, float* y, size_t n, const F& f) {
  const DF d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) hn::StoreU(f(hn::LoadU(d, x + i)), d, y + i);
}

HWY_INLINE VF Turns(VF u) { return hn::Mul(u, Splat(6.2831853f)); }

template <Fresnel model>
HWY_INLINE void MapDielectric(const float* x, float* y, size_t n, float n_i, float n_t) {
  MapVectors(x, y, n, [=](VF c) HWY_ATTR {
    return FresnelDielectric(model, c, Splat(opaque(n_i)), Splat(opaque(n_t))).reflectance;
  });
}

template <Fresnel model>
HWY_INLINE void MapGold(const float* x, float* y, size_t n) {
  MapVectors(x, y, n,
             [](VF c) HWY_ATTR { return FresnelConductor(model, c, Splat(opaque(kGoldEta)), Splat(opaque(kGoldK))); });
}

// The half vector (x, 0, z).
HWY_INLINE VF CosineOf(VF x) { return hn::Sqrt(hn::NegMulAdd(x, x, Splat(1.0f))); }

void ApplyVariant(VectorVariant f, const float* x, float* y, size_t n) {
  const DF d;
  switch (f) {
    case VectorVariant::kHighwayExp:
      return MapVectors(x, y, n, [d](VF v) HWY_ATTR { return hn::Exp(d, v); });
    case VectorVariant::kHighwayLog:
      return MapVectors(x, y, n, [d](VF v) HWY_ATTR { return hn::Log(d, v); });
    case VectorVariant::kHighwaySin:
      return MapVectors(x, y, n, [d](VF v) HWY_ATTR { return hn::Sin(d, v); });
    case VectorVariant::kHighwayCos:
      return MapVectors(x, y, n, [d](VF v) HWY_ATTR { return hn::Cos(d, v); });
    case VectorVariant::kHighwaySin2Pi:
      return MapVectors(x, y, n, [d](VF u) HWY_ATTR { return hn::Sin(d, Turns(u)); });
    case VectorVariant::kHighwayCos2Pi:
      return MapVectors(x, y, n, [d](VF u) HWY_ATTR { return hn::Cos(d, Turns(u)); });
    case VectorVariant::kIntoGlassExact:
      return MapDielectric<Fresnel::kExact>(x, y, n, 1, kGlass);
    case VectorVariant::kIntoGlassSchlick:
      return MapDielectric<Fresnel::kSchlick>(x, y, n, 1, kGlass);
    case VectorVariant::kIntoGlassCourse:
      return MapDielectric<Fresnel::kCourse>(x, y, n, 1, kGlass);
    case VectorVariant::kOutOfGlassExact:
      return MapDielectric<Fresnel::kExact>(x, y, n, kGlass, 1);
    case VectorVariant::kOutOfGlassSchlick:
      return MapDielectric<Fresnel::kSchlick>(x, y, n, kGlass, 1);
    case VectorVariant::kOutOfGlassCourse:
      return MapDielectric<Fresnel::kCourse>(x, y, n, kGlass, 1);
    case VectorVariant::kGoldExact:
      return MapGold<Fresnel::kExact>(x, y, n);
    case VectorVariant::kGoldSchlick:
      return MapGold<Fresnel::kSchlick>(x, y, n);
    case VectorVariant::kGoldCourse:
      return MapGold<Fresnel::kCourse>(x, y, n);
    case VectorVariant::kBeckmannStable:
      return MapVectors(x, y, n, [](VF s) HWY_ATTR {
        const VF z = CosineOf(s);
        return BeckmannD(hn::Div(hn::Mul(s, s), hn::Mul(z, z)), Splat(opaque(kPolished)));
      });
    case VectorVariant::kBeckmannNaive:
      return MapVectors(x, y, n, [](VF s) HWY_ATTR {
        const VF z = CosineOf(s), z2 = hn::Mul(z, z);
        return BeckmannD(hn::Div(hn::Sub(Splat(1.0f), z2), z2), Splat(opaque(kPolished)));
      });
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
HWY_EXPORT(ApplyVariant);
void apply_variant(VectorVariant f, const float* x, float* y, size_t n) {
  HWY_DYNAMIC_DISPATCH(ApplyVariant)(f, x, y, n);
}
}  // namespace lanewise
#endif
