#include "core/texture.h"

#include "kernels/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/texture.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/shading-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

// A row or column of each lane's texture, and the share of the one after it; both wrap around.
struct TexelSpan {
  VI first, second;
  VF share;

  // size: whole; at: any, infinite or NaN too: the indices are within the texture.
  HWY_INLINE TexelSpan(VF at, VF size) {
    const DF df;
    const DI di;
    const VI one = hn::Set(di, 1);
    const VF whole = hn::Floor(at);
    const VF wrapped = hn::NegMulAdd(size, hn::Floor(hn::Div(whole, size)), whole);
    const VI last = hn::Sub(hn::ConvertTo(di, size), one);
    share = hn::Sub(at, whole);
    first = hn::Min(hn::ConvertTo(di, hn::IfThenElseZero(hn::Gt(wrapped, hn::Zero(df)), wrapped)), last);
    first = hn::Max(first, hn::Zero(di));
    second = hn::IfThenElseZero(hn::Lt(first, last), hn::Add(first, one));
  }
};

HWY_INLINE Vec3 Linear(VI texel) {
  const DF df;
  const VI byte = hn::Set(DI(), 255);
  return {hn::GatherIndex(df, kLinearOfByte.data(), hn::And(texel, byte)),
          hn::GatherIndex(df, kLinearOfByte.data(), hn::And(hn::ShiftRight<8>(texel), byte)),
          hn::GatherIndex(df, kLinearOfByte.data(), hn::And(hn::ShiftRight<16>(texel), byte))};
}

HWY_INLINE Vec3 Mix(const Vec3& a, const Vec3& b, VF share) { return MulAdd(share, Sub(b, a), a); }

void LookUpTexture(const Plan& plan, const PathState& s, Range range) {
  const DF df;
  const DI di;
  const auto* texels = reinterpret_cast<const int32_t*>(plan.texels.data());
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(df)) {
    const LaneMaterials material(plan, s, i);
    HWY_ALIGN uint32_t texture[hn::MaxLanes(DF())];
    for (size_t k = 0; k < hn::Lanes(df); ++k) {
      texture[k] = plan.materials[plan.prim_material[s.prim[i + k]]].texture;
    }
    VF width, height, first, pad;
    static_assert(sizeof(PlanTexture) == kTextureStride * sizeof(float));
    LaneRecords(&plan.textures[0].width, kTextureStride, texture).Get4(0, width, height, first, pad);

    const LaneRecords map(plan.prim_texture.data(), 8, s.prim + i);
    const Vec3 p = LoadVec3(s.o_x, s.o_y, s.o_z, i);
    Vec3 column, row;
    VF column_0, row_0;
    map.Get4(0, column.x, column.y, column.z, column_0);
    map.Get4(4, row.x, row.y, row.z, row_0);
    const TexelSpan x(hn::Add(Dot(column, p), column_0), width);
    const TexelSpan y(hn::Add(Dot(row, p), row_0), height);

    const VI stride = hn::ConvertTo(di, width), base = hn::BitCast(di, first);
    const auto at = [&](VI texel_x, VI texel_y) HWY_ATTR {
      return Linear(hn::GatherIndex(di, texels, hn::Add(hn::Add(base, hn::Mul(texel_y, stride)), texel_x)));
    };
    const Vec3 upper = Mix(at(x.first, y.first), at(x.second, y.first), x.share);
    const Vec3 lower = Mix(at(x.first, y.second), at(x.second, y.second), x.share);
    StoreVec3(Mul(material.GetVec3(kReflectance), Mix(upper, lower, y.share)), s.a_r, s.a_g, s.a_b, i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
LANEWISE_KERNEL(LookUpTexture, texture);
}  // namespace lanewise
#endif
