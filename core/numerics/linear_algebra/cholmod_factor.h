#pragma once

#include <memory>

#include "core/numerics/linear_algebra/numeric_factor.h"

namespace drape {

/// CHOLMOD's supernodal LLᵀ of the matrix' scalars (Chen, Davis, Hager and Rajamanickam 2008).
///
/// Speed and bits depend on the BLAS that CHOLMOD loads; set_thread_count bounds neither its threads nor
/// CHOLMOD's. With Debian's reference BLAS every run has the same bits; OpenBLAS does not promise that.
std::unique_ptr<NumericFactor> make_cholmod_factor();

}  // namespace drape
