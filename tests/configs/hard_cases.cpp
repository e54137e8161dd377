// The hard cases that take seconds, on their coarsest level alone; `make results STUDIES=hard` runs all, on
// two levels and by every method. And what a scene's size and place may change of its shape: nothing.

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <regex>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"
#include "tests/support/folders.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

const fs::path source = folders::source();

/// A copy of the suite whose sweeps run Newton on one level, without limits on the clock.
void copy_suite(const Scratch& folder) {
  fs::copy(source / "configs/hard", folder / "hard", fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(folder / "hard/sweeps")) {
    std::string text = std::regex_replace(text_of(entry.path()), std::regex("\ntime_limit: .*"), "");
    if (text.find("\nmethods:") != std::string::npos) continue;
    const std::string set = "\nset: {";
    if (const std::size_t at = text.find(set); at != std::string::npos)
      text.insert(at + set.size(), "levels: 1, ");
    else
      text += "set: {levels: 1}\n";
    std::ofstream(entry.path()) << text << "methods: [newton]\n";
  }
}

/// The last state of a method, as it was before the scene was scaled, turned and moved.
Positions shape_of(const fs::path& run, const std::string& method, double scale, const Eigen::Matrix3d& turn,
                   const Eigen::Vector3d& away) {
  const Positions x = read_mesh(run / ("levels/" + method + "_l1.ply")).vertices;
  return ((x.rowwise() - away.transpose()) * turn) / scale;
}

/// The levels of a run on the mesh of huge and tiny triangles.
nlohmann::json huge_beside_tiny(const std::string& method, const std::string& options) {
  const Scratch folder;
  copy_suite(folder);
  drape_with(
      "run hard/drape.yaml --set 'cloth={shape: file, file: hard/meshes/huge_and_tiny.off}' "
      "--set start.perturbation=1e-6 --method " +
          method + options + " --out run --no-report",
      folder.path);
  return json_in(folder / "run/results.json")["methods"][method]["levels"];
}

}  // namespace

TEST_CASE("hard cases end as they should") {
  const Scratch folder;
  copy_suite(folder);
  int rows = 0;
  for (const std::string theme : {"friction", "contact", "steps", "closing", "folded", "sleeve", "pins"}) {
    drape_with("sweep hard/sweeps/" + theme + ".yaml --out " + theme, folder.path);
    for (const nlohmann::json& row :
         nlohmann::json::parse(drape_with("table " + theme + " --format json", folder.path).out)) {
      INFO(theme << ": " << row.dump());
      CHECK(row["pass"] == true);
      ++rows;
    }
  }
  CHECK(rows >= 36);
}

TEST_CASE("a huge triangle beside tiny ones is refined into its strain limit") {
  const nlohmann::json levels =
      huge_beside_tiny("pcs",
                       " --set methods.pcs.relaxation=none"
                       " --set 'methods.pcs.interpolation={membrane: refiner, bending: "
                       "refiner, external: refiner, state: refiner}'");
  REQUIRE(levels.size() == 2);
  CHECK(levels[1]["status"] == "converged");
  CHECK(levels[1]["message"] == "");
  CHECK(levels[1]["largest_stretch"].get<double>() < 1.0608);
}

TEST_CASE(
    "a rest shape that Loop moves too far makes the next level begin from the initial state, with a "
    "message") {
  // From the proxy's state: from the relaxed one the refinement gives up only after half a minute.
  // Membranes that buckle leave a state that can be refined.
  const nlohmann::json levels =
      huge_beside_tiny("pcs", " --set methods.pcs.relaxation=none --set methods.pcs.membranes=plain");
  REQUIRE(levels.size() == 2);
  CHECK(levels[1]["status"] == "converged");
  CHECK_THAT(levels[1]["message"].get<std::string>(),
             Catch::Contains("starts from the scene's start instead"));
}

TEST_CASE("a triangle close to its strain limit moves away from it instead of along it") {
  const nlohmann::json levels =
      huge_beside_tiny("cascadic", " --set refiner=midpoint --set newton.max_steps=1000");
  REQUIRE(levels.size() == 2);
  CHECK(levels[1]["status"] == "converged");
}

TEST_CASE("a scene comes to the same shape at any size, turned, and a kilometre away") {
  const Scratch folder;
  const std::string sweep = (source / "configs/hard/sweeps/same_shape.yaml").string();
  drape_ends("sweep " + sweep + " --out out", folder);
  const auto run = [&](const std::string& name) { return folder / ("out/runs/" + name + "/seed_1"); };
  const double degree = M_PI / 180;
  const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(30 * degree, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(20 * degree, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(50 * degree, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
  const Eigen::Vector3d here(0, 0, 0), far_off(600, -800, 300);
  for (const std::string method : {"pcs", "cascadic", "newton"}) {
    const Positions expected = shape_of(run("as_it_is"), method, 1, none, here);
    const auto difference = [&](const std::string& name, double scale, const Eigen::Matrix3d& turn,
                                const Eigen::Vector3d& away) {
      const Positions x = shape_of(run(name), method, scale, turn, away);
      return std::sqrt((x - expected).rowwise().squaredNorm().mean());
    };
    CAPTURE(method);
    // What the force tolerance of 1e-6 leaves: rounding may take one iteration more or less to it.
    CHECK(difference("silk_of_1_mm", 1e-3, none, here) < 1e-6);
    CHECK(difference("tarpaulin_of_100_m", 100, none, here) < 1e-6);
    CHECK(difference("a_kilometre_away", 1, none, far_off) < 1e-6);
    CHECK(difference("turned,_a_kilometre_away", 1, turned, far_off) < 1e-6);
    CHECK(difference("a_kilometre_away", 1, none, here) > 1);  // that the comparison says something
  }
}
