#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/app/run/recorder.h"
#include "core/kernel/version.h"
#include "core/numerics/solve/newton_state.h"

namespace drape {

/// Size and checksum of a file when a run read it.
struct FileFingerprint {
  std::string path;
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;
};

/// The complete state of a run: resuming from it gives the same results, bit for bit.
struct Checkpoint {
  /// drape's version and commit
  std::string program = "drape " + version() + " (" + commit() + ")";
  std::string config;                  ///< contents of config.yaml
  std::vector<FileFingerprint> files;  ///< files that the config names
  std::vector<std::string> methods;    ///< in the run's order
  int method = 0;                      ///< index of the current method
  MethodState state;
  int first_level = 0;  ///< first level of every method
  Positions start;      ///< of a warm start, on that level; empty without one
  Recorder::State recorder;
};

/// The checkpoint as bytes, with a checksum.
std::string encode(const Checkpoint& checkpoint);
/// The inverse of `encode`. Throws std::runtime_error for bytes that are damaged or of another format.
Checkpoint decode(std::string_view bytes);
/// The checkpoint's bytes without header and checksum, and back, for untrusted bytes. Every value that is
/// read is valid for its type; require_fitting checks it against an experiment.
std::string encode_body(const Checkpoint& checkpoint);
Checkpoint decode_body(std::string_view bytes);

/// Throws std::runtime_error unless every index and size fits the experiment's scene and every position is
/// finite.
void require_fitting(const Checkpoint& checkpoint, const Experiment& experiment, const Scene& scene);

/// Saves the checkpoint in the run's `folder` and flushes it to the disk. The previous checkpoint stays: one
/// of the two is complete at any moment. Throws WriteError.
void save_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// Whether the run in `folder` has a checkpoint, complete or not.
bool has_checkpoint(const std::filesystem::path& folder);

/// The newest complete checkpoint of the run in `folder`; a fall-back to the previous one appends a warning.
/// Throws std::runtime_error if there is none.
Checkpoint load_checkpoint(const std::filesystem::path& folder, std::vector<std::string>& warnings);

/// Removes the checkpoints of a complete run.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace drape
