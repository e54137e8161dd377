#include "core/contact/friction.h"

#include <algorithm>
#include <random>

#include "tests/support/kernel_check.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

constexpr double slip_distance = 1e-4;

struct Sliding {
  std::vector<FrictionContact> contacts;
  Positions from;

  explicit Sliding(int count, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const int n = 5 * count;
    from = Positions::NullaryExpr(n, 3, [&](Eigen::Index, Eigen::Index) { return normal(random); });
    for (int i = 0; i < count; ++i) {
      FrictionContact contact;
      contact.key = {(i * 7) % count, i % 3, 0, 0, 0};
      for (int k = 0; k < 4; ++k) contact.vertices[k] = (4 * i + k) % n;
      contact.c = {0.3, 0.7, -0.4, -0.6};
      if (i % 3 == 1) contact.vertices[0] = contact.vertices[1] = -1;
      if (i % 3 == 2) contact.vertices[3] = contact.vertices[1] = contact.vertices[2] = -1;
      contact.normal = Vector3d(normal(random), normal(random), normal(random)).normalized();
      contact.force = 0.1 + std::abs(normal(random));
      contacts.push_back(contact);
    }
  }
  Positions moved(double by, unsigned seed) const {
    return from + by * Eigen::Map<const Positions>(normal_numbers(from.size(), seed).data(), from.rows(), 3);
  }
  std::unique_ptr<FrictionEnergy> energy() const { return make_friction(contacts, from, {}, slip_distance); }
};

}  // namespace

TEST_CASE("friction's derivatives, sticking and slipping") {
  for (int i = 0; i < 30; ++i) {
    const Sliding sliding(1 + i % 5, i);
    const auto energy = sliding.energy();
    for (const double by : {0.01, 0.3, 3.0}) {
      const Positions x = sliding.moved(by * slip_distance, 100 + i);
      const Positions g = gradient_of(*energy, x);
      const Eigen::MatrixXd h = dense(hessian_of(*energy, x, Projection::none));
      REQUIRE(g.norm() > 0);
      REQUIRE(h.norm() > 0);
      // The third derivative jumps at |u| = 0 and ε.
      const auto value = [&](const Positions& y) { return energy->value(y); };
      const auto gradient = [&](const Positions& y) { return gradient_of(*energy, y); };
      CHECK((differences(value, x, 1e-8) - flat(g).transpose()).norm() <= 2e-6 * g.norm());
      CHECK((differences(gradient, x, 1e-8) - h).norm() <= 1e-4 * h.norm());
      CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(h).eigenvalues()[0] >= -1e-13 * h.norm());
      CHECK(dense(hessian_of(*energy, x, Projection::clamp)) == h);
    }
  }
}

TEST_CASE("friction of a single point: nothing at rest, its full force from the slip distance on") {
  FrictionContact contact;
  contact.vertices = {0, -1, -1, -1};
  contact.c = {1, -1, 0, 0};
  contact.normal = {0, 0, 1};
  contact.force = 0.25;
  const Positions from = Positions::Zero(1, 3);
  const auto energy = make_friction({contact}, from, {}, slip_distance);
  const auto at = [&](double x, double y, double z) {
    return Positions(from + Positions(Eigen::RowVector3d(x, y, z)));
  };
  CHECK(energy->value(from) == 0);
  CHECK(gradient_of(*energy, from).norm() == 0);
  CHECK(energy->value(at(0, 0, 1)) == 0);
  const Eigen::Matrix3d expected = Vector3d(1, 1, 0).asDiagonal() * (2 * 0.25 / slip_distance);
  CHECK((dense(hessian_of(*energy, from, Projection::none)) - expected).norm() <= 1e-10);
  for (const double part : {1e-6, 0.1, 0.5, 0.999}) {
    const Positions g = gradient_of(*energy, at(0.6 * part * slip_distance, 0.8 * part * slip_distance, 2));
    const double f = 0.25 * part * (2 - part);
    CHECK((g - Eigen::RowVector3d(0.6 * f, 0.8 * f, 0)).norm() <= 1e-9 * f);
  }
  for (const double part : {1.0, 1.001, 10.0, 1e4}) {
    const Positions x = at(0, part * slip_distance, 0);
    CHECK(gradient_of(*energy, x).norm() == Approx(0.25).epsilon(1e-10));
    CHECK(energy->value(x) == Approx(0.25 * slip_distance * (part - 1.0 / 3)));
  }
  CHECK(make_friction({}, from, {}, slip_distance) == nullptr);
}

TEST_CASE("friction's forces after a step are those at its end, for every contact that is still there") {
  Sliding sliding(200);
  const auto before = sliding.energy();
  const Positions x = sliding.moved(slip_distance, 7);
  Slips slips;
  before->add_slips(x, slips);
  REQUIRE(slips.size() == sliding.contacts.size());
  for (const Slip& slip : slips) CHECK(slip.by.norm() <= slip_distance * (1 + 1e-12));
  std::ranges::sort(slips, {}, &Slip::contact);
  const Positions f = gradient_of(*before, x);
  std::shuffle(sliding.contacts.begin(), sliding.contacts.end(), std::mt19937(2));
  CHECK((gradient_of(*make_friction(sliding.contacts, x, slips, slip_distance), x) - f).norm() <=
        1e-9 * f.norm());
  // One that is new has not slipped yet.
  FrictionContact& fresh = sliding.contacts[0];
  fresh.key[1] += 7;  // among the others
  CHECK(gradient_of(*make_friction({fresh}, x, slips, slip_distance), x).norm() == 0);
}

TEST_CASE("friction has the same bits with any number of threads") {
  const Sliding sliding(5000);
  check_threads(*sliding.energy(), sliding.moved(slip_distance, 3));
}
