// The functions of kernels/functions.h in double precision, good to some 1e-15 over their domains.
#pragma once

#include "kernels/functions.h"

namespace lanewise::verify {

using ExactFunction = double (*)(double);

ExactFunction exact_function(Function f);

}  // namespace lanewise::verify
