// Cloth of flat pieces, solved: where its pieces lie in their plane says nothing, and what it makes is what
// the surface in space makes.

#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/rest_hinge.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/faceted.h"
#include "tests/support/sewn.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

/// Such a mesh in `e.obj`, as a cloth with these further keys, to its equilibrium.
Solved at_rest(const TriangleMesh& mesh, const std::string& cloth, const std::string& keys) {
  const Scratch folder("name: sewn\ncloth: {shape: file, file: e.obj, " + cloth + "}\n" + keys);
  write_mesh(folder / "e.obj", mesh);
  return converged(solved(experiment_in(folder / "e.yaml")));
}

double difference(const Solved& a, const Solved& b) {
  return (a.x() - b.x()).cwiseAbs().maxCoeff() / bounding_box_diagonal(a.rest());
}

std::string hung() {
  return "levels: 2\nrefiner: midpoint\nmaterial: {density: 300, thickness: 5e-4, membrane_modulus: 2e5, "
         "bending_modulus: 2e6}\npins: [{region: border}]\nenergies: [stvk, hinge, gravity]\nmethods: {pcs: "
         "{}}\n" +
         newton_to(1e-9);
}

}  // namespace

TEST_CASE(
    "A cloth of two pieces comes to the same rest wherever they lie, turned, mirrored, in millimetres") {
  const TriangleMesh whole = disc(0.2, 90);
  const TriangleMesh halves = as_piece(whole);
  const std::vector<char> left = left_half(whole);
  const Solved sewn = at_rest(halves, "rest: uv, uv_unit: m", hung());
  REQUIRE((sewn.x() - sewn.rest()).cwiseAbs().maxCoeff() > 0.005);
  for (const auto& [degrees, mirrored] : {std::pair(0., false), {35., false}, {200., true}}) {
    TriangleMesh placed = halves;
    place_piece(placed, left, degrees, mirrored, {0.7, -3});
    CHECK(difference(sewn, at_rest(placed, "rest: uv, uv_unit: m", hung())) < 1e-9);
    placed.uv *= 1000;
    CHECK(difference(sewn, at_rest(placed, "rest: uv, uv_unit: mm", hung())) < 1e-9);
  }
}

TEST_CASE(
    "A cone that is sewn from a disc without a sector sags under its weight as the cone in space does") {
  // Both resist every fold, also those with which the cone in space is given.
  std::string keys = hung();
  const std::string folds =
      "{type: formula, per: hinge, constants: {k: {value: 1e-4, unit: J}}, energy: "
      "\"k*length^2/area*theta^2\"}";
  keys.replace(keys.find("hinge"), 5, folds);
  const int n = GENERATE(12, 24);
  const TriangleMesh cone = faceted_cone(n, 1, 0.1);
  const Solved space = at_rest(cone, "", keys),
               sewn = at_rest(as_sector(cone, n, 1, 0.1), "rest: uv, uv_unit: m", keys);
  CHECK(difference(space, sewn) < 1e-9);
  const Eigen::VectorXd sag = space.rest().col(2) - space.x().col(2);
  CHECK(sag.maxCoeff() > 0.001);
  row("Largest sag [m], and of the apex", sag.maxCoeff(), sag[0]);
}

TEST_CASE(
    "A cone of plane pieces that are sewn at its angles sags as the cone in space, which rests so, does") {
  constexpr int n = 12;
  const TriangleMesh cone = faceted_cone(n, 1, 0.1);
  const Level level = Level::of(0, cone);
  const auto spoke =
      std::ranges::find_if(level.hinge_edges, [&](int e) { return level.topology.edges(e, 0) == 0; });
  const int hinge = static_cast<int>(spoke - level.hinge_edges.begin());
  const double fold = DihedralAngle<double>(rest_vectors(level, hinge).data()).angle();
  REQUIRE(std::abs(fold) > 0.1);
  const Solved space = at_rest(cone, "", hung()),
               sewn = at_rest(as_facets(cone, n, fold),
                              filled("rest: uv, uv_unit: m, seams: {angle: $}", fold * 180 / M_PI), hung());
  CHECK(difference(space, sewn) < 1e-9);
  CHECK((space.x() - space.rest()).cwiseAbs().maxCoeff() > 0.001);
}

TEST_CASE(
    "A cantilever of a piece that is cut at 30 degrees bends as the elastica with that direction's "
    "rigidity") {
  // Weight over the rigidities: 1 along warp, 2 along weft, 1.5 on the bias: s12 + s66 / 2 = (s11 + s22) / 2
  // there, and s11 is linear in cos²: 1.25 at 30°.
  const CutStrip strip{{40, 2}, "criss_cross", 30};
  const auto rigidity = [](const char* direction, double gamma) {
    return filled("$_bending: $", direction, CutStrip::weight() / gamma);
  };
  const std::string material = "poisson_ratio: 0, " + rigidity("warp", 1) + ", " + rigidity("weft", 2) +
                               ", " + rigidity("bias", 1.5),
                    energies = "woven, midedge_bending, gravity";
  const Solved plain = strip.solved(material, energies);
  TriangleMesh piece =
      as_piece(triangulated("criss_cross", {strip.length(), strip.width()}, Eigen::Vector2i(40, 2)));
  place_piece(piece, std::vector<char>(piece.triangles.rows(), 1), 60, false,
              {0.1, 0.2});  // 30° lies along y
  const std::string whole =
      strip.yaml(strip.width(), "rows: 3", "membrane_modulus: 1e8, " + material, energies, newton_to(1e-5));
  const std::size_t from = whole.find("\nmaterial");
  const Solved cut =
      at_rest(piece, "rest: uv, uv_unit: m", "levels: 1\nmethods: {newton: {}}\n" + whole.substr(from + 1));
  const double angle = strip.tip_angle(cut);
  CHECK(angle == Approx(tip_under_weight(1.25)).epsilon(0.02));
  CHECK(angle == Approx(strip.tip_angle(plain)).epsilon(1e-6));
  CHECK(std::abs(tip_under_weight(1.25) - tip_under_weight(1.5)) > 0.1 * angle);  // not as along the bias
}
