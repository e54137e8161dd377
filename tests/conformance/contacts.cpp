#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"
#include "tests/support/conformance.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"

using namespace drape;

namespace {

/// Settings of every contact model that declares them: a d̂ comparable to the triangles of these tests' cloth,
/// and friction.
const std::vector<std::pair<std::string, std::string>> common = {
    {"dhat", "0.02"}, {"stiffness", "50"}, {"friction", "0.3"}, {"friction_smoothing_distance", "1e-3"}};

/// Two sheets, side by side at rest.
Level two_sheets(int vertices) {
  const TriangleMesh one = random_triangulation({0.5, 0.4}, vertices, 1),
                     other = random_triangulation({0.5, 0.4}, vertices, 2);
  return Level::of(0, both_of(one, other, {1, 0, 0}));
}

/// One sheet above the other, the lower one at z = 0; neither is quite flat.
Positions stacked(const Level& level, double gap, unsigned seed) {
  const Eigen::Index n = level.vertex_count(), lower = n / 2;
  Positions x = level.rest.vertices + noise(n, 0.1 * gap, seed);
  x.bottomRows(n - lower).col(0).array() -= 1;
  x.bottomRows(n - lower).col(2).array() += gap;
  return x;
}

/// Pushes the cloth down with noise, as far as gaps stay above 3 mm.
Positions pressed(const BoundContact& contact, Positions x, unsigned seed) {
  for (unsigned step = 0; step < 12; ++step) {
    Positions to = x + noise(x.rows(), 0.01, 100 * seed + step);
    to.col(2).array() -= 0.01;
    const auto candidates = contact.build_candidates(x, to);
    double part = candidates->max_step().fraction;
    while (part > 1e-3 && candidates->build_collisions(x + part * (to - x))->smallest_gap() < 3e-3)
      part *= 0.7;
    if (part > 1e-3) x += part * (to - x);
  }
  return x;
}

struct NamedModel {
  std::string name;
  std::shared_ptr<ContactModel> model;
  bool has_friction;
};

/// Every registered contact model except those without contact: all of them with the obstacles of their
/// conformance.yaml, or those that declare self-contact without obstacles.
std::vector<NamedModel> registered_models(bool with_obstacles) {
  std::vector<NamedModel> all;
  for (const RegistryEntry* entry : test_registry().of_kind("contact")) {
    if (!with_obstacles && !declares(*entry, "self_contact")) continue;
    const std::string own = with_obstacles ? conformance_parameters(*entry)["conformance"] : "";
    const auto model = make_plugin_from<ContactModel>(conformance_config(*entry, own, common));
    if (model->bind(two_sheets(20), Material()))
      all.push_back({entry->name, model, declares(*entry, "friction")});
  }
  REQUIRE(all.size() >= (with_obstacles ? 2u : 1u));
  return all;
}
std::vector<NamedModel> all_models() { return registered_models(true); }
std::vector<NamedModel> self_contact_models() { return registered_models(false); }

/// Those that declare friction.
std::vector<NamedModel> models_with_friction() {
  std::vector<NamedModel> all = all_models();
  std::erase_if(all, [](const NamedModel& named) { return !named.has_friction; });
  REQUIRE(all.size() >= 2);
  return all;
}

Positions raised(Positions x, double height) {
  x.col(2).array() += height;
  return x;
}

/// The height by which to raise x so that it clears the obstacles by 5 mm; 0 if it has no intersections.
double clearance(const BoundContact& contact, const Positions& x) {
  if (contact.intersections(x).empty()) return 0;
  double low = 0, high = 1e-3;
  while (!contact.intersections(raised(x, high)).empty()) {
    REQUIRE(high < 1e6);
    low = high;
    high *= 2;
  }
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (contact.intersections(raised(x, middle)).empty() ? high : low) = middle;
  }
  return high + 5e-3;
}

/// The sheets one above the other, above the obstacles.
Positions stacked(const Level& level, const BoundContact& contact, double gap, unsigned seed) {
  const Positions x = stacked(level, gap, seed);
  return raised(x, clearance(contact, x));
}

/// Runs the body at random states of every model with many contacts.
template <class Body>
void for_each_state(const std::vector<NamedModel>& models, const Body& body) {
  const Level level = two_sheets(40);
  const unsigned states = DRAPE_SANITIZED ? 1 : 3;
  for (const NamedModel& named : models) {
    const auto contact = named.model->bind(level, Material());
    for (unsigned seed = 1; seed <= states; ++seed) {
      INFO(named.name << ", state " << seed);
      const Positions x = pressed(*contact, stacked(level, *contact, 0.015, seed), seed);
      REQUIRE(contact->intersections(x).empty());
      REQUIRE(collisions_at(*contact, x)->contact_count() >= 20);
      body(*contact, x);
    }
  }
}

