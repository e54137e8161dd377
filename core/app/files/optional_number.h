#pragma once

#include <cmath>
#include <optional>

namespace drape {

/// A number of a run, absent if the run did not reach or measure it.
using OptionalNumber = std::optional<double>;

/// Absent unless the number is finite.
inline OptionalNumber finite(double value) {
  return std::isfinite(value) ? OptionalNumber(value) : std::nullopt;
}

}  // namespace drape
