// A garment that is not worn, as the command tells it.

#include "core/app/report/run_data.h"
#include "core/kernel/files/file.h"
#include "tests/support/command.h"

using namespace drape;

namespace {

/// A T-shirt, coarsely, on a figure with arms at this angle below the horizontal.
void write_dressed(const Scratch& folder, int arm_angle) {
  const std::filesystem::path garments = folders::source() / "configs/garments";
  const Ended made = Command((garments / "make_body").string() + " --cell 0.03 --arm-angle " +
                                 std::to_string(arm_angle) + " body.obj",
                             folder.path)
                         .wait();
  INFO(made.err);
  REQUIRE(made.exit_code == 0);
  folder.write(
      "e.yaml",
      "name: garment\nlevels: 1\ncloth: {shape: pattern, file: " + (garments / "tshirt.yaml").string() +
          ", edge_length: 0.05}\nmaterial: {density: 300, thickness: 4e-4, membrane_modulus: 8e5, "
          "bending_modulus: 2e5}\nenergies: [neo_hookean, hinge, gravity]\ncontact: {type: ipc, "
          "dhat: 0.002}\nfriction: 0.4\ndress: {body: body.obj, up: y}\nmethods: {pcs: {}}\nmetrics: "
          "[]\n");
}

Json last_level(const Scratch& folder) {
  return read_results(folder / "out")["methods"]["pcs"]["levels"].back();
}

const std::string left =
    "the opening of sleeve_left_front, by its edge cuff, and sleeve_left_back, by its edge cuff";

}  // namespace

TEST_CASE(
    "A T-shirt with its arms beside the sleeves is told by check and run, and refused with dress.worn") {
  const Scratch folder;
  write_dressed(folder, 80);
  const std::string placed =
      "the garment may not be worn: as it is placed, no part of the body passes through ";
  const Ended checked = drape_ends("check e.yaml", folder);
  CHECK_THAT(checked.err, Catch::Contains("warning: e.yaml:8:8: " + placed + left));
  const Ended refused = drape_ends("check e.yaml --set dress.worn=true", folder, 2);
  CHECK_THAT(refused.err,
             Catch::Contains("the garment will not be worn: as it is placed, no part of the body"));
  const Ended ran = drape_ends("run e.yaml -o out", folder);
  const std::string fault = "the garment is not worn: no part of the body passes through ";
  CHECK_THAT(ran.err, Catch::Contains(placed + left) && Catch::Contains(fault));
  const Json level = last_level(folder);
  CHECK(level["status"] == "converged");
  CHECK_THAT(level["message"].get<std::string>(),
             Catch::StartsWith(fault) && Catch::Contains("sleeve_left_back"));
  CHECK_THAT(read_file(folder / "out/report.html"), Catch::Contains(fault));
  int missed = 0;
  for (const Json& opening : level["openings"]) {
    const bool is_cuff = opening["pieces"][0].get<std::string>().starts_with("sleeve");
    CHECK(opening["passes"] == !is_cuff);
    missed += is_cuff;
    CHECK(opening["length"].get<double>() > 0.2);
  }
  CHECK(missed == 2);
}

TEST_CASE("A T-shirt is worn whose arms are in its sleeves, or cross them as it is placed") {
  for (const int arm_angle : {45, 55}) {
    INFO(arm_angle);
    const Scratch folder;
    write_dressed(folder, arm_angle);
    const Ended ran = drape_ends("run e.yaml -o out --no-report --set dress.worn=true", folder);
    CHECK_THAT(ran.err, !Catch::Contains("worn"));
    const Json level = last_level(folder);
    CHECK(level["message"] == "");
    CHECK(level["openings"].size() == 4);
    for (const Json& opening : level["openings"]) CHECK(opening["passes"] == true);
    if (arm_angle == 55) CHECK_THAT(ran.err, Catch::Contains("untangled where it crossed"));
  }
}

TEST_CASE("A garment whose upper edges are placed along the middles of level arms starts above them") {
  const Scratch folder;
  write_dressed(folder, 0);
  folder.write("tshirt.yaml", R"(properties: {units_in_meter: 100, up: y}
pattern:
  panels:
    front: {translation: [0, 0, 20], vertices: &v {a: [-26, 70], b: [26, 70], c: [28, 112], d: [55, 116], e: [55, 130], f: [10, 131], g: [-10, 131], h: [-55, 130], i: [-55, 116], j: [-28, 112]}, edges: &e {hem: [a, b], side_1: [b, c], under_1: [c, d], cuff_1: [d, e], upper_1: [e, f], neck: [f, g], upper_2: [g, h], cuff_2: [h, i], under_2: [i, j], side_2: [j, a]}}
    back: {translation: [0, 0, -20], rotation: [0, 180, 0], vertices: *v, edges: *e}
  stitches: {a: [front.side_1, back.side_2], b: [front.under_1, back.under_2], c: [front.upper_1, back.upper_2], d: [front.upper_2, back.upper_1], e: [front.under_2, back.under_1], f: [front.side_2, back.side_1]}
)");
  const Ended run =
      drape_ends("run e.yaml --out out --set cloth.file=tshirt.yaml --set dress.worn=true", folder);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out + run.err, Catch::Contains("raised by"));
}
