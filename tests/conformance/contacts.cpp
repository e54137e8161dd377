#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/mesh/check.h"
#include "tests/conformance/contact_states.h"
#include "tests/conformance/meshes.h"
#include "tests/support/any_threads.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"

using namespace drape;
using namespace contact_states;

namespace {

/// End states of motions from x that contact has to limit.
std::vector<Positions> adversarial(const Positions& x, unsigned seed) {
  const Eigen::RowVector3d middle = x.colwise().mean();
  const Eigen::Index n = x.rows();
  std::vector<Positions> ends;
  for (const double size : {1e-4, 1e-2, 1.0, 100.0}) ends.push_back(x + noise(n, size, seed));
  for (const double down : {0.02, 0.2, 50.0}) ends.push_back(raised(x, -down));
  ends.push_back(middle.replicate(n, 1));          // all to one point
  ends.push_back(2 * middle.replicate(n, 1) - x);  // and out on the other side
  Positions swapped = raised(x, 0.1);              // each sheet to beyond the other
  upper(swapped).col(2).array() -= 0.2;
  Positions flipped = x;  // a half turn, all of it through the axis
  for (const int axis : {1, 2}) flipped.col(axis) = 2 * middle[axis] - x.col(axis).array();
  Positions spike = x;  // a single vertex, far and through everything
  spike.row(seed % n) << 0.2, 0.2, -3;
  for (const Positions& end : {swapped, flipped, spike}) ends.push_back(end);
  return ends;
}

}  // namespace

TEST_CASE("A contact energy has the derivatives of its value, and semidefinite projected Hessians") {
  int indefinite = 0;
  for_each_state(all_models(), [&](const BoundContact& contact, const Positions& x) {
    const auto set = collisions_at(contact, x);
    const Positions g = gradient_of(*set, x);
    const Eigen::MatrixXd h = dense(hessian_of(*set, x, Projection::none));
    REQUIRE(set->value(x) > 0);
    REQUIRE(g.norm() > 0);
    REQUIRE(h.norm() > 0);
    const Positions before = noise(x.rows(), 1, 9);
    Positions sum = before;
    CHECK(set->add_gradient(x, sum) == Approx(set->value(x)).epsilon(1e-13));
    CHECK((sum - before - g).norm() <= 1e-13 * (g.norm() + before.norm()));
    const auto value = [&](const Positions& y) { return collisions_at(contact, y)->value(y); };
    const auto gradient = [&](const Positions& y) { return gradient_of(*collisions_at(contact, y), y); };
    CHECK((differences(value, x, 1e-6) - flat(g).transpose()).norm() <= 1e-7 * g.norm());
    // The Hessian jumps where a pair's nearest features change: so small a step meets no such place.
    CHECK((differences(gradient, x, 3e-8) - h).norm() <= 1e-8 * h.norm());
    CHECK((h - h.transpose()).norm() <= 1e-13 * h.norm());
    indefinite += check_projections(*set, x);
  });
  REQUIRE(indefinite > 0);  // else nothing was projected
}

