#include "core/numerics/contact_forces/friction.h"

#include "tests/support/kernel_check.h"
#include "tests/unit/contact/pairs.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

constexpr double smoothing = 1e-4;  // friction smoothing distance [m]

struct Sliding {
  std::vector<FrictionContact> contacts;
  Positions reference;

  explicit Sliding(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const int n = 5 * count;
    reference = Positions::NullaryExpr(n, 3, [&](Eigen::Index, Eigen::Index) { return normal(random); });
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
};

}  // namespace

TEST_CASE("friction's derivatives, sticking and sliding") {
  for (int i = 0; i < 30; ++i) {
    const Sliding sliding(1 + i % 5, i);
    const LaggedFriction energy({sliding.contacts}, sliding.reference, {}, smoothing);
    for (const double by : {0.01, 0.3, 3.0}) {
      const Positions x = shaken(sliding.reference, by * smoothing, 100 + i);
      // The third derivative jumps at |u| = 0 and ε.
      check_energy_derivatives([&](const Positions&) { return &energy; }, x, 1e-8, 2e-6, 1e-4);
      const Eigen::MatrixXd h = dense(hessian_of(energy, x, Projection::none));
      CHECK(eigenvalues_of(h)[0] >= -1e-13 * h.norm());
      CHECK(dense(hessian_of(energy, x, Projection::clamp)) == h);
    }
  }
}

TEST_CASE("friction of a single point: zero at rest, full force above the smoothing distance") {
  FrictionContact contact;
  contact.vertices = {0, -1, -1, -1};
  contact.c = {1, -1, 0, 0};
  contact.normal = {0, 0, 1};
  contact.force = 0.25;
  const auto at = [](double x, double y, double z) { return Positions(Eigen::RowVector3d(x, y, z)); };
  const Positions rest = at(0, 0, 0);
  const LaggedFriction energy({{contact}}, rest, {}, smoothing);
  CHECK(energy.value(rest) == 0);
  CHECK(gradient_of(energy, rest).norm() == 0);
  CHECK(energy.value(at(0, 0, 1)) == 0);
  const Eigen::Matrix3d expected = Vector3d(1, 1, 0).asDiagonal() * (2 * 0.25 / smoothing);
  CHECK((dense(hessian_of(energy, rest, Projection::none)) - expected).norm() <= 1e-10);
  for (const double part : {1e-6, 0.1, 0.5, 0.999}) {
    const double f = 0.25 * part * (2 - part);
    const Positions g = gradient_of(energy, at(0.6 * part * smoothing, 0.8 * part * smoothing, 2));
    CHECK((g - at(0.6 * f, 0.8 * f, 0)).norm() <= 1e-9 * f);
  }
  for (const double part : {1.0, 1.001, 10.0, 1e4}) {
    const Positions x = at(0, part * smoothing, 0);
    CHECK(gradient_of(energy, x).norm() == Approx(0.25).epsilon(1e-10));
    CHECK(energy.value(x) == Approx(0.25 * smoothing * (part - 1.0 / 3)));
  }
}

TEST_CASE("under-relaxed friction contacts are means, and those that have ended fade") {
  const Sliding sliding(3, 1);
  std::vector<FrictionContact> before = sliding.contacts, now = sliding.contacts;
  before.pop_back();       // contact 2 is new,
  now.erase(now.begin());  // contact 0 has ended
  now[0].force = 3 * before[1].force;
  now[0].normal = Vector3d::UnitX();
  before[1].normal = Vector3d::UnitY();
  const FrictionContacts half = under_relaxed({before}, {now}, 0.5);
  REQUIRE(half.size() == 2);
  CHECK(half[0][0].key == now[0].key);
  CHECK(half[0][0].force == Approx(2 * before[1].force));
  CHECK((half[0][0].normal - Vector3d(3, 1, 0).normalized()).norm() < 1e-15);  // by their parts in the force
  CHECK(half[0][1].force == Approx(0.5 * now[1].force));
  CHECK(half[1][0].key == before[0].key);
  CHECK(half[1][0].force == Approx(0.5 * before[0].force));

  // All of the lag is that of the new state; what has ended keeps its displacement.
  const FrictionContacts all = under_relaxed({before}, {now}, 1);
  CHECK(all[0][0].force == now[0].force);
  CHECK(all[0][0].normal == now[0].normal);
  CHECK(all[1][0].force == 0);

  FrictionContacts lag = {before};
  for (int k = 0; k < 100; ++k) lag = under_relaxed(lag, {now}, 0.5);
  REQUIRE(lag.size() == 1);
  for (std::size_t i = 0; i < now.size(); ++i) {
    CHECK(lag[0][i].force == Approx(now[i].force));
    CHECK((lag[0][i].normal - now[i].normal).norm() < 1e-14);
    CHECK((lag[0][i].c - now[i].c).norm() < 1e-14);
  }
}

TEST_CASE("a contact that keeps its force sticks with it while its normal force changes, within that") {
  FrictionContact contact;
  contact.key = {3, 1, 0, 0, 0};
  contact.vertices = {0, -1, -1, -1};
  contact.c = {1, 0, 0, 0};
  contact.normal = {0, 0, 1};
  contact.force = 0.25;
  const Positions rest = Positions::Zero(1, 3), x = Eigen::RowVector3d(0.3 * smoothing, 0.4 * smoothing, 0);
  const LaggedFriction before({{contact}}, rest, {}, smoothing);
  const TangentialDisplacements stored = before.tangential_displacements(x);
  const Positions force = gradient_of(before, x);
  for (const double times : {0.5, 0.76, 1.0, 2.0, 100.0}) {  // 0.75 of it is in use
    FrictionContact now = contact;
    now.force *= times;
    const LaggedFriction kept({{now}}, x, stored, smoothing, Sticking::force);
    CHECK((gradient_of(kept, x) - std::min(1.0, times / 0.75) * force).norm() <= 1e-12);
    const LaggedFriction follows({{now}}, x, stored, smoothing);
    CHECK((gradient_of(follows, x) - times * force).norm() <= 1e-12);
  }
}
