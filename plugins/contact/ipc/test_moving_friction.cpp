#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/model/active_contacts.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/evaluate.h"
#include "tests/support/moving_obstacles.h"

using namespace drape;
using namespace drape::ipc;
using Vector = Eigen::Vector3d;

namespace {

/// Force along x on a cloth with friction, less its barrier's [N].
double drag(ActiveContacts& contacts, const BoundContact& model, const Positions& x) {
  Positions all = Positions::Zero(x.rows(), 3);
  contacts.add_gradient(x, all);
  return (gradient_of(*collisions_at(model, x), x) - all).col(0).sum();
}

/// Force along x on a cloth at x with friction, less its barrier's, once its obstacles have moved [N].
double drag_between(const std::shared_ptr<const BoundContact>& before,
                    const std::shared_ptr<const BoundContact>& after, const Positions& x) {
  ActiveContacts contacts({before});
  contacts.begin_step(x);
  contacts.update_obstacles({after}, x, x);
  contacts.begin_step(x);
  return drag(contacts, *after, x);
}

/// Sum of the magnitudes of a model's forces along z [N].
double normal_force(const BoundContact& model, const Positions& x) {
  return gradient_of(*collisions_at(model, x), x).col(2).cwiseAbs().sum();
}

}  // namespace

TEST_CASE("ipc: touched points move with their obstacle") {
  const Level level = square_sheet(5, 0.2);
  const Positions x = resting(level);
  const Bodies from = {box({1, 0.5, 1}, {0.5, 0, -0.5})};  // below one half of the cloth
  Bodies to = from;
  to[0].translate += Vector(0.01, 0.003, 0);
  to[0].rotate.z() = 5;
  const auto before = bound(from, level, 0.3), after = bound(to, level, 0.3);
  const Eigen::Matrix3d turn = obstacle_of(to[0]).geometry.pose.linear();
  int above = 0;
  for (const auto& group : friction_contacts(*collisions_at(*before, x)))
    for (const FrictionContact& contact : group) {
      const int v = contact.vertices[0];
      if (contact.vertices[1] >= 0 || x(v, 0) < 1e-9) continue;
      ++above;
      const Vector own = Vector(x(v, 0), x(v, 1), 0) - from[0].translate;
      const Vector moved = turn * own + to[0].translate - (own + from[0].translate);
      CAPTURE(v);
      CHECK(contact.touched.obstacle == 0);
      CHECK((after->displacement(*before, contact.touched) - moved).norm() < 1e-12);
    }
  CHECK(above >= 10);
}

TEST_CASE("ipc: a sliding plate drags a cloth with μ times the normal force, however finely it is meshed") {
  const Level level = square_sheet(9, 0.2);
  const Positions x = resting(level);
  const Scratch folder;
  ObstacleParameters p;
  p.mesh = (folder / "plate.ply").string();
  for (const int columns : {2, 11, 41, 81}) {
    TriangleMesh plate = grid({0.8, 0.8}, columns, columns, Diagonals::criss_cross);
    plate.vertices.rowwise() -= Eigen::RowVector3d(0.403, 0.407, 0);
    write_mesh(p.mesh, plate);
    const auto at = [&](double shift) {
      p.translate.x() = shift;
      return bound({p}, level, 0.3);
    };
    for (const double shift : {1e-3, 1e-2, 0.1}) {
      CAPTURE(columns, shift);
      const auto after = at(shift);
      CHECK(drag_between(at(0), after, x) == Approx(0.3 * normal_force(*after, x)).epsilon(1e-6));
    }
  }
}

TEST_CASE("ipc: of two obstacles that a cloth lies between, the static one does not drag it along") {
  const Level level = square_sheet(9, 0.2);
  const Positions x = resting(level);
  const auto between = [&](double shift) {
    Bodies all = {box({1, 1, 1}, {0, 0, -0.5}), box({1, 1, 1}, {shift, 0, 0.5 + 8e-4})};
    all[0].friction = 1;
    all[1].friction = 0.1;
    return bound(all, level, 0.3);
  };
  const double pressed = normal_force(*bound({box({1, 1, 1}, {0, 0, -0.5})}, level), x);
  CHECK(drag_between(between(0), between(0.01), x) == Approx(0.1 * pressed).epsilon(1e-6));
}

TEST_CASE("ipc: contacts that form in a step have friction when the obstacle moves next") {
  const Level level = square_sheet(9, 0.2);
  const Positions x = resting(level), apart = x.rowwise() + Eigen::RowVector3d(0, 0, 1.6e-3);
  const auto at = [&](double shift) { return bound({box({1, 1, 1}, {shift, 0, -0.5})}, level, 0.3); };
  const auto after = at(0.01);
  ActiveContacts contacts({at(0)});
  contacts.begin_step(apart);
  contacts.max_step(apart, x);
  contacts.barrier(x);
  contacts.update_obstacles({after}, x, x);
  contacts.begin_step(x);
  CHECK(drag(contacts, *after, x) == Approx(0.3 * normal_force(*after, x)).epsilon(1e-6));
}
