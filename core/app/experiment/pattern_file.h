#pragma once

#include <filesystem>
#include <optional>

#include "core/numerics/sewing/pattern.h"

namespace drape {

/// Reads a sewing pattern: GarmentCode's JSON, or YAML of the same structure (pattern_parameters.h), in
/// metres. Nothing, with every error appended at its place in the file, for a faulty one.
std::optional<Pattern> read_pattern(const std::filesystem::path& file, ConfigErrors& errors);

}  // namespace drape
