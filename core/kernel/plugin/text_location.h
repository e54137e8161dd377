#pragma once

#include <cstddef>

#include "core/kernel/plugin/config_node.h"

namespace drape {

/// The location of one byte of a scalar's text in the file that the text is from, whether it is plain, quoted
/// or a block of several lines; the scalar's own location where the file does not show it, as for an option.
Location location_in_text(const ConfigNode& scalar, std::size_t at);

}  // namespace drape
