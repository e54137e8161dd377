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

/// What the pictures of one field that a metric declares have in common.
struct FieldPictures {
  MetricPicture declared;
  double scale = 0;      ///< end of the colour map, or the threshold, in the field's unit; 0 without a field
  bool on_rest = false;  ///< whether differences are drawn on the flat rest shape
};

/// All pictures of a run, and the scales they share.
struct PictureSet {
  /// By file name in DIR/pictures, as the *_picture functions below give it.
  std::map<std::string, Picture> pictures;
  std::vector<FieldPictures> fields;  ///< in the order of declaration
  std::vector<std::string> notes;     ///< pictures that could not be drawn, one line each

  const Picture* find(const std::string& name) const;
};

/// Share of a difference's magnitudes within the colour map's range, and of a field's below the threshold on
/// the finest state of the first method.
inline constexpr double difference_quantile = 0.98;
inline constexpr double threshold_quantile = 0.88;

/// Two levels of a method.
struct LevelPair {
  int coarse = 0, fine = 0;
};

std::string state_picture(const MethodRecord& method, int level);
std::string outline_picture(const MethodRecord& method, const LevelPair& levels);
std::string threshold_picture(const MetricPicture& picture, const MethodRecord& method, int level);
std::string difference_picture(const MetricPicture& picture, const MethodRecord& method,
                               const ConsistencyRecord& pair);

/// The pair whose difference is shown: the coarsest against the finest level.
const ConsistencyRecord* widest_pair(const MethodRecord& method);

/// The coarsest and the finest level with a final state; none for fewer than two.
std::optional<LevelPair> widest_levels(const MethodRecord& method);

/// Draws all pictures of a run, `width` (default: 900) pixels wide, and writes them to DIR/pictures. A
/// missing or unreadable mesh becomes a note. Once `cancelled` (may be empty) returns true, it skips the
/// remaining pictures, with a note. Throws std::runtime_error if the folder is not writable.
PictureSet draw_pictures(const RunData& run, const std::function<bool()>& cancelled = {},
                         std::optional<int> width = {});

}  // namespace drape
