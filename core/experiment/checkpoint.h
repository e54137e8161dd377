#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/experiment/recorder.h"
#include "core/numerics/newton_state.h"

namespace drape {

/// What was in a file when a run read it.
struct FileFingerprint {
  std::string path;
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;
};

/// The whole state of a run: all that it takes to go on and to end with the same bits.
struct Checkpoint {
  std::string program;                 ///< drape's version and commit
  std::string config;                  ///< what config.yaml holds
  std::vector<FileFingerprint> files;  ///< that the config names
  std::vector<std::string> methods;    ///< of the run, in order
  int method = 0;                      ///< the one under way, an index of `methods`
  bool all_converged = true;           ///< in the methods before it
  MethodState state;
  int first_level = 0;                 ///< where every method begins
  std::optional<Positions> own_start;  ///< on that level, where it is not the scene's
  RecorderState recorder;
};

/// As bytes, with a checksum; nothing of it depends on what the file is called.
std::string encode(const Checkpoint& checkpoint);
/// Throws std::runtime_error that says what is wrong with the bytes.
Checkpoint decode(std::string_view bytes);
/// What `decode` does once the checksum fits: the bytes after the header, from whoever wrote them. Every
/// value is one of its type afterwards; whether it makes sense for an experiment is another question
/// (require_fitting).
Checkpoint decode_body(std::string_view bytes);
/// How many bytes `encode` puts before those.
extern const std::size_t checkpoint_header_size;

/// Throws std::runtime_error unless every index and size in it is one of the experiment's scene, and every
/// position is finite.
void require_fitting(const Checkpoint& checkpoint, const Experiment& experiment, const Scene& scene);

/// Saves the state of the run in `folder`, on the disk before it returns. The last one saved is kept as well,
/// and at any moment one of the two is whole. Throws WriteError.
void save_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// The newest whole checkpoint of the run in `folder`; `warning` says why an older one, if it is that. Throws
/// std::runtime_error where there is none.
Checkpoint load_checkpoint(const std::filesystem::path& folder, std::string& warning);

/// Of a run that has ended.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace drape
