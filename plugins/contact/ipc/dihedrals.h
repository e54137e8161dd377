#pragma once

#include <Eigen/Core>

#include "plugins/contact/ipc/surface.h"

namespace drape {

/// How a surface bends at its edges and vertices.
struct Dihedrals {
  Eigen::VectorXd edge_angle;      ///< between the normals of its two triangles, 0 where flat to rounding;
                                   ///< π on the border [rad]
  Eigen::VectorXd edge_curvature;  ///< that over the mean height of the two triangles; 0 on the border [1/m]
  Eigen::VectorXd vertex_angle, vertex_curvature;  ///< the largest of its edges'
  std::vector<char> edge_on_border, vertex_on_border;

  static Dihedrals of(const Surface& surface, const Positions& vertices);

  /// How far the surface stands out of a cloth edge of this length that is laid across the edge [m].
  double edge_sagitta(int e, double length) const {
    return sagitta(edge_angle[e], edge_curvature[e], length);
  }
  double vertex_sagitta(int v, double length) const {
    return sagitta(vertex_angle[v], vertex_curvature[v], length);
  }

 private:
  static double sagitta(double angle, double curvature, double length);
};

/// Coefficients of the improved maximum operator (Li et al. 2023): what triangles, whose coefficients are 1,
/// count again along the edges and at the vertices that they share. In a function of the distance, summed
/// over triangles, less edges, plus vertices, a flat region of any triangulation counts once.
struct OperatorCoefficients {
  Eigen::VectorXd edge, vertex;

  /// Edges where the surface bends on the scale of the range count less, down to not at all: there are pits
  /// so narrow that a point sees all round them at once, for which the sum could turn to attraction.
  /// A vertex has the largest coefficient of its edges. So whatever is nearest to a point has 1 or more in
  /// all, and where coefficients are alike the sum is a mean of those with and without the operator.
  static OperatorCoefficients of(const Surface& surface, const Dihedrals& dihedrals, double range);
};

}  // namespace drape
