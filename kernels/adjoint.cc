#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/adjoint.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/math-inl.h"
#include "kernels/shading-inl.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

void Adjoint(const Plan&, const PathState& s, Range range) {
  const DF df;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const Vec3 d = LoadVec3(s.d_x, s.d_y, s.d_z, i);
    const VF shading = AbsDot(d, LoadVec3(s.s_x, s.s_y, s.s_z, i));
    const VF geometric = AbsDot(d, LoadVec3(s.n_x, s.n_y, s.n_z, i));
    const VF above = s.step.leaving ? geometric : shading, below = s.step.leaving ? shading : geometric;
    const MF usable = hn::And(Agrees(s, i, d), hn::Gt(below, hn::Zero(df)));
    const VF scale = hn::IfThenElseZero(usable, hn::Div(above, below));
    StoreVec3(Scale(scale, LoadVec3(s.beta_r, s.beta_g, s.beta_b, i)), s.beta_r, s.beta_g, s.beta_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(Adjoint, adjoint);
}  // namespace lanewise
#endif
