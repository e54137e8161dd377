#include "core/numerics/contact_forces/friction_balance.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "core/numerics/contact_forces/friction.h"
#include "tests/support/evaluate.h"
#include "tests/support/random.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

/// A contact of one vertex with an obstacle.
FrictionContact touching(int vertex, const Vector3d& normal, double force) {
  return {{vertex}, {vertex, -1, -1, -1}, {1, 0, 0, 0}, normal.normalized(), force, {}};
}

/// Contact of one vertex with another.
FrictionContact between_vertices(int one, int other, double force) {
  return {{one, other}, {one, other, -1, -1}, {1, -1, 0, 0}, Vector3d::UnitY(), force, {}};
}

/// The least norm to a relative error of 1e-6, by bisection: the function tells on which side of a bound it
/// is.
double least_norm(const std::vector<FrictionContact>& contacts, const Positions& forces,
                  const std::vector<char>& fixed) {
  double low = 0, high = 1.001 * forces.norm();
  while (high - low > 1e-6 * high) {
    const double middle = 0.5 * (low + high);
    (norm_beyond_friction(contacts, forces, fixed, middle) > middle ? low : high) = middle;
  }
  return high;
}

Positions force_rows(const std::vector<Vector3d>& all) {
  Positions x(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t i = 0; i < all.size(); ++i) x.row(static_cast<Eigen::Index>(i)) = all[i].transpose();
  return x;
}

}  // namespace

TEST_CASE("friction carries a force along a contact up to its limit, and none across") {
  const auto of = [](const Vector3d& f, const std::vector<FrictionContact>& all) {
    return least_norm(all, force_rows({f}), {0});
  };
  const std::vector<FrictionContact> floor = {touching(0, {0, 0, 1}, 0.5)};
  CHECK(of({0.3, 0.4, 0}, floor) < 1e-5);
  CHECK(of({0.6, 0.8, 0}, floor) == Approx(0.5).epsilon(1e-5));
  CHECK(of({0, 0, 0.2}, floor) == Approx(0.2).epsilon(1e-5));
  CHECK(of({0.6, 0.8, 0.2}, floor) == Approx(std::hypot(0.5, 0.2)).epsilon(1e-5));
  CHECK(of({0.6, 0.8, 0}, {}) == Approx(1).epsilon(1e-5));
  // Between two jaws both sides carry, and in a corner each wall what lies along it.
  CHECK(of({0, 0, -0.9}, {touching(0, {0, 1, 0}, 0.5), touching(0, {0, -1, 0}, 0.5)}) < 1e-5);
  CHECK(of({0, 0, -1.2}, {touching(0, {0, 1, 0}, 0.5), touching(0, {0, -1, 0}, 0.5)}) ==
        Approx(0.2).epsilon(1e-5));
  CHECK(of({0.4, 0.4, 0}, {touching(0, {1, 0, 0}, 0.5), touching(0, {0, 1, 0}, 0.5)}) < 1e-5);
  // A fixed vertex needs no friction.
  CHECK(norm_beyond_friction({}, force_rows({{1, 2, 3}, {0, 0.5, 0}}), {1, 0}, 0) == 0.5);
}

TEST_CASE("friction passes a force on through layers, as far as each contact bears it") {
  constexpr int layers = 30;
  Positions forces = Positions::Zero(layers, 3);
  forces(0, 2) = -1;  // the innermost layer's weight
  std::vector<char> fixed(layers, 0);
  std::vector<FrictionContact> stack;
  for (int k = 0; k + 1 < layers; ++k) stack.push_back(between_vertices(k, k + 1, 1.01));
  stack.push_back(touching(layers - 1, {0, 1, 0}, 1.01));
  CHECK(norm_beyond_friction(stack, forces, fixed, 1e-4) <= 1e-4);
  // The weakest contact, near the jaw, lets the layers inside of it slip together.
  stack[layers - 6].force = 0.4;
  CHECK(least_norm(stack, forces, fixed) == Approx(0.6 / std::sqrt(layers - 5)).epsilon(1e-4));
}

TEST_CASE("what friction has carried is within what it can carry, however contacts share vertices") {
  constexpr int vertices = 40;
  for (unsigned seed = 1; seed < 20; ++seed) {
    RandomNumbers random(seed);
    std::vector<FrictionContact> contacts;
    const auto vertex = [&] { return static_cast<int>(random(0, vertices)) % vertices; };
    for (int i = 0; i < 80; ++i) {
      FrictionContact contact;
      contact.key = {i};
      const int first = vertex();
      for (int k = 0; k < 4; ++k) contact.vertices[k] = (first + k * 7) % vertices;
      if (i % 3 == 0) contact.vertices = {first, -1, -1, -1};
      const double s = random(0, 1), t = random(0, 1);
      contact.c = {1 - s, s, t - 1, -t};
      contact.normal = random.vector(1).normalized();
      contact.force = std::pow(10, 4 * random(0, 1) - 2);
      contacts.push_back(contact);
    }
    std::vector<char> fixed(vertices, 0);
    fixed[3] = fixed[17] = 1;
    const auto positions = [&](double size) {
      Positions x(vertices, 3);
      for (int v = 0; v < vertices; ++v) x.row(v) = random.vector(size).transpose();
      return x;
    };
    // Forces that lagged friction balances, some of it sticking and some sliding.
    const Positions reference = positions(1), x = reference + positions(2e-4);
    const Positions balanced = -gradient_of(LaggedFriction({contacts}, reference, {}, 1e-4), x);
    CAPTURE(seed, balanced.norm());
    CHECK(norm_beyond_friction(contacts, balanced, fixed, 1e-5 * balanced.norm()) <= 1e-5 * balanced.norm());
    // More than all of friction together cannot be carried.
    const double all = std::accumulate(contacts.begin(), contacts.end(), 0.0,
                                       [](double sum, const FrictionContact& c) { return sum + c.force; });
    Positions large = Positions::Zero(vertices, 3);
    large(0, 0) = 2 * all;
    CHECK(norm_beyond_friction(contacts, large, fixed, 0.1 * all) > 0.1 * all);
  }
}