TEST_CASE("Contact acts within dhat and not beyond, whatever motion has led there") {
  bool told_gaps = false;
  for_each_state(all_models(), [&](const BoundContact& contact, const Positions& x) {
    const auto here = collisions_at(contact, x);
    std::vector<double> gaps;
    here->append_gaps(gaps);
    if (gaps.empty()) {
      CHECK(contact.dhat() == 0);  // only a model without a barrier may leave them out
    } else {
      told_gaps = true;
      CHECK(static_cast<Eigen::Index>(gaps.size()) == here->stencils().rows());
      CHECK(std::ranges::min(gaps) == here->smallest_gap());
    }
    const Positions g = gradient_of(*here, x);
    const auto underway = contact.build_candidates(raised(x, 0.01), raised(x, -0.03))->build_collisions(x);
    CHECK(underway->contact_count() == here->contact_count());
    CHECK(underway->value(x) == Approx(here->value(x)).epsilon(1e-12));
    CHECK((gradient_of(*underway, x) - g).norm() <= 1e-12 * g.norm());
    int with = 0, without = 0;
    for (double lift = 0; lift < 0.05; lift += 1e-3) {
      const Positions y = raised_apart(x, lift);
      const auto set = collisions_at(contact, y);
      const bool any = set->contact_count() > 0;
      (any ? with : without) += 1;
      CHECK(std::isfinite(set->smallest_gap()) == any);
      CHECK((set->value(y) > 0) == any);
      CHECK((gradient_of(*set, y).norm() > 0) == any);
      if (!any)
        CHECK(hessian_of(*set, y, Projection::clamp).values == std::vector<double>(9 * x.rows(), 0.0));
    }
    CHECK(with > 0);
    CHECK(without > 0);
    const Positions far = raised_apart(x, 10);
    CHECK(collisions_at(contact, far)->contact_count() == 0);
    CHECK(contact.build_candidates(far, far)->max_step().fraction == 1);
  });
  CHECK(told_gaps);
}

TEST_CASE("Self-contact is invariant under rigid motions, and rubs where sheets slide over each other") {
  for_each_state(self_contact_models(), [&](const BoundContact& contact, const Positions& x) {
    const Positions moved = (x * some_turn.transpose()).rowwise() + Eigen::RowVector3d(0.3, -0.2, 0.7);
    const auto set = collisions_at(contact, x), turned = collisions_at(contact, moved);
    CHECK(turned->contact_count() == set->contact_count());
    CHECK(turned->smallest_gap() == Approx(set->smallest_gap()).epsilon(1e-10));
    CHECK(turned->value(moved) == Approx(set->value(x)).epsilon(1e-9));
    const Positions g = gradient_of(*set, x);
    CHECK((gradient_of(*turned, moved) - g * some_turn.transpose()).norm() <= 1e-9 * g.norm());
    CHECK(g.colwise().sum().norm() <= 1e-12 * g.norm());

    const auto friction = lagged_friction(*set, x, {});
    REQUIRE(friction);
    Positions apart = x;
    apart.topRows(x.rows() / 2).col(0).array() += 0.05;
    const Positions f = gradient_of(*friction, apart), slid = x.rowwise() + Eigen::RowVector3d(0.05, 0, 0);
    CHECK(gradient_of(*friction, slid).norm() <= 1e-9 * f.norm());
    CHECK(f.topRows(x.rows() / 2).col(0).sum() > 0);
    CHECK(f.colwise().sum().norm() <= 1e-10 * f.norm());
  });
}

TEST_CASE("Contacts give the same bits with any number of threads") {
  const Level level = two_sheets(2000);
  for (const NamedModel& named : all_models()) {
    INFO(named.name);
    same_with_any_threads([&] {
      const auto contact = named.model->bind(level, Material());
      Positions above = raised(stacked(level, 0.012, 4), 0.016);
      above = raised(above, clearance(*contact, above));
      const Positions down = raised(above, -0.02);
      const auto candidates = contact->build_candidates(above, down);
      const double part = candidates->max_step().fraction;
      const Positions x = above + 0.9 * part * (down - above);
      const auto set = candidates->build_collisions(x);
      // From beside, so that friction acts on a level floor too.
      const auto friction = lagged_friction(*set, above.rowwise() + Eigen::RowVector3d(1e-3, 0, 0), {});
      REQUIRE((friction != nullptr) == named.has_friction);
      std::vector<double> all = {part, set->smallest_gap(), static_cast<double>(set->contact_count()),
                                 static_cast<double>(contact->intersections(down).size())};
      for (const BoundEnergy* energy : std::initializer_list<const BoundEnergy*>{set.get(), friction.get()}) {
        if (!energy) continue;
        const Positions g = gradient_of(*energy, x);
        REQUIRE(g.norm() > 0);
        all.push_back(energy->value(x));
        all.insert(all.end(), g.data(), g.data() + g.size());
        const std::vector<double> h = hessian_of(*energy, x, Projection::clamp).values;
        all.insert(all.end(), h.begin(), h.end());
      }
      return all;
    });
  }
}

