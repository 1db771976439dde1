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

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace lanewise
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lanewise {
HWY_EXPORT(ApplyFunction);
void apply_function(Function f, const float* x, float* y, size_t n) { HWY_DYNAMIC_DISPATCH(ApplyFunction)(f, x, y, n); }
}  // namespace lanewise
#endif
