#pragma once

#include <memory>

#include "core/kernel/linear_algebra/numeric_factor.h"

namespace drape {

/// CHOLMOD's supernodal LLᵀ of the matrix' scalars (Chen, Davis, Hager and Rajamanickam 2008).
///
/// The BLAS that CHOLMOD loads sets its speed, threads and bits, not parallel_for. Debian's reference BLAS
/// has one thread and gives the same bits in every run; others, as OpenBLAS, promise the same bits for no two
/// runs.
std::unique_ptr<NumericFactor> make_cholmod_factor();

}  // namespace drape
