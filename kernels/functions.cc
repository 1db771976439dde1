#include "kernels/functions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/functions.cc"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lanewise {
namespace HWY_NAMESPACE {

template <class F>
HWY_INLINE void Map(const float* x, float* y, size_t n, const F& f) {
  const DF d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) hn::StoreU(f(hn::LoadU(d, x + i)), d, y + i);
}

void ApplyFunction(Function f, const float* x, float* y, size_t n) {
  switch (f) {
    case Function::kSin2Pi:
      return Map(x, y, n, [](VF u) HWY_ATTR {
        VF sin, cos;
        SinCos2Pi(u, sin, cos);
        return sin;
      });
    case Function::kCos2Pi:
      return Map(x, y, n, [](VF u) HWY_ATTR {
        VF sin, cos;
        SinCos2Pi(u, sin, cos);
        return cos;
      });
    case Function::kAtanTurns:
      return Map(x, y, n, [](VF t) HWY_ATTR { return AtanTurns(t); });
    case Function::kExp:
      return Map(x, y, n, [](VF v) HWY_ATTR { return Exp(v); });
    case Function::kLog:
      return Map(x, y, n, [](VF v) HWY_ATTR { return Log(v); });
    case Function::kErfcx:
      return Map(x, y, n, [](VF v) HWY_ATTR { return Erfcx(v); });
    case Function::kErfInvCentered:
      return Map(x, y, n, [](VF u) HWY_ATTR { return ErfInvCentered(u); });
  }
}

void ApplyAtan2Turns(const float* y, const float* x, float* turns, size_t n) {
  const DF d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::StoreU(Atan2Turns(hn::LoadU(d, y + i), hn::LoadU(d, x + i)), d, turns + i);
  }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
HWY_EXPORT(ApplyFunction);
HWY_EXPORT(ApplyAtan2Turns);
void apply_function(Function f, const float* x, float* y, size_t n) { HWY_DYNAMIC_DISPATCH(ApplyFunction)(f, x, y, n); }
void apply_atan2_turns(const float* y, const float* x, float* turns, size_t n) {
  HWY_DYNAMIC_DISPATCH(ApplyAtan2Turns)(y, x, turns, n);
}
}  // namespace lanewise
#endif
