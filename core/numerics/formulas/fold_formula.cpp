#include "core/numerics/formulas/fold_formula.h"

#include <Eigen/Geometry>

#include "core/numerics/elements/rest_hinge.h"
#include "core/numerics/mesh/seams.h"

namespace drape {

std::vector<RestHinge> rest_hinges(const Level& level) {
  std::vector<RestHinge> hinges;
  for (Eigen::Index h = 0; h < level.hinges.rows(); ++h) {
    const auto d = rest_vectors(level, h);
    const RestSide first = rest_side(level.rest, level.topology, level.hinge_edges[h], 0);
    const double length = d[0].norm(), twice1 = d[0].cross(d[1]).norm(), twice2 = d[0].cross(d[2]).norm();
    RestHinge& rest = hinges.emplace_back();
    rest << DihedralAngle<double>(d.data()).angle(), length, twice1 / length, twice2 / length,
        (twice1 + twice2) / 2, (first.from + first.to) / 2;
    if (!rest.allFinite() || !(twice1 > 0) || !(twice2 > 0))
      throw std::runtime_error("a triangle at the edge of vertices " + std::to_string(level.hinges(h, 0)) +
                               " and " + std::to_string(level.hinges(h, 1)) + " of level " +
                               std::to_string(level.index) + " has no area at rest");
  }
  return hinges;
}

}  // namespace drape
