#pragma once

#include <functional>
#include <optional>

namespace drape {

enum class FitEnd {
  reached,       ///< a factor has the residual 0
  jumps,         ///< the residual changes sign between two factors that are almost equal
  out_of_reach,  ///< it has one sign on the range of factors, or as far as it is known
  interrupted,   ///< it is not known at a factor between two of different sign
  exhausted      ///< too many evaluations
};

/// Looks for the factor that makes a residual 0: from 1 in steps by 4, at most to 1024 or 1/1024, in the
/// direction in which the residual falls off, until its sign changes, then between by TOMS 748 on the
/// factor's logarithm. Factors have four significant digits. The residual is to be exactly 0 where it is
/// small enough, and empty where it is not known: steps towards such a factor are halved.
FitEnd find_factor(const std::function<std::optional<double>(double factor)>& residual, int most_evaluations);

}  // namespace drape
