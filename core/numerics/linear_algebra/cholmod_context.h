#pragma once

#include <cholmod.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "core/numerics/linear_algebra/numeric_factor.h"

namespace drape {

/// CHOLMOD's settings and workspace for supernodal factorisations. CHOLMOD prints nothing: callers check.
/// Not installed, since it needs CHOLMOD's headers.
struct CholmodContext {
  cholmod_common common;

  CholmodContext() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.postorder = 1;
  }
  CholmodContext(const CholmodContext&) = delete;
  CholmodContext& operator=(const CholmodContext&) = delete;
  ~CholmodContext() { cholmod_finish(&common); }

  /// Throws std::runtime_error with CHOLMOD's status unless `succeeded`.
  void require(bool succeeded, const char* what) const {
    if (!succeeded)
      throw std::runtime_error(std::string("sparse Cholesky: ") + what + " failed (CHOLMOD status " +
                               std::to_string(common.status) +
                               "; -2 means out of memory, -3 too large for 32-bit indices)");
  }
};

/// CHOLMOD's supernodal LLᵀ of the matrix' scalars (Chen, Davis, Hager and Rajamanickam 2008).
///
/// Speed and bits depend on the BLAS that CHOLMOD loads; set_thread_count bounds neither its threads nor
/// CHOLMOD's. With Debian's reference BLAS every run has the same bits; OpenBLAS does not promise that.
std::unique_ptr<NumericFactor> make_cholmod_factor();

}  // namespace drape
