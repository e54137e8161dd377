#pragma once

#include <filesystem>
#include <optional>

#include "core/kernel/plugin/config_node.h"
#include "core/numerics/sewing/pattern.h"

namespace drape {

/// Reads a sewing pattern: GarmentCode's JSON, or YAML of the same structure (pattern_parameters.h), in
/// metres. Nothing, with every error appended at its place in the file, for a faulty one.
std::optional<Pattern> read_pattern(const std::filesystem::path& file, ConfigErrors& errors);

/// The pattern of a file that has been read.
std::optional<Pattern> read_pattern(const ConfigNode& source, ConfigErrors& errors);

}  // namespace drape
