#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// A scalar field that the viewer can show.
struct FieldKind {
  std::string name, label, unit;
  std::string map;           ///< "diverging" about 0, "sequential" from 1, "force" from 0, "near" close to 0
  std::string note;          ///< below the legend
  double low = 0, high = 0;  ///< of the colours
};
/// The fields that the viewer computes from positions, and the contact forces that runs record; of a cloth
/// that is worn also what a garment maker looks at, `garment_fields_at`.
std::vector<FieldKind> field_kinds(bool worn);

/// Values by the name of their kind.
using SurfaceFields = std::map<std::string, Eigen::VectorXd>;

/// n distances to the nearest triangle of the obstacles, or of the cloth itself farther away than three
/// ranges at rest [m]; NaN beyond `range`. For an obstacle in closed form, the distance to its displayed
/// mesh.
Eigen::VectorXd contact_gap(const Level& level, const Positions& x,
                            const std::vector<TriangleMesh>& obstacles, double range);

/// The colour range of a kind: nearly all values lie inside.
std::pair<double, double> field_range(const FieldKind& kind,
                                      const std::vector<const Eigen::VectorXd*>& values, double gap_range);

/// m×2 stretches of the triangles along warp and along weft [%]; 0 is unstretched.
Eigen::MatrixX2d stretch_percent(const Level& level, const Positions& x);

/// Fields of a worn cloth: `stretch_warp` and `stretch_weft` [%], means over the triangles around a vertex,
/// on both sides of a seam, and `ease` [mm], the distance to the body, NaN beyond 60 mm, the last.
VertexFields garment_fields_at(const Level& level, const Positions& x,
                               const std::vector<TriangleMesh>& obstacles);

}  // namespace drape
