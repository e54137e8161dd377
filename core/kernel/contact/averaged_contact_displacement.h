#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/kernel/contact/contact_kernel.h"
#include "core/kernel/mesh/triangle_mesh.h"

namespace drape {

/// The mean displacement [m] of the obstacle points that each vertex is in contact with, weighted by friction
/// force.
class AveragedContactDisplacement {
 public:
  explicit AveragedContactDisplacement(Eigen::Index vertices)
      : weighted_(Positions::Zero(vertices, 3)), weights_(Eigen::VectorXd::Zero(vertices)) {}

  void add(int vertex, const Eigen::Vector3d& displacement, double weight) {
    weighted_.row(vertex) += weight * displacement;
    weights_[vertex] += weight;
  }

  /// Adds the pairs with friction of cloth and obstacle within d̂ at x. `displacement(contact, at)` is that of
  /// the obstacle's nearest point; `at` has the positions of the pair's vertices.
  template <class Displacement>
  void add_pairs(const std::vector<ContactPair>& pairs, const Positions& x,
                 const Positions& obstacle_vertices, double dhat, const Displacement& displacement) {
    const auto is_cloth = [&](int v) { return v < x.rows(); };
    for (const ContactPair& pair : pairs) {
      const auto& v = pair.vertices;
      if ((is_cloth(v[0]) && is_cloth(v[3])) || pair.weight == 0 || pair.friction == 0) continue;
      const PairPositions at = positions_of(pair, x, obstacle_vertices);
      if (!is_within_dhat(pair, at, dhat)) continue;
      const Contact contact = contact_at(pair, at, dhat);
      const Eigen::Vector3d of_obstacle = displacement(contact, at);
      for (int k = 0; k < 4; ++k)
        if (is_cloth(v[k]))
          add(v[k], of_obstacle, std::abs(contact.closest.c[k]) * pair.friction * contact.pressure());
    }
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
