#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/shade_mirror.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void ShadeMirror(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 normal = LoadVec3(s.s_x, s.s_y, s.s_z, i);
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const VF cosine = Dot(d, normal);
    const Vec3 wi = Normalize(MulAdd(hn::Mul(Splat(-2.0f), cosine), normal, d));
    const Vec3 o =
        OffsetOrigin(LoadVec3(s.o_x, s.o_y, s.o_z, i), LoadVec3(s.n_x, s.n_y, s.n_z, i), hn::Load(df, s.err + i), wi);
    const Vec3 tint = LaneMaterials(plan, s, i).GetVec3(kReflectance);
    StoreVec3(Mul(LoadVec3(s.beta_r, s.beta_g, s.beta_b, i), tint), s.beta_r, s.beta_g, s.beta_b, i);
    StoreVec3(o, s.o_x, s.o_y, s.o_z, i);
    StoreVec3(wi, s.d_x, s.d_y, s.d_z, i);
    hn::Store(PdfAfterDelta(plan, s, i, hn::Lt(cosine, hn::Zero(df))), df, s.pdf + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(ShadeMirror, shade_mirror);
}  // namespace lanewise
#endif
