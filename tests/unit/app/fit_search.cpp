// The search for a factor, on functions with known roots.

#include <catch2/catch.hpp>
#include <cmath>

#include "core/app/sweep/fit.h"

using namespace drape;

namespace {

struct SearchResult {
  FitEnd end;
  double factor = 0;  ///< the last one
  int evaluations = 0;
};

/// Looks for the factor where f is the target to 0.1 % of it.
SearchResult search(const std::function<std::optional<double>(double)>& f, double target, int most = 24) {
  SearchResult result{};
  result.end = find_factor(
      [&](double factor) -> std::optional<double> {
        ++result.evaluations;
        result.factor = factor;
        const std::optional<double> value = f(factor);
        if (!value) return std::nullopt;
        return std::abs(*value - target) < 1e-3 * std::abs(target) ? 0 : *value - target;
      },
      most);
  return result;
}

}  // namespace

TEST_CASE("fit: a factor is found above and below 1, of functions that rise and that fall") {
  for (const double factor : {0.003, 0.3, 0.97, 1.0, 2.5, 700.0})
    for (const double power : {-1.5, -0.2, 0.3, 1.0, 3.0}) {
      INFO(factor << " " << power);
      const SearchResult r = search([&](double x) { return std::pow(x, power); }, std::pow(factor, power));
      CHECK(r.end == FitEnd::reached);
      CHECK(r.factor == Approx(factor).epsilon(1.1e-3 / std::abs(power)));
      CHECK(r.evaluations <= 16);
    }
  // A drape coefficient: between two bounds.
  const SearchResult r = search([](double x) { return 20 + 80 * x / (x + 5); }, 68.4);
  CHECK(r.end == FitEnd::reached);
  CHECK(r.factor == Approx(5 * 48.4 / 31.6).epsilon(5e-3));
  CHECK(r.evaluations <= 7);
}

TEST_CASE("fit: what is never reached ends, and so does what jumps") {
  const SearchResult above = search([](double x) { return 20 + 80 * x / (x + 5); }, 145);
  CHECK(above.end == FitEnd::out_of_reach);
  CHECK(above.factor == 1024);
  const SearchResult below = search([](double x) { return 20 + 80 * x / (x + 5); }, 10);
  CHECK(below.end == FitEnd::out_of_reach);
  CHECK(below.factor == Approx(1. / 1024).epsilon(1e-3));
  CHECK(search([](double) { return 7; }, 8).end == FitEnd::out_of_reach);
  const SearchResult jump = search([](double x) { return x < 2.7 ? 3. : 5.; }, 4);
  CHECK(jump.end == FitEnd::jumps);
  CHECK(jump.factor == Approx(2.7).epsilon(2e-3));
  CHECK(search([](double x) { return x < 2.7 ? 3. : 5.; }, 4, 5).end == FitEnd::exhausted);
}

TEST_CASE("fit: the way to factors that give no value is cut short") {
  const auto known_below = [](double limit) {
    return [limit](double x) { return x < limit ? std::optional<double>(x) : std::nullopt; };
  };
  const SearchResult inside = search(known_below(2.2), 2.1);
  CHECK(inside.end == FitEnd::reached);
  CHECK(inside.factor == Approx(2.1).epsilon(2e-3));
  CHECK(search(known_below(2.2), 3).end == FitEnd::out_of_reach);
  // Nothing above 1 is known, and the root is below it.
  CHECK(search(known_below(1.001), 0.1).end == FitEnd::reached);
  CHECK(search(known_below(1), 0.1).end == FitEnd::out_of_reach);
  const auto with_gap = [](double x) { return x > 1.5 && x < 3.5 ? std::nullopt : std::optional<double>(x); };
  CHECK(search(with_gap, 2.5).end == FitEnd::interrupted);
}
