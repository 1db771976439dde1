#pragma once

#include <algorithm>

#include "kernels/kernels.h"
#include "kernels/reference/rng.h"

namespace lanewise::reference {

template <class T>
void roulette(const Plan& plan, Path<T>& p) {
  if (p.step.bounce < kRouletteBounce) return;
  const T q = std::min(T(1), std::max({p.beta_r, p.beta_g, p.beta_b}));
  const T scale = draw_random(plan, p, kSetChoice).u[kDrawRoulette] < q ? 1 / q : 0;
  p.beta_r *= scale;
  p.beta_g *= scale;
  p.beta_b *= scale;
}

}  // namespace lanewise::reference
