#include "core/numerics/model/derivative_check.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/refusal.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// ¼ Σ |x_i|⁴, unless it is told to be faulty.
struct Quartic : Wells {
  Quartic() : Wells(Positions::Zero(3, 3), 1, 0) {}
  double gradient_error = 0, hessian_error = 0;            ///< at one coordinate
  double excess = 0;                                       ///< of what add_gradient returns
  bool overwrites = false, replaces = false;               ///< what is in g, or g
  double limit = std::numeric_limits<double>::infinity();  ///< of x(0, 0), beyond which the value is infinite

  double value(const Positions& x) const override {
    return x(0, 0) > limit ? std::numeric_limits<double>::infinity() : Wells::value(x);
  }
  double add_gradient(const Positions& x, Positions& g) const override {
    if (overwrites) g.setZero();
    g(1, 2) += gradient_error;
    if (replaces) {
      g.resize(2, 3);
      return 0;
    }
    return Wells::add_gradient(x, g) + excess;
  }
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    Wells::add_hessian(x, projection, sink);
    const double error[9] = {0, hessian_error};
    sink.add(2, 0, 0, error);
  }
};

const Positions state{{0.3, -0.2, 0.5}, {0.1, 0.4, -0.6}, {-0.3, 0.2, 0.7}};

using SpoilQuartic = void (*)(Quartic&);

DerivativeCheck check_spoilt(SpoilQuartic spoil) {
  Quartic energy;
  spoil(energy);
  return check_derivatives(energy, state, 1e-3);
}

}  // namespace

TEST_CASE("correct derivatives have small errors, also where differences are round-off") {
  const DerivativeCheck quartic = check_spoilt([](Quartic&) {});
  CHECK(quartic.gradient.error < 1e-9);
  CHECK(quartic.hessian.error < 1e-9);
  CHECK(quartic.asymmetry == 0);
  const DerivativeCheck linear = check_derivatives(Weight(), state, 1e-4);
  CHECK(linear.gradient.error < 1e-9);
  CHECK(linear.hessian.error < 1e-6);
  CHECK(check_derivatives(NoEnergy(), state, 1e-5).agrees());
}

TEST_CASE("the largest error of a derivative is found where it is, and what is not finite") {
  DerivativeCheck check = check_spoilt([](Quartic& e) { e.gradient_error = 0.1, e.hessian_error = 0.2; });
  CHECK(check.gradient.error > 0.1);
  CHECK(check.gradient.row == 5);
  CHECK(check.hessian.error > 0.1);
  CHECK(check.hessian.row == 6);
  CHECK(check.hessian.column == 7);
  CHECK(check.asymmetry > 0.1);
  check = check_spoilt([](Quartic& e) { e.hessian_error = std::nan(""); });
  CHECK_FALSE(check.agrees());
  CHECK_THAT(check.text(), Catch::EndsWith("hessian: NOT FINITE at vertices 2, x and 2, y\n"));
  check = check_spoilt([](Quartic& e) { e.gradient_error = std::nan(""); });
  CHECK_FALSE(check.agrees());
  CHECK(check.text() ==
        "gradient: NOT FINITE at vertex 1, z\nhessian: not checked, since it takes finite gradients\n");
}

TEST_CASE("what cannot be checked is refused, and a gradient that is not added") {
  const auto refusal = [](SpoilQuartic spoil) { return refusal_of([&] { check_spoilt(spoil); }); };
  CHECK_THAT(refusal([](Quartic& e) { e.excess = 1e-3; }), Catch::StartsWith("add_gradient returns "));
  CHECK(refusal([](Quartic& e) { e.overwrites = true; }) ==
        "add_gradient does not add to the numbers in g, but overwrites some");
  CHECK_THAT(refusal([](Quartic& e) { e.limit = -1; }),
             Catch::StartsWith("the energy is not finite at this state: value is inf"));
  CHECK_THAT(refusal([](Quartic& e) { e.limit = 0.3; }), Catch::Contains("not finite near x"));
  CHECK_THAT(refusal([](Quartic& e) { e.replaces = true; }),
             Catch::Contains("add_gradient has changed the size of g to 2 rows, not 3"));
  CHECK_THROWS_WITH(check_derivatives(Quartic(), state, 0), Catch::Contains("a step above 0"));
}
