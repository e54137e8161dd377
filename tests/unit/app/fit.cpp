// A fit's search for a factor, on functions with known roots, and which numbers of an experiment it scales.

#include "core/app/sweep/fit.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/files/string_utils.h"
#include "tests/support/solve.h"

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
  const auto difference = [&](double factor) -> std::optional<double> {
    ++result.evaluations;
    result.factor = factor;
    const std::optional<double> value = f(factor);
    if (!value) return std::nullopt;
    return std::abs(*value - target) < 1e-3 * std::abs(target) ? 0 : *value - target;
  };
  result.end = find_factor(difference, most);
  return result;
}

/// A drape coefficient [%]: between two bounds.
double drape_of(double factor) { return 20 + 80 * factor / (factor + 5); }

/// The keys that paths name in an experiment with this material, "path=value", and the errors.
std::string keys_of(const std::string& material, const std::vector<std::string>& paths) {
  const Experiment e = experiment_from("name: keys\nmaterial: {" + material +
                                       "}\nenergies: [woven, midedge_bending, gravity]\n"
                                       "methods: {newton: {}}\nmetrics: [stretch]\n");
  ConfigErrors errors;
  std::vector<std::string> texts;
  for (const ScaledKey& key : scaled_keys(e, paths, "--by", errors))
    if (errors.empty()) texts.push_back(key.path + "=" + ConfigNode::of(key.value).scalar);
  for (const ConfigError& error : errors) texts.push_back(error.text());
  return joined(texts);
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
  const SearchResult r = search(drape_of, 68.4);
  CHECK(r.end == FitEnd::reached);
  CHECK(r.factor == Approx(5 * 48.4 / 31.6).epsilon(5e-3));
  CHECK(r.evaluations <= 7);
}

TEST_CASE("fit: what is never reached ends, and so does what jumps or gives no value") {
  const SearchResult above = search(drape_of, 145), below = search(drape_of, 10);
  CHECK(above.end == FitEnd::out_of_reach);
  CHECK(above.factor == 1024);
  CHECK(below.end == FitEnd::out_of_reach);
  CHECK(below.factor == Approx(1. / 1024).epsilon(1e-3));
  CHECK(search([](double) { return 7; }, 8).end == FitEnd::out_of_reach);
  const auto jumping = [](double x) { return x < 2.7 ? 3. : 5.; };
  const SearchResult jump = search(jumping, 4);
  CHECK(jump.end == FitEnd::jumps);
  CHECK(jump.factor == Approx(2.7).epsilon(2e-3));
  CHECK(search(jumping, 4, 5).end == FitEnd::exhausted);

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

TEST_CASE("fit: a group is what the material sets, by a fabric too, or its defaults") {
  const auto bending = [](const std::string& material) { return keys_of(material, {"material.bending"}); };
  const std::string modulus = ConfigNode::of(Material().bending_modulus).scalar;
  CHECK(bending("warp_bending: 3e-5, weft_bending: 2e-5") ==
        "material.warp_bending=3.0e-05, material.weft_bending=2.0e-05");
  CHECK(bending("fabric: gray-interlock, bias_bending: null") ==
        "material.warp_bending=2.319e-05, material.weft_bending=1.427e-05");
  CHECK(bending("bending_modulus: 1e6") == "material.bending_modulus=1.0e+06");
  CHECK(bending("").starts_with("material.bending_modulus="));
  // The material as a run saves it has all keys.
  CHECK(bending("bending_modulus: " + modulus + ", warp_bending: 3e-5, weft_bending: 2e-5")
            .starts_with("material.warp_bending=3.0e-05, material.weft"));
  // A default that is written is set.
  CHECK(bending("bending_modulus: " + modulus + ", bending_hysteresis: 1e-3") ==
        "material.bending_modulus=" + modulus + ", material.bending_hysteresis=0.001");
}

TEST_CASE("fit: a number is scaled once, whichever way it is named; what is no number is refused") {
  CHECK(keys_of("warp_bending: 3e-5", {"material.warp_bending", "material.bending", "material.thickness"}) ==
        "material.warp_bending=3.0e-05, material.thickness=" + ConfigNode::of(Material().thickness).scalar);
  CHECK(keys_of("", {"energies.gravity.acceleration.2"}) == "energies.gravity.acceleration.2=-9.81");
  CHECK(keys_of("", {"material.thicknes"}).starts_with("material.thickness="));
  CHECK(keys_of("", {"nonsense"}) ==
        "--by: the experiment has no number \"nonsense\"; `drape describe experiment` lists its keys");
  CHECK(keys_of("", {"cloth.shape"}) == "--by: \"cloth.shape\" is \"square\", not a number");
  CHECK(keys_of("", {"material.warp_bending"}) ==
        "--by: \"material.warp_bending\" is not set, so there is nothing to scale; give it a value with "
        "--set");
  CHECK(keys_of("poisson_ratio: 0", {"material.poisson_ratio"}) ==
        "--by: \"material.poisson_ratio\" is 0, which no factor changes");
}
