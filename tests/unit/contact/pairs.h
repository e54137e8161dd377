#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "core/numerics/contact/additive_ccd.h"
#include "core/numerics/contact/pair_contacts.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"

// Pairs of primitives, and checks of the energies of contacts.

inline drape::PairPositions pair_at(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  drape::PairPositions x;
  x << a, b, c, d;
  return x;
}

/// Coordinates that are independent normal numbers.
inline drape::PairPositions random_pair(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return drape::PairPositions::NullaryExpr([&] { return normal(random); });
}

/// Moves the point, or the second edge, until points within both sides, chosen by s and t in [0, 1], are this
/// far apart [m]. Returns the direction from the second side to the first.
inline Eigen::Vector3d bring_near(drape::PairKind kind, drape::PairPositions& x, double s, double t,
                                  double gap) {
  if (kind == drape::PairKind::edge_edge) {
    const Eigen::Vector3d u = x.col(1) - x.col(0), v = x.col(3) - x.col(2), n = u.cross(v).normalized();
    x.col(2) = x.col(0) + s * u - t * v - gap * n;
    x.col(3) = x.col(2) + v;
    return n;
  }
  const Eigen::Vector3d u = x.col(2) - x.col(1), v = x.col(3) - x.col(1), n = u.cross(v).normalized();
  x.col(0) = x.col(1) + s * (1 - t) * u + s * t * v + gap * n;
  return n;
}

/// Gradient and Hessian at x of the energy that at(x) points to, against differences with step h.
template <class At>
void check_energy_derivatives(const At& at, const drape::Positions& x, double h, double gradient_tolerance,
                              double hessian_tolerance) {
  const auto energy = at(x);
  const drape::Positions g = gradient_of(*energy, x);
  const Eigen::MatrixXd hessian = dense(hessian_of(*energy, x, drape::Projection::none));
  REQUIRE(g.norm() > 0);
  REQUIRE(hessian.norm() > 0);
  const auto value = [&](const drape::Positions& y) { return at(y)->value(y); };
  const auto gradient = [&](const drape::Positions& y) { return gradient_of(*at(y), y); };
  CHECK((differences(value, x, h).transpose() - flat(g)).norm() <= gradient_tolerance * g.norm());
  CHECK((differences(gradient, x, h) - hessian).norm() <= hessian_tolerance * hessian.norm());
}

/// Projections of an energy of one element against Eigen's of the whole matrix. Returns the smallest
/// eigenvalue over the norm before.
inline double check_whole_projections(const drape::BoundEnergy& energy, const drape::Positions& x) {
  const Eigen::MatrixXd whole = dense(hessian_of(energy, x, drape::Projection::none));
  const Eigenpairs eigen = eigenpairs_of(whole);
  for (const auto projection : {drape::Projection::clamp, drape::Projection::absolute}) {
    const Eigen::MatrixXd projected = dense(hessian_of(energy, x, projection));
    CHECK((projected - recomposed(eigen, projection)).norm() <= 1e-10 * whole.norm());
    const double smallest = eigenvalues_of(projected)[0];
    CHECK(smallest >= -1e-12 * whole.norm());
  }
  return eigen.values[0] / whole.norm();
}
