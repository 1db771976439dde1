// What kernels compute, in double precision: the functions of kernels/functions.h, good to some 1e-15
// over their domains, and reflectance.
#pragma once

#include <complex>

#include "kernels/functions.h"

namespace lanewise::verify {

using ExactFunction = double (*)(double);

ExactFunction exact_function(Function f);

// Fresnel's equations as they stand, for a relative index of any kind: mean reflectance of both polarisations at cosine c.
double fresnel_equations(double c, std::complex<double> index);

}  // namespace lanewise::verify
