#include "core/numerics/mesh/coincident_border.h"

#include <array>
#include <cmath>
#include <map>

namespace drape {

Coincidence coincident_border(const Level& level, double tolerance) {
  // Each border vertex is compared with those in the 27 cells around it, of a grid as fine as the tolerance.
  using Cell = std::array<double, 3>;
  const Positions& x = level.rest.vertices;
  std::multimap<Cell, int> seen;
  Coincidence found;
  for (int v = 0; v < level.vertex_count(); ++v) {
    if (!level.topology.on_border[v]) continue;
    Cell cell;
    for (int c = 0; c < 3; ++c) cell[c] = std::floor(x(v, c) / tolerance);
    int on = -1;
    for (int n = 0; n < 27 && on < 0; ++n) {
      const int offset[] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      const Cell near{cell[0] + offset[0], cell[1] + offset[1], cell[2] + offset[2]};
      const auto [begin, end] = seen.equal_range(near);
      for (auto it = begin; it != end && on < 0; ++it)
        if ((x.row(v) - x.row(it->second)).norm() < tolerance) on = it->second;
    }
    seen.emplace(cell, v);
    if (on < 0) continue;
    if (found.count++ == 0) found = {on, v, 1};
  }
  return found;
}

}  // namespace drape
