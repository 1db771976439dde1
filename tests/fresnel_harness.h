// The Fresnel functions of kernels/fresnel-inl.h over lists of inputs, on the target chosen at the moment.
#pragma once

#include <vector>

#include "core/settings.h"

namespace lanewise::test {

// Dielectrics: cosine of incidence, its side's index, the other side's. Conductors: cosine, eta, k.
struct FresnelInputs {
  std::vector<float> c, a, b;

  void add(float cosine, float first, float second) {
    c.push_back(cosine);
    a.push_back(first);
    b.push_back(second);
  }
};

struct DielectricOutputs {
  std::vector<float> f, cos_t;  // reflectance, cosine of refraction; as long as the inputs or longer
};

DielectricOutputs dielectrics(Fresnel model, FresnelInputs in);
std::vector<float> conductors(Fresnel model, FresnelInputs in);

}  // namespace lanewise::test
