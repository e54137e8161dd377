#include "tests/support/meshes.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/folders.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

/// Where `third_party/data/fetch` has put the meshes. Where it has not, this ends as a test that was skipped.
fs::path folder() {
  const char* set = std::getenv("DRAPE_TEST_MESHES");
  const fs::path path = set ? set : folders::source() / "data";
  if (!fs::exists(path / "bunny.ply")) {
    std::cerr << "skipped: " << path.string() << " holds no meshes; `make data` fetches them\n";
    std::exit(77);
  }
  return path;
}

/// Names in the recipe's first column.
std::vector<std::string> names() {
  std::ifstream recipe(folders::source() / "third_party/data/meshes.txt");
  std::vector<std::string> all;
  for (std::string line; std::getline(recipe, line);)
    if (!line.empty() && line[0] != '#') all.push_back(line.substr(0, line.find(' ')));
  return all;
}

}  // namespace

TEST_CASE("scanned meshes are valid obstacles of the size in their record") {
  REQUIRE(names() == std::vector<std::string>{"bunny", "armadillo", "bear", "dragon"});
  for (const std::string& name : names()) {
    INFO(name);
    const TriangleMesh mesh = read_mesh(folder() / (name + ".ply"));
    std::ifstream file(folder() / (name + ".json"));
    const auto record = nlohmann::json::parse(file);

    REQUIRE(check_mesh(mesh).empty());
    CHECK(mesh.triangles.rows() == 8000);
    CHECK(mesh.triangles.rows() == record.at("faces"));
    CHECK(mesh.vertices.rows() == record.at("vertices"));
    const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
    CHECK((topology.edge_triangles.col(1).array() >= 0).all());  // closed
    CHECK(self_intersections(mesh).empty());

    const Eigen::RowVector3d low = mesh.vertices.colwise().minCoeff(),
                             high = mesh.vertices.colwise().maxCoeff();
    const double height = record.at("height");
    CHECK(std::abs(low.z()) <= 1e-12);
    CHECK(high.z() == Approx(height));
    CHECK(std::abs(low.x() + high.x()) <= 1e-12);
    CHECK(std::abs(low.y() + high.y()) <= 1e-12);
    CHECK((high - low).minCoeff() > 0.3 * height);
    CHECK(volume_of(mesh) > 0.1 * (high - low).prod());  // faces outwards
  }
}
