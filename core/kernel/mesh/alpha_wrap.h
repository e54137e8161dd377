#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace drape {

using ExactPredicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<ExactPredicates::Point_3>;

/// A closed surface, free of self-intersections, at a distance of `offset` [m] around triangles of these
/// points. It closes holes that a ball of radius `alpha` [m] cannot enter (Portaneri et al. 2022). Elements
/// that it removed on the way are still stored; collect_garbage() drops them.
SurfaceMesh alpha_wrap(const std::vector<ExactPredicates::Point_3>& points,
                       const std::vector<std::array<std::size_t, 3>>& triangles, double alpha, double offset);

}  // namespace drape
