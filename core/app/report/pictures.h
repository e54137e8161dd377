#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/app/picture/image.h"
#include "core/app/report/run_data.h"

namespace drape {

/// One picture of the report, as a PNG file's bytes.
struct Picture {
  Image image;
  std::string png;
};

/// All pictures of a run.
struct PictureSet {
  /// By file name in DIR/pictures, as the *_picture functions below give it.
  std::map<std::string, Picture> pictures;
  std::vector<std::string> notes;  ///< pictures that could not be drawn, one line each

  const Picture* find(const std::string& name) const;
};

/// Two levels of a method.
struct LevelPair {
  int coarse = 0, fine = 0;
};

std::string state_picture(const MethodRecord& method, int level);
std::string outline_picture(const MethodRecord& method, const LevelPair& levels);

/// The coarsest and the finest level with a final state; none for fewer than two.
std::optional<LevelPair> widest_levels(const MethodRecord& method);

/// Draws all pictures of a run, `width` (default: 900) pixels wide, and writes them to DIR/pictures. A
/// missing or unreadable mesh becomes a note. Once `cancelled` (may be empty) returns true, it skips the
/// remaining pictures, with a note. Throws std::runtime_error if the folder is not writable.
PictureSet draw_pictures(const RunData& run, const std::function<bool()>& cancelled = {},
                         std::optional<int> width = {});

}  // namespace drape
