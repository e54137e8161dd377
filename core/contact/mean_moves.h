#pragma once

#include <Eigen/Core>

#include "core/mesh/triangle_mesh.h"

namespace drape {

/// How far vertices are taken along by what touches them: of each the mean over its contacts, by weight [m].
class MeanMoves {
 public:
  explicit MeanMoves(Eigen::Index vertices)
      : weighted_(Positions::Zero(vertices, 3)), weights_(Eigen::VectorXd::Zero(vertices)) {}

  void add(int vertex, const Eigen::Vector3d& move, double weight) {
    weighted_.row(vertex) += weight * move;
    weights_[vertex] += weight;
  }
  /// Moves the rows of x (n×3) that something was added for.
  void move(Positions& x) const {
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      if (weights_[v] > 0) x.row(v) += weighted_.row(v) / weights_[v];
  }

 private:
  Positions weighted_;
  Eigen::VectorXd weights_;
};

}  // namespace drape
