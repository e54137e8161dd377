// A run's figures, pinned: what changes them without meaning to is found here.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace {

struct Golden {
  std::string method;
  double energies[3], energies_on_finest[3];  // J, of levels 0, 1, 2
  double d_H_fit[3], d_H_ddg[3], d_K_fit[3];  // of the levels 0 and 1, 0 and 2, 1 and 2
  double largest_stretch;                     // on level 2
};

// Direct solves, cascadic ones and levels that have relaxed under their plain energy meet in the same states.
// Coarse levels of `pcs` differ by their membranes, which buckle and give way at the four pins.
Golden plain(const std::string& method) {
  return {method,
          {-1.47930518937, -1.52312924652, -1.56369351791},
          {-1.47612748204, -1.52180592964, -1.56369351791},
          {0.00315541, 0.0430574, 0.00837455},
          {0.629169, 2.26114, 0.984872},
          {0.0166861, 0.157442, 0.0227883},
          1.331821};
}
const Golden golden[] = {
    {"pcs",
     {-1.40926170268, -1.50409085801, -1.56369351791},
     {-1.40577849217, -1.50267887803, -1.56369351791},
     {0.00447936, 0.0479836, 0.00919147},
     {0.717768, 2.5058, 1.05899},
     {0.0242325, 0.192116, 0.0240142},
     1.331821},
    plain("pcs_plain"),
    {"pcs_unrelaxed",
     {-1.47921093288, -1.5230749209, -1.56369351791},
     {-1.47624257653, -1.52190074652, -1.56369351791},
     {0.00316132, 0.0393937, 0.00785662},
     {0.67013, 2.11758, 0.850329},
     {0.0164875, 0.155344, 0.0241715},
     1.331821},
    {"pcs_loop",
     {-1.38710717663, -1.49910892879, -1.56369351791},
     {-1.51835701045, -1.54572748516, -1.56369351791},
     {0.000885264, 0.0065151, 0.000707219},
     {0.0522303, 0.0443881, 0.0111057},
     {0.00211112, 0.0195311, 0.0011475},
     1.331821},
    plain("cascadic"),
    plain("newton"),
};

}  // namespace

TEST_CASE("the golden run: energies to 1e-6, measures of consistency to 1 %") {
  const Scratch folder(experiment_of_tests("golden"));
  drape_ends("run e.yaml --out out --method all --quiet --no-report", folder);
  const auto methods = json_in(folder / "out/results.json").at("methods");
  CHECK(methods.size() == std::size(golden));
  for (const Golden& g : golden) {
    INFO(g.method);
    const auto& levels = methods.at(g.method).at("levels");
    const auto& pairs = methods.at(g.method).at("consistency");
    REQUIRE(levels.size() == 3);
    REQUIRE(pairs.size() == 3);
    for (int k = 0; k < 3; ++k) {
      INFO("level or pair " << k);
      CHECK(levels[k]["energy"].get<double>() == Approx(g.energies[k]).epsilon(1e-6));
      CHECK(levels[k]["energy_on_finest"].get<double>() == Approx(g.energies_on_finest[k]).epsilon(1e-6));
      CHECK(pairs[k]["d_H_fit"].get<double>() == Approx(g.d_H_fit[k]).epsilon(0.01));
      CHECK(pairs[k]["d_H_ddg"].get<double>() == Approx(g.d_H_ddg[k]).epsilon(0.01));
      CHECK(pairs[k]["d_K_fit"].get<double>() == Approx(g.d_K_fit[k]).epsilon(0.01));
    }
    CHECK(levels[2]["largest_stretch"].get<double>() == Approx(g.largest_stretch).epsilon(1e-4));
  }
}
