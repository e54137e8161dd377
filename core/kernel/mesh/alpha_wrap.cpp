// A file of its own, and the only one that calls CGAL's function: it takes a minute to compile.
#include "core/kernel/mesh/alpha_wrap.h"

#include <CGAL/alpha_wrap_3.h>

namespace drape {

SurfaceMesh alpha_wrap(const std::vector<ExactPredicates::Point_3>& points,
                       const std::vector<std::array<std::size_t, 3>>& triangles, double alpha,
                       double offset) {
  SurfaceMesh wrapped;
  CGAL::alpha_wrap_3(points, triangles, alpha, offset, wrapped);
  return wrapped;
}

}  // namespace drape