/// End states of motions from x that contact has to limit.
std::vector<Positions> adversarial(const Positions& x, unsigned seed) {
  const Eigen::RowVector3d middle = x.colwise().mean();
  const Eigen::Index n = x.rows(), lower = n / 2;
  std::vector<Positions> ends;
  for (const double size : {1e-4, 1e-2, 1.0, 100.0}) ends.push_back(x + noise(n, size, seed));
  for (const double down : {0.02, 0.2, 50.0}) ends.push_back(x.rowwise() - Eigen::RowVector3d(0, 0, down));
  ends.push_back(middle.replicate(n, 1));          // all to one point
  ends.push_back(2 * middle.replicate(n, 1) - x);  // and out on the other side
  Positions swapped = x;                           // each sheet to beyond the other
  swapped.topRows(lower).col(2).array() += 0.1;
  swapped.bottomRows(n - lower).col(2).array() -= 0.1;
  ends.push_back(swapped);
  Positions flipped = x;  // a half turn, all of it through the axis
  flipped.col(1) = 2 * middle.y() - x.col(1).array();
  flipped.col(2) = 2 * middle.z() - x.col(2).array();
  ends.push_back(flipped);
  Positions spike = x;  // a single vertex, far and through everything
  spike.row(seed % n) << 0.2, 0.2, -3;
  ends.push_back(spike);
  return ends;
}

}  // namespace

TEST_CASE("A contact energy's gradient is that of its value, its Hessian that of its gradient",
          "[conformance]") {
  for_each_state(all_models(), [](const BoundContact& contact, const Positions& x) {
    const auto set = collisions_at(contact, x);
    const Positions g = gradient_of(*set, x);
    const Eigen::MatrixXd h = dense(hessian_of(*set, x, Projection::none));
    REQUIRE(set->value(x) > 0);
    REQUIRE(g.norm() > 0);
    REQUIRE(h.norm() > 0);
    Positions sum = noise(x.rows(), 1, 9);
    const Positions before = sum;
    CHECK(set->add_gradient(x, sum) == Approx(set->value(x)).epsilon(1e-13));
    CHECK((sum - before - g).norm() <= 1e-13 * (g.norm() + before.norm()));
    const auto value = [&](const Positions& y) { return collisions_at(contact, y)->value(y); };
    const auto gradient = [&](const Positions& y) { return gradient_of(*collisions_at(contact, y), y); };
    CHECK((differences(value, x, 1e-6) - flat(g).transpose()).norm() <= 1e-7 * g.norm());
    // The Hessian jumps where a pair's nearest features change: so small a step meets no such place.
    CHECK((differences(gradient, x, 3e-8) - h).norm() <= 1e-8 * h.norm());
    CHECK((h - h.transpose()).norm() <= 1e-13 * h.norm());
  });
}

TEST_CASE("Projected Hessians of contacts are positive semidefinite", "[conformance]") {
  int indefinite = 0;
  for_each_state(all_models(), [&](const BoundContact& contact, const Positions& x) {
    indefinite += check_projections(*collisions_at(contact, x), x);
  });
  REQUIRE(indefinite > 0);  // else nothing was projected
}

TEST_CASE("Contact acts within dhat and not beyond", "[conformance]") {
  int tell_gaps = 0, silent = 0;
  for_each_state(all_models(), [&](const BoundContact& contact, const Positions& x) {
    const auto here = collisions_at(contact, x);
    std::vector<double> gaps;
    here->append_gaps(gaps);
    (gaps.empty() ? silent : tell_gaps) += 1;
    if (!gaps.empty()) {
      CHECK(static_cast<Eigen::Index>(gaps.size()) == here->stencils().rows());
      CHECK(std::ranges::min(gaps) == here->smallest_gap());
    }
    const Eigen::Index n = x.rows();
    int with = 0, without = 0;
    for (double lift = 0; lift < 0.05; lift += 1e-3) {
      Positions y = x;
      y.col(2).array() += lift;
      y.bottomRows(n - n / 2).col(2).array() += lift;
      const auto set = collisions_at(contact, y);
      const bool any = set->contact_count() > 0;
      (any ? with : without) += 1;
      CHECK(std::isfinite(set->smallest_gap()) == any);
      CHECK((set->value(y) > 0) == any);
      CHECK((gradient_of(*set, y).norm() > 0) == any);
      if (!any) CHECK(hessian_of(*set, y, Projection::clamp).values == std::vector<double>(9 * n, 0.0));
    }
    CHECK(with > 0);
    CHECK(without > 0);
    Positions far = x;
    far.col(2).array() += 10;
    far.bottomRows(n - n / 2).col(2).array() += 10;
    CHECK(collisions_at(contact, far)->contact_count() == 0);
    CHECK(contact.build_candidates(far, far)->max_step().fraction == 1);
  });
  CHECK(tell_gaps >= 2 * silent);  // the documents' example leaves gaps out, ipc and shapes do not
}

