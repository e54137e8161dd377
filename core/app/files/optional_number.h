#pragma once

#include <optional>

namespace drape {

/// A number of a run, absent if the run did not reach or measure it.
using OptionalNumber = std::optional<double>;

}  // namespace drape
