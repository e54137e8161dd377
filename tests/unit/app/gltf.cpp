// Binary glTF files, read again by the specification.

#include "core/app/files/gltf.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/patterns/generate.h"
#include "tests/support/glb.h"

using namespace drape;

namespace {

/// A sheet of 3 × 3 vertices in some state, all of whose normals are the same.
GltfState lifted_sheet(double lift) {
  Positions x = grid({1, 0.5}, 3, 3, Diagonals::one_way).vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = lift * x(i, 0) * x(i, 0) - 1;
  Positions normals = Positions::Zero(x.rows(), 3);
  normals.col(1).setConstant(0.6);
  normals.col(2).setConstant(lift < 0 ? -0.8 : 0.8);
  return {x, normals};
}

/// The rows in glTF's axes, one after the other.
std::vector<float> turned(const Positions& rows) {
  std::vector<float> all;
  for (const auto& v : rows.rowwise())
    for (const double c : {v.x(), v.z(), -v.y()}) all.push_back(static_cast<float>(c));
  return all;
}

}  // namespace

TEST_CASE("a surface has y upwards, and its earlier states as morph targets, shown in a row") {
  GltfSurface cloth;
  cloth.name = "cloth";
  cloth.triangles = grid({1, 0.5}, 3, 3, Diagonals::one_way).triangles;
  cloth.state = lifted_sheet(0.3);
  cloth.earlier = {lifted_sheet(0), lifted_sheet(-0.7)};
  const Glb glb(glb_bytes({cloth}, {{"one", {0}}}));
  REQUIRE(glb.json.at("meshes").size() == 1);
  const auto& mesh = glb.json["meshes"][0];
  const auto& primitive = mesh.at("primitives").at(0);
  const auto accessor = [&](const nlohmann::json& index) { return glb.json["accessors"][index.get<int>()]; };

  const std::vector<std::uint32_t> corners(cloth.triangles.data(),
                                           cloth.triangles.data() + cloth.triangles.size());
  CHECK(glb.indices(primitive.at("indices")) == corners);
  const auto& view = glb.json.at("bufferViews").at(accessor(primitive["indices"])["bufferView"].get<int>());
  CHECK(view.at("target") == 34963);
  CHECK(glb.json.at("materials").at(primitive.at("material").get<int>()).at("doubleSided") == true);
  REQUIRE(primitive.at("targets").size() == 2);
  CHECK((mesh.at("weights") == nlohmann::json{0.0, 0.0}));
  CHECK(mesh.at("extras").at("targetNames").size() == 2);
  CHECK(accessor(primitive["attributes"]["POSITION"]).contains("min"));
  const auto base = glb.floats(primitive["attributes"]["POSITION"]),
             base_normals = glb.floats(primitive["attributes"]["NORMAL"]);
  REQUIRE(base.size() == 27);
  CHECK(base == turned(cloth.state.positions));
  CHECK(base_normals == turned(cloth.state.normals));
  for (std::size_t t = 0; t < 2; ++t) {
    const auto moved = glb.floats(primitive["targets"][t].at("POSITION")),
               turned_by = glb.floats(primitive["targets"][t].at("NORMAL")),
               x = turned(cloth.earlier[t].positions), normals = turned(cloth.earlier[t].normals);
    REQUIRE(moved.size() == base.size());
    CHECK(accessor(primitive["targets"][t]["POSITION"]).contains("max"));
    float largest = 0;
    for (std::size_t k = 0; k < base.size(); ++k) {
      CHECK(base[k] + moved[k] == Approx(x[k]).margin(1e-6));
      CHECK(base_normals[k] + turned_by[k] == Approx(normals[k]).margin(1e-6));
      largest = std::max(largest, std::abs(moved[k]));
    }
    CHECK(largest > 0.1f);
  }
  REQUIRE(glb.json.at("animations").size() == 1);
  const auto& animation = glb.json["animations"][0];
  CHECK((animation.at("channels").at(0).at("target") == nlohmann::json{{"node", 0}, {"path", "weights"}}));
  const auto& sampler = animation.at("samplers").at(animation["channels"][0].at("sampler").get<int>());
  CHECK((glb.floats(sampler.at("input")) == std::vector<float>{0, 0.25f, 0.5f}));
  CHECK((glb.floats(sampler.at("output")) == std::vector<float>{1, 0, 0, 1, 0, 0}));
  CHECK(accessor(sampler["input"]).contains("min"));
}

TEST_CASE("texture coordinates in a length's unit are scaled to 0 … 1 by a factor that the file states") {
  const auto coordinates = [](double low, double high) {
    GltfSurface cloth;
    cloth.triangles = grid({1, 0.5}, 3, 3, Diagonals::one_way).triangles;
    cloth.state = lifted_sheet(0);
    cloth.uv = (low + (high - low) * cloth.state.positions.leftCols<2>().array()).matrix();
    const Glb glb(glb_bytes({cloth}, {{"one", {0}}}));
    const auto& mesh = glb.json["meshes"][0];
    std::vector<float> uv = glb.floats(mesh["primitives"][0]["attributes"]["TEXCOORD_0"]);
    for (std::size_t i = 1; i < uv.size(); i += 2) uv[i] = 1 - uv[i];
    return std::pair(uv, mesh.contains("extras") ? mesh["extras"] : nlohmann::json());
  };
  const auto [plain, nothing] = coordinates(0, 1);
  CHECK(nothing.is_null());
  for (const auto& [low, high] : {std::pair(0., 840.), {-300., 540.}}) {
    const auto [uv, extras] = coordinates(low, high);
    CHECK(uv == plain);
    CHECK((extras == nlohmann::json{{"texcoordScale", 1 / 840.}}));
  }
  const auto [tiles, none] = coordinates(0, 10);  // as of UDIM
  CHECK(none.is_null());
  CHECK(*std::ranges::max_element(tiles) == 10);
}
