// Which numbers of an experiment a fit scales.

#include <catch2/catch.hpp>

#include "core/app/sweep/fit.h"
#include "core/kernel/files/string_utils.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

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

TEST_CASE("fit: a group is what the material sets, by a fabric too, or its defaults") {
  CHECK(keys_of("warp_bending: 3e-5, weft_bending: 2e-5", {"material.bending"}) ==
        "material.warp_bending=3.0e-05, material.weft_bending=2.0e-05");
  CHECK(keys_of("fabric: gray-interlock, bias_bending: null", {"material.bending"}) ==
        "material.warp_bending=2.319e-05, material.weft_bending=1.427e-05");
  CHECK(keys_of("bending_modulus: 1e6", {"material.bending"}) == "material.bending_modulus=1.0e+06");
  CHECK(keys_of("", {"material.bending"}).starts_with("material.bending_modulus="));
  // The material as a run saves it has all keys.
  const std::string modulus = ConfigNode::of(Material().bending_modulus).scalar;
  CHECK(keys_of("bending_modulus: " + modulus + ", warp_bending: 3e-5, weft_bending: 2e-5",
                {"material.bending"})
            .starts_with("material.warp_bending=3.0e-05, material.weft"));
  // A default that is written is set.
  CHECK(keys_of("bending_modulus: " + modulus + ", bending_hysteresis: 1e-3", {"material.bending"}) ==
        "material.bending_modulus=" + modulus + ", material.bending_hysteresis=0.001");
}

TEST_CASE("fit: a number is scaled once, whichever way it is named") {
  CHECK(keys_of("warp_bending: 3e-5", {"material.warp_bending", "material.bending", "material.thickness"}) ==
        "material.warp_bending=3.0e-05, material.thickness=" + ConfigNode::of(Material().thickness).scalar);
  CHECK(keys_of("", {"energies.gravity.acceleration.2"}) == "energies.gravity.acceleration.2=-9.81");
}

TEST_CASE("fit: what is no number is refused, with a remedy") {
  CHECK(keys_of("", {"material.thicknes"}).starts_with("material.thickness="));
  CHECK(keys_of("", {"nonsense"}) ==
        "--by: the experiment has no number \"nonsense\"; `drape describe experiment` lists its keys");
  CHECK(keys_of("", {"cloth.shape"}) == "--by: \"cloth.shape\" is the text \"square\", not a number");
  CHECK(keys_of("", {"material.warp_bending"}) ==
        "--by: \"material.warp_bending\" is not set, so there is nothing to scale; give it a value with "
        "--set");
  CHECK(keys_of("poisson_ratio: 0", {"material.poisson_ratio"}) ==
        "--by: \"material.poisson_ratio\" is 0, which no factor changes");
}
