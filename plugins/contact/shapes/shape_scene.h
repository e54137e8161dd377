#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/collision_detection/box_tree.h"
#include "core/numerics/collision_detection/surface.h"
#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/contact_forces/barrier.h"
#include "plugins/contact/shapes/features.h"
#include "plugins/contact/shapes/separation.h"

namespace drape::shapes {

/// The cloth of one level at rest and its solids. Immutable.
struct ShapeScene {
  Surface cloth;
  Eigen::VectorXd vertex_area;  ///< the level's [m²]
  double diagonal = 0;          ///< of the rest shape's bounding box [m]

  std::vector<Solid> solids;
  std::shared_ptr<const SolidFeatures> features;  ///< of the solids; all levels share them
  BarrierParameters barrier;
  double min_gap_fraction = 0.1;

  static ShapeScene of(const Level& level, const std::vector<Solid>& solids,
                       std::shared_ptr<const SolidFeatures> features, const BarrierParameters& barrier,
                       double min_gap_fraction);

  Corners corners(int triangle, const Positions& x) const {
    const auto v = cloth.triangles.row(triangle);
    return {x.row(v[0]), x.row(v[1]), x.row(v[2])};
  }
};

/// A triangle or a vertex of the cloth and a solid that may come within d̂ of each other.
struct SolidPair {
  int element, solid;
};

/// The boxes of the balls that bound the triangles in the linear motion from x0 to x1.
BoxTree tree_of_triangles(const ShapeScene& scene, const Positions& x0, const Positions& x1);

/// The separation of the triangle at x that is nearest to the solid; `triangles` is their tree at x.
SeparatingPlane nearest_triangle(const ShapeScene& scene, const Solid& solid, const BoxTree& triangles,
                                 const Positions& x);

/// The triangles that may come within d̂ of a solid during the linear motion from x0 to x1, grouped by solid.
std::vector<SolidPair> find_triangles(const ShapeScene& scene, const Positions& x0, const Positions& x1);

/// The candidate pairs of a linear motion.
struct CandidatePairs {
  std::vector<SolidPair> vertices;
  std::vector<ContactPair> pairs;
  std::vector<ContactPair> curved_sides;  ///< a cylinder's axis and an edge of the cloth (RimContact)
};

/// The candidate pairs of these triangles during the linear motion from x0 to x1.
CandidatePairs find_candidates(const ShapeScene& scene, const std::vector<SolidPair>& triangles,
                               const Positions& x0, const Positions& x1);

/// Contact of a level's cloth with solids. Reported gaps are distances of cloth triangles to solids.
/// README.md describes the barrier's pairs of vertices, edges and triangles.
std::unique_ptr<BoundContact> bind_shapes(ShapeScene scene);

}  // namespace drape::shapes
