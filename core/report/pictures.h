#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/report/image.h"
#include "core/report/run_data.h"

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
  double H_difference_scale = 0;   ///< [1/m], the colour map's end, one for all methods
  bool maps_on_rest = false;       ///< whether differences are drawn on the flat rest shape
  double fold_threshold = 0;       ///< [1/m], of |principal curvature|
  std::vector<std::string> notes;  ///< what could not be drawn, one line each

  const Picture* find(const std::string& name) const;
};

/// Share of |H_c − H_f| within the colour map's range, and of |principal curvature| below the threshold
/// on the finest state of the first method.
inline constexpr double H_difference_quantile = 0.98;
inline constexpr double fold_quantile = 0.88;

std::string state_picture(const MethodRecord& method, int level);
std::string fold_picture(const MethodRecord& method, int level);
std::string H_difference_picture(const MethodRecord& method, const ConsistencyRecord& pair);

/// The pair whose curvature difference is shown: the coarsest level there is against the finest.
const ConsistencyRecord* widest_pair(const MethodRecord& method);

/// Draws everything there is data for and writes it to DIR/pictures. A mesh that is missing or cannot be
/// read becomes a note. Once `leave` (it may be empty) says so, what is left is not drawn, and a note says
/// how to draw it. Throws std::runtime_error if the folder cannot be written.
PictureSet draw_pictures(const RunData& run, const std::function<bool()>& leave = {});

}  // namespace drape