TEST_CASE("Self-contact is invariant under rigid motions", "[conformance]") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for_each_state(self_contact_models(), [&](const BoundContact& contact, const Positions& x) {
    const Positions moved = (x * turn.transpose()).rowwise() + Eigen::RowVector3d(0.3, -0.2, 0.7);
    const auto set = collisions_at(contact, x), turned = collisions_at(contact, moved);
    CHECK(turned->contact_count() == set->contact_count());
    CHECK(turned->smallest_gap() == Approx(set->smallest_gap()).epsilon(1e-10));
    CHECK(turned->value(moved) == Approx(set->value(x)).epsilon(1e-9));
    const Positions g = gradient_of(*set, x);
    CHECK((gradient_of(*turned, moved) - g * turn.transpose()).norm() <= 1e-9 * g.norm());
    CHECK(g.colwise().sum().norm() <= 1e-12 * g.norm());
  });
}

TEST_CASE("Contacts give the same bits with any number of threads", "[conformance]") {
  const Level level = two_sheets(2000);
  for (const NamedModel& named : all_models()) {
    INFO(named.name);
    same_with_any_threads([&] {
      const auto contact = named.model->bind(level, Material());
      Positions down = stacked(level, 0.012, 4);
      down.col(2).array() -= 0.004;
      Positions above = raised(down, 0.02);
      const double height = clearance(*contact, above);
      down = raised(down, height);
      above = raised(above, height);
      const auto candidates = contact->build_candidates(above, down);
      const double part = candidates->max_step().fraction;
      const Positions x = above + 0.9 * part * (down - above);
      const auto set = candidates->build_collisions(x);
      // From beside, so that friction acts on a level floor too.
      const auto friction = lagged_friction(*set, above.rowwise() + Eigen::RowVector3d(1e-3, 0, 0), {});
      REQUIRE((friction != nullptr) == named.has_friction);
      const Positions g = gradient_of(*set, x);
      REQUIRE(g.norm() > 0);
      std::vector<double> all = {part, set->smallest_gap(), set->value(x),
                                 static_cast<double>(set->contact_count()),
                                 static_cast<double>(contact->intersections(down).size())};
      all.insert(all.end(), g.data(), g.data() + g.size());
      if (friction) {
        const Positions f = gradient_of(*friction, x);
        REQUIRE(f.norm() > 0);
        all.push_back(friction->value(x));
        all.insert(all.end(), f.data(), f.data() + f.size());
      }
      for (const BoundEnergy* energy : std::initializer_list<const BoundEnergy*>{set.get(), friction.get()}) {
        if (!energy) continue;
        const std::vector<double> h = hessian_of(*energy, x, Projection::clamp).values;
        all.insert(all.end(), h.begin(), h.end());
      }
      return all;
    });
  }
}

TEST_CASE("No step of any motion lets an intersection through", "[conformance]") {
  int shortened = 0, full = 0;
  const Level level = two_sheets(40);
  for (const auto& models : {all_models(), self_contact_models()})
    for (const NamedModel& named : models) {
      const auto contact = named.model->bind(level, Material());
      Positions x = stacked(level, *contact, 0.015, 1);
      int crossing = 0;
      for (unsigned round = 1; round <= 12; ++round) {
        if (round % 4 == 0) x = stacked(level, *contact, 0.015, round);
        for (const Positions& to : adversarial(x, round)) {
          INFO(named.name << ", round " << round);
          const StepLimit limit = contact->build_candidates(x, to)->max_step();
          REQUIRE(limit.fraction >= 0);
          REQUIRE(limit.fraction <= 1);
          CHECK(limit.by.empty() == (limit.fraction == 1));
          (limit.fraction < 1 ? shortened : full) += 1;
          crossing += !contact->intersections(to).empty();
          for (const double part : {0.25, 0.5, 0.75, 1.0})
            REQUIRE(contact->intersections(x + part * limit.fraction * (to - x)).empty());
        }
        // Continue with smaller gaps.
        const Positions to = x + noise(x.rows(), 0.02, 1000 + round);
        x += contact->build_candidates(x, to)->max_step().fraction * (to - x);
      }
      CHECK(crossing > 12);
    }
  CHECK(shortened > 100);
  CHECK(full > 10);
}