TEST_CASE("No step of any motion lets an intersection through") {
  int shortened = 0, full = 0;
  for_each_model([&](const Level& level, const BoundContact& contact) {
    Positions x = stacked(level, contact, 0.015, 1);
    int crossing = 0;
    for (unsigned round = 1; round <= 12; ++round) {
      if (round % 4 == 0) x = stacked(level, contact, 0.015, round);
      for (const Positions& to : adversarial(x, round)) {
        INFO("round " << round);
        const StepLimit limit = contact.build_candidates(x, to)->max_step();
        REQUIRE(limit.fraction >= 0);
        REQUIRE(limit.fraction <= 1);
        CHECK(limit.by.empty() == (limit.fraction == 1));
        (limit.fraction < 1 ? shortened : full) += 1;
        crossing += !contact.intersections(to).empty();
        for (const double part : {0.25, 0.5, 0.75, 1.0})
          REQUIRE(contact.intersections(x + part * limit.fraction * (to - x)).empty());
      }
      // Continue with smaller gaps.
      const Positions to = x + noise(x.rows(), 0.02, 1000 + round);
      x += contact.build_candidates(x, to)->max_step().fraction * (to - x);
    }
    CHECK(crossing > 12);
  });
  CHECK(shortened > 100);
  CHECK(full > 10);
}

TEST_CASE("Intersections are named, with a point near them") {
  for_each_model([](const Level& level, const BoundContact& contact) {
    Positions x = stacked(level, 0.015, 1);
    const double height = clearance(contact, x);
    CHECK(contact.intersections(raised(x, height)).empty());
    x.col(2) *= 20;  // noise of 3 cm, more than what is between
    upper(x).col(2).array() -= 0.3;
    x = raised(x, height - 0.02);
    const std::vector<Intersection> found = contact.intersections(x);
    REQUIRE(!found.empty());
    for (const Intersection& intersection : found) {
      CHECK_THAT(intersection.first, Catch::StartsWith("cloth "));
      CHECK(!intersection.second.empty());
      CHECK((intersection.where.transpose().array() >= x.colwise().minCoeff().array() - 1e-9).all());
      CHECK((intersection.where.transpose().array() <= x.colwise().maxCoeff().array() + 1e-9).all());
    }
    for (const TriangleMesh& mesh : contact.obstacles()) CHECK(check_mesh(mesh).empty());
  });
}

TEST_CASE("Friction opposes motion and is zero without it, and contacts keep their displacements") {
  int rubbing = 0;
  for_each_state(all_models(), [&](const BoundContact& contact, const Positions& x) {
    const auto set = collisions_at(contact, x);
    const auto friction = lagged_friction(*set, x, {});
    if (!friction) return;  // of a model without it; the test of threads holds that no other lacks it
    ++rubbing;
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
    CHECK(gradient_of(*friction, slid).col(0).sum() > 0);

    const auto before = lagged_friction(*set, x - noise(x.rows(), 1e-4, 3), {});
    const TangentialDisplacements displacements = before->tangential_displacements(x);
    CHECK(std::ranges::adjacent_find(displacements, {}, &TangentialDisplacement::contact) ==
          displacements.end());
    const Positions f = gradient_of(*before, x);
    REQUIRE(f.norm() > 0);
    const auto again =
        lagged_friction(*contact.build_candidates(x, raised(x, 1e-3))->build_collisions(x), x, displacements);
    CHECK((gradient_of(*again, x) - f).norm() <= 1e-9 * f.norm());
  });
  CHECK(rubbing >= (DRAPE_SANITIZED ? 2 : 6));  // two models
}
