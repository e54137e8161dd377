#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/experiment/recorder.h"

namespace drape {

// What a recorder does with the files of its folder as a whole. All throw WriteError where a file cannot be
// written.

/// Text of which what is no UTF-8, as a file's name may be, is replaced.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// Seconds since 1970.
double wall_clock();

/// Of steps.csv and log.jsonl.
std::pair<std::uint64_t, std::uint64_t> file_sizes(const RunFolder& folder);
/// Takes off what was written to these after they had the sizes of the state.
void cut_files(const RunFolder& folder, const RecorderState& state);

/// Writes the rest shapes that are not as the scene has them, and gives their names.
std::vector<std::string> write_rest(const RunFolder& folder, const Scene& scene);

/// Throws std::runtime_error where steps.csv or log.jsonl is shorter than in the state.
void refuse_short_files(const RunFolder& folder, const RecorderState& state);

/// Says in the folder of a run that it was broken off, and why, as far as the folder can still be written to.
void record_broken_off(const RunFolder& folder, const std::string& cause);

}  // namespace drape
