#include "tests/support/buckling_check.h"
#include "tests/support/membrane_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/stvk/stvk.cpp"

using namespace drape;

TEST_CASE("stvk: properties of every membrane") {
  check_membrane<formulas::stvk>([](double mu, double lambda, long double a, long double b) {
    const long double g11 = a + a * a / 2, g22 = b + b * b / 2;
    return mu * (g11 * g11 + g22 * g22) + lambda / 2 * (g11 + g22) * (g11 + g22);
  });
}

TEST_CASE("stvk: a membrane that buckles below the mesh") { BucklingCheck<formulas::stvk>().run(); }
