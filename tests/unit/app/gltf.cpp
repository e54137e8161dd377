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

GltfSurface surface(const std::string& name) {
  const TriangleMesh mesh = grid({1, 0.5}, 3, 3, Diagonals::one_way);
  GltfSurface s;
  s.name = name;
  s.triangles = mesh.triangles;
  s.state = lifted_sheet(0.3);
  s.uv = mesh.vertices.leftCols<2>();
  return s;
}

/// x, y, z of a row in glTF's axes.
std::vector<float> turned(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.z()), static_cast<float>(-v.y())};
}

std::vector<float> row(const std::vector<float>& all, Eigen::Index i) {
  return {all.begin() + 3 * i, all.begin() + 3 * i + 3};
}

}  // namespace

TEST_CASE("a surface has its positions, normals and triangles with y upwards, and texture coordinates") {
  const GltfSurface cloth = surface("cloth");
  const Glb glb(glb_bytes({cloth}, {{"one", {0}}}));
  REQUIRE(glb.json.at("meshes").size() == 1);
  const auto& primitive = glb.json["meshes"][0].at("primitives").at(0);
  CHECK_FALSE(primitive.contains("targets"));
  CHECK_FALSE(glb.json.contains("animations"));
  const auto positions = glb.floats(primitive.at("attributes").at("POSITION"));
  const auto normals = glb.floats(primitive["attributes"].at("NORMAL"));
  const auto uv = glb.floats(primitive["attributes"].at("TEXCOORD_0"));
  REQUIRE(positions.size() == 27);
  REQUIRE(uv.size() == 18);
  CHECK(glb.json["accessors"][primitive["attributes"]["POSITION"].get<int>()].contains("min"));
  for (Eigen::Index i = 0; i < 9; ++i) {
    INFO("vertex " << i);
    CHECK((row(positions, i) == turned(cloth.state.positions.row(i))));
    CHECK((row(normals, i) == turned(cloth.state.normals.row(i))));
    CHECK(uv[2 * i] == static_cast<float>(cloth.uv(i, 0)));
    CHECK(uv[2 * i + 1] == static_cast<float>(1 - cloth.uv(i, 1)));
  }
  const std::vector<std::uint32_t> corners(cloth.triangles.data(),
                                           cloth.triangles.data() + cloth.triangles.size());
  CHECK(glb.indices(primitive.at("indices")) == corners);
  const auto& views = glb.json.at("bufferViews");
  CHECK(views.at(glb.json["accessors"][primitive["indices"].get<int>()]["bufferView"].get<int>())
            .at("target") == 34963);
  CHECK(glb.json.at("materials").at(primitive.at("material").get<int>()).at("doubleSided") == true);
}

TEST_CASE("earlier states are morph targets, shown one after the other, and the last state at the end") {
  GltfSurface cloth = surface("cloth");
  cloth.earlier = {lifted_sheet(0), lifted_sheet(-0.7)};
  const Glb glb(glb_bytes({cloth}, {{"one", {0}}}));
  const auto& mesh = glb.json.at("meshes").at(0);
  const auto& primitive = mesh.at("primitives").at(0);
  REQUIRE(primitive.at("targets").size() == 2);
  CHECK((mesh.at("weights") == nlohmann::json{0.0, 0.0}));
  CHECK(mesh.at("extras").at("targetNames").size() == 2);
  const auto base = glb.floats(primitive["attributes"]["POSITION"]);
  const auto base_normals = glb.floats(primitive["attributes"]["NORMAL"]);
  for (std::size_t t = 0; t < 2; ++t) {
    const auto moved = glb.floats(primitive["targets"][t].at("POSITION"));
    const auto turned_by = glb.floats(primitive["targets"][t].at("NORMAL"));
    REQUIRE(moved.size() == base.size());
    CHECK(glb.json["accessors"][primitive["targets"][t]["POSITION"].get<int>()].contains("max"));
    double largest = 0;
    for (Eigen::Index i = 0; i < 9; ++i)
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = 3 * i + k;
        CHECK(base[at] + moved[at] == Approx(turned(cloth.earlier[t].positions.row(i))[k]).margin(1e-6));
        CHECK(base_normals[at] + turned_by[at] ==
              Approx(turned(cloth.earlier[t].normals.row(i))[k]).margin(1e-6));
        largest = std::max(largest, std::abs(double(moved[at])));
      }
    CHECK(largest > 0.1);
  }
  REQUIRE(glb.json.at("animations").size() == 1);
  const auto& animation = glb.json["animations"][0];
  CHECK((animation.at("channels").at(0).at("target") == nlohmann::json{{"node", 0}, {"path", "weights"}}));
  const auto& sampler = animation.at("samplers").at(animation["channels"][0].at("sampler").get<int>());
  CHECK((glb.floats(sampler.at("input")) == std::vector<float>{0, 0.25f, 0.5f}));
  CHECK((glb.floats(sampler.at("output")) == std::vector<float>{1, 0, 0, 1, 0, 0}));
  CHECK(glb.json["accessors"][sampler["input"].get<int>()].contains("min"));
}
