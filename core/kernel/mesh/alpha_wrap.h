#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace drape {

using ExactPredicates = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<ExactPredicates::Point_3>;

/// A closed surface around triangles, given by corners, that is free of self-intersections, `offset` [m] away
/// from them, and bridges holes that a ball of radius `alpha` [m] cannot enter (Portaneri et al. 2022). Its
/// removed elements are not yet collected.
SurfaceMesh alpha_wrap(const std::vector<ExactPredicates::Point_3>& points,
                       const std::vector<std::array<std::size_t, 3>>& triangles, double alpha, double offset);

}  // namespace drape
