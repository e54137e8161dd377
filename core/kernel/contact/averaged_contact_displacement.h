#pragma once

#include <Eigen/Core>

#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// The weighted mean displacement [m] of the obstacle points that each vertex is in contact with.
class AveragedContactDisplacement {
 public:
  explicit AveragedContactDisplacement(Eigen::Index vertices)
      : weighted_(Positions::Zero(vertices, 3)), weights_(Eigen::VectorXd::Zero(vertices)) {}

  void add(int vertex, const Eigen::Vector3d& displacement, double weight) {
    weighted_.row(vertex) += weight * displacement;
    weights_[vertex] += weight;
  }
  /// Adds the mean to the rows of x (n×3) of vertices with contacts.
  void add_to(Positions& x) const {
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (weights_[v] > 0) x.row(v) += weighted_.row(v) / weights_[v];
  }

 private:
  Positions weighted_;
  Eigen::VectorXd weights_;
};

}  // namespace drape
