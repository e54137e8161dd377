#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/app/run/recorder.h"

namespace drape {

/// A cell of a CSV file, to `digits` significant digits; empty for a number that is absent or not finite.
std::string number_cell(const std::optional<double>& value, int digits);

/// Status of a method that threw, and of its current level; no solver returns it.
inline constexpr const char* failed = "failed";

/// Name of a level's file in the run's folder, as in "levels/pcs_l2.ply".
std::string level_file(const std::string& method, int level, const char* extension);

/// Seconds since 1970.
double wall_clock();

// These throw WriteError.
std::uint64_t size_of_file(const std::filesystem::path& file);  ///< [bytes]
/// Makes a file that is to be appended to, of the first `bytes` of the one that is there. Returns its path. A
/// link, or a file with a second name, is replaced by a copy: the other file may be somebody else's.
std::filesystem::path own_file(const std::filesystem::path& file, std::uint64_t bytes);

/// Writes the rest shapes that differ from their files in a run's folder, and returns their names.
std::vector<std::string> write_rest(const std::filesystem::path& folder, const Scene& scene);
/// The warning that names files of a run that were written again.
std::string written_again_text(const std::vector<std::string>& files);

/// Throws std::runtime_error if iterations.csv or log.jsonl is shorter than in the state.
void refuse_short_files(const RunFolder& folder, const Recorder::State& state);

/// Records in the folder that the run was aborted, and why, as far as it is still writable.
void record_abort(const RunFolder& folder, const std::string& cause);

}  // namespace drape
