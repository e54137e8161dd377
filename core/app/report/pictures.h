#pragma once

#include <functional>
#include <map>
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

/// All pictures of a run, and the scales they share.
struct PictureSet {
  /// By file name in DIR/pictures, as the *_picture functions below give it.
  std::map<std::string, Picture> pictures;
  double H_difference_scale = 0;   ///< [1/m], end of the colour map, equal for all methods
  bool maps_on_rest = false;       ///< whether differences are drawn on the flat rest shape
  double fold_threshold = 0;       ///< [1/m], of |principal curvature|
  std::vector<std::string> notes;  ///< pictures that could not be drawn, one line each

  const Picture* find(const std::string& name) const;
};

/// Share of |H_c − H_f| within the colour map's range, and of |principal curvature| below the threshold
/// on the finest state of the first method.
inline constexpr double H_difference_quantile = 0.98;
inline constexpr double fold_quantile = 0.88;

std::string state_picture(const MethodRecord& method, int level);
std::string fold_picture(const MethodRecord& method, int level);
std::string H_difference_picture(const MethodRecord& method, const ConsistencyRecord& pair);

/// The pair whose curvature difference is shown: the coarsest against the finest level.
const ConsistencyRecord* widest_pair(const MethodRecord& method);

/// Draws all pictures of a run and writes them to DIR/pictures. A missing or unreadable mesh becomes a note.
/// Once `leave` (may be empty) returns true, it skips the remaining pictures, with a note. Throws
/// std::runtime_error if the folder is not writable.
PictureSet draw_pictures(const RunData& run, const std::function<bool()>& leave = {});

}  // namespace drape
