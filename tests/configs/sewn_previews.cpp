// Previews of sewn cloth: pcs lies nearer to its end than cascadic, where coarse triangles lock.

#include <cmath>
#include <numbers>

#include "tests/configs/runs.h"
#include "tests/support/folders.h"

namespace {

/// RMS distance [m] of the preview of pcs to its end, over that of cascadic; none of their states intersects.
double preview_ratio(const Scratch& folder, const std::string& arguments) {
  drape_ends("run " + arguments + " --method all --no-report --measure -q -j 1 --out out", folder);
  const nlohmann::json methods = json_in(folder / "out/results.json")["methods"];
  const auto distance = [&](const char* method) {
    for (const auto& level : methods[method]["levels"]) CHECK(level["intersections"] == 0);
    for (const auto& pair : methods[method]["consistency"])
      if (pair["coarse"] == 0 && pair["fine"] == 2) return pair["distance_rms"].get<double>();
    FAIL("no distance of the preview of " << method);
    return 0.0;
  };
  return distance("pcs") / distance("cascadic");
}

/// A skirt: three quarters of an annulus of radii 0.12 and 0.45 m, sewn along its two straight sides to a
/// cone, whose waist hangs at a height of 0.05 m.
std::string skirt_obj() {
  constexpr int around = 24, rows = 7;
  constexpr double inner = 0.12, outer = 0.45, turn = 1.5 * std::numbers::pi, sine = 0.75;
  std::ostringstream v, vt, f;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i <= around; ++i) {
      const double r = inner + (outer - inner) * j / (rows - 1), angle = turn * i / around;
      vt << "vt " << r * std::cos(angle) << ' ' << r * std::sin(angle) << '\n';
      if (i == around) continue;
      const double about = angle / sine, height = 0.05 - (r - inner) * std::sqrt(1 - sine * sine);
      v << "v " << sine * r * std::cos(about) << ' ' << sine * r * std::sin(about) << ' ' << height << '\n';
    }
  const auto corner = [&](int i, int j) {
    std::ostringstream text;
    text << ' ' << j * around + i % around + 1 << '/' << j * (around + 1) + i + 1;
    return text.str();
  };
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i < around; ++i) {
      f << 'f' << corner(i, j) << corner(i, j + 1) << corner(i + 1, j + 1) << '\n';
      f << 'f' << corner(i, j) << corner(i + 1, j + 1) << corner(i + 1, j) << '\n';
    }
  return v.str() + vt.str() + f.str();
}

}  // namespace

TEST_CASE(
    "The preview of an inflated cushion gains by pcs if its cloth does not stretch, and not if it does") {
  const Scratch folder;
  const std::string config = (folders::source() / "configs/cushion.yaml").string();
  CHECK(preview_ratio(folder, config) < 0.75);
  CHECK(preview_ratio(folder, config + " --overwrite --set material.membrane_modulus=2e6") > 0.9);
}

TEST_CASE("The preview of a skirt that falls over a ball gains by pcs") {
  const Scratch folder(
      "name: skirt\nlevels: 3\ncloth: {shape: file, file: skirt.obj, rest: uv, uv_unit: m}\n"
      "material: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e5, bending_modulus: 8e5, "
      "poisson_ratio: 0.243}\n"
      "start: {perturbation: 1e-3}\nenergies: [neo_hookean, hinge, gravity]\ncontact: [ipc, shapes]\n"
      "obstacles: [{shape: sphere, radius: 0.2, translate: [0, 0, -0.16]}]\nfriction: 0.3\n"
      "methods: {pcs: {}, cascadic: {}}\n");
  folder.write("skirt.obj", skirt_obj());
  CHECK(preview_ratio(folder, "e.yaml") < 0.75);
}
