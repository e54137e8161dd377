#include "core/numerics/contact/vertex_contacts.h"

#include <Eigen/Geometry>
#include <limits>

#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/friction.h"
#include "tests/support/kernel_check.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

constexpr double radius = 0.1, weight = 2e-4, friction_coefficient = 0.3;
constexpr BarrierParameters parameters = {1e-2, 50, 1e-5};

/// Vertices near a sphere about the origin.
std::unique_ptr<Collisions> near_sphere(const Positions& x, double friction = friction_coefficient) {
  std::vector<VertexContact> contacts;
  for (int i = 0; i < x.rows(); ++i) {
    const Vector3d p = x.row(i);
    const double length = p.norm();
    if (length - radius < parameters.dhat)
      contacts.push_back({i,
                          7,
                          weight,
                          friction,
                          {length - radius, p / length, p.unitOrthogonal().normalized(),
                           Eigen::Vector2d::Constant(1 / length)}});
  }
  return make_vertex_contacts(std::move(contacts), parameters);
}

/// Three vertices within d̂, one beyond.
Positions some_vertices() {
  Positions x(4, 3);
  x << 0.06, 0.05, 0.07, -0.02, 0.1, 0.01, 0.01, -0.03, -0.1, 0.2, 0, 0;
  return x;
}

}  // namespace

TEST_CASE("vertex contacts: the barrier and its derivatives") {
  const Positions x = some_vertices();
  const auto collisions = near_sphere(x);
  REQUIRE(collisions->contact_count() == 3);
  double expected = 0, smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double gap = x.row(i).norm() - radius;
    expected += parameters.stiffness * weight * parameters.dhat * barrier(gap / parameters.dhat).value;
    smallest = std::min(smallest, gap);
  }
  CHECK(collisions->value(x) == Approx(expected));
  CHECK(collisions->smallest_gap() == smallest);
  const Positions g = gradient_of(*collisions, x);
  const Eigen::MatrixXd h = dense(hessian_of(*collisions, x, Projection::none));
  REQUIRE(g.norm() > 0);
  CHECK(g.row(3).norm() == 0);
  const auto value = [](const Positions& y) { return near_sphere(y)->value(y); };
  const auto gradient = [](const Positions& y) { return gradient_of(*near_sphere(y), y); };
  CHECK((differences(value, x, 1e-7) - flat(g).transpose()).norm() <= 1e-6 * g.norm());
  CHECK((differences(gradient, x, 1e-7) - h).norm() <= 1e-6 * h.norm());
  const auto lowest = [&](Projection projection) {
    const Eigen::MatrixXd matrix = dense(hessian_of(*collisions, x, projection));
    return eigenvalues_of(matrix)[0];
  };
  CHECK(lowest(Projection::none) < -1e-3 * h.norm());
  CHECK(lowest(Projection::clamp) >= -1e-12 * h.norm());
}

TEST_CASE("vertex contacts: friction is μ times the normal force, against the motion") {
  const Positions x = some_vertices();
  const auto collisions = near_sphere(x);
  const Positions normal_forces = gradient_of(*collisions, x);
  Positions to = x;
  to.col(0).array() += 1e-3;
  const auto friction = lagged_friction(*collisions, x, {});
  REQUIRE(friction);
  const Positions f = gradient_of(*friction, to);
  for (int i = 0; i < 3; ++i) {
    const Vector3d n = x.row(i).normalized(), along = Vector3d::UnitX() - n.x() * n;
    const double force = friction_coefficient * normal_forces.row(i).norm();
    REQUIRE(force > 0);
    CHECK((Vector3d(f.row(i)) - force * along.normalized()).norm() <= 1e-9 * force);
  }
  CHECK(f.row(3).norm() == 0);
  CHECK(lagged_friction(*near_sphere(x, 0), x, {}) == nullptr);
}

TEST_CASE("vertex contacts have the same bits with any number of threads") {
  Positions x(5000, 3);
  for (int i = 0; i < x.rows(); ++i) {
    const double angle = 0.01 * i, height = 2.0 * i / x.rows() - 1;
    const Vector3d direction(std::cos(angle) * std::sqrt(1 - height * height),
                             std::sin(angle) * std::sqrt(1 - height * height), height);
    x.row(i) = (radius + 5e-3 + 4e-3 * std::sin(7 * angle)) * direction.transpose();
  }
  REQUIRE(near_sphere(x)->contact_count() == 5000);
  check_threads(*near_sphere(x), x);
}
