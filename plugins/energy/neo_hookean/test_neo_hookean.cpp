#include "tests/support/buckling_check.h"
#include "tests/support/membrane_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/neo_hookean/neo_hookean.cpp"

using namespace drape;

TEST_CASE("neo_hookean: properties of every membrane") {
  check_membrane<formulas::neo_hookean>([](double mu, double lambda, long double a, long double b) {
    const long double log_j = std::log1p(a) + std::log1p(b);
    return mu / 2 * (2 * a + a * a + 2 * b + b * b - 2 * log_j) + lambda / 2 * log_j * log_j;
  });
}

TEST_CASE("neo_hookean: a membrane that buckles below the mesh") {
  BucklingCheck<formulas::neo_hookean>().run();
}