TEST_CASE("Intersections are named, with a point near them", "[conformance]") {
  const Level level = two_sheets(40);
  for (const auto& models : {all_models(), self_contact_models()})
    for (const NamedModel& named : models) {
      INFO(named.name);
      const auto contact = named.model->bind(level, Material());
      Positions x = stacked(level, 0.015, 1);
      const double height = clearance(*contact, x);
      CHECK(contact->intersections(raised(x, height)).empty());
      x.col(2) *= 20;  // noise of 3 cm, more than what is between
      x.col(2).array() -= 0.02;
      x.bottomRows(x.rows() - x.rows() / 2).col(2).array() -= 0.3;
      x = raised(x, height);
      const std::vector<Intersection> found = contact->intersections(x);
      REQUIRE(!found.empty());
      for (const Intersection& intersection : found) {
        CHECK_THAT(intersection.first, Catch::StartsWith("cloth "));
        CHECK(!intersection.second.empty());
        CHECK((intersection.where.transpose().array() >= x.colwise().minCoeff().array() - 1e-9).all());
        CHECK((intersection.where.transpose().array() <= x.colwise().maxCoeff().array() + 1e-9).all());
      }
      for (const TriangleMesh& mesh : contact->obstacles()) CHECK(check_mesh(mesh).empty());
    }
}

TEST_CASE("Contacts keep unique keys and their tangential displacements between states", "[conformance]") {
  for_each_state(models_with_friction(), [](const BoundContact& contact, const Positions& x) {
    const Positions from = x - noise(x.rows(), 1e-4, 3), above = x.rowwise() + Eigen::RowVector3d(0, 0, 1e-3);
    const auto before = lagged_friction(*collisions_at(contact, x), from, {});
    REQUIRE(before);
    const TangentialDisplacements displacements = before->tangential_displacements(x);
    CHECK(std::ranges::adjacent_find(displacements, {}, &TangentialDisplacement::contact) ==
          displacements.end());
    const Positions f = gradient_of(*before, x);
    REQUIRE(f.norm() > 0);
    const auto again =
        lagged_friction(*contact.build_candidates(x, above)->build_collisions(x), x, displacements);
    CHECK((gradient_of(*again, x) - f).norm() <= 1e-9 * f.norm());
  });
}

TEST_CASE("Friction opposes motion and is zero without it", "[conformance]") {
  for_each_state(models_with_friction(), [](const BoundContact& contact, const Positions& x) {
    const auto set = collisions_at(contact, x);
    const auto friction = lagged_friction(*set, x, {});
    REQUIRE(friction);
    CHECK(friction->value(x) == 0);
    CHECK(gradient_of(*friction, x).norm() == 0);
    const double normal_force = gradient_of(*set, x).norm();
    for (const double size : {1e-5, 1e-3, 1e-1}) {  // sticking, in between, sliding
      const Positions moved = noise(x.rows(), size, 7), y = x + moved, g = gradient_of(*friction, y);
      INFO("moved by " << size);
      CHECK(g.cwiseProduct(moved).sum() > 0);
      CHECK(friction->value(y) > 0);
      CHECK(g.norm() > (size > 1e-4 ? 0.01 : 1e-6) * normal_force);
      CHECK_FALSE(check_projections(*friction, y));
      CHECK((gradient_by_differences(*friction, y, 1e-8) - flat(g)).norm() <= 1e-4 * g.norm());
    }
    // The whole cloth slides over what does not move; its parts do not slide over each other.
    const Positions slid = x.rowwise() + Eigen::RowVector3d(0.05, 0, 0);
    const Eigen::RowVector3d force = -gradient_of(*friction, slid).colwise().sum();
    CHECK(force.x() < 0);
  });
  for_each_state(self_contact_models(), [](const BoundContact& contact, const Positions& x) {
    const auto friction = lagged_friction(*collisions_at(contact, x), x, {});
    REQUIRE(friction);
    const Positions slid = x.rowwise() + Eigen::RowVector3d(0.05, 0, 0);
    Positions apart = x;
    apart.topRows(x.rows() / 2).col(0).array() += 0.05;
    const Positions g = gradient_of(*friction, apart);
    CHECK(gradient_of(*friction, slid).norm() <= 1e-9 * g.norm());
    CHECK(g.topRows(x.rows() / 2).col(0).sum() > 0);
    CHECK(g.colwise().sum().norm() <= 1e-10 * g.norm());
  });
}
