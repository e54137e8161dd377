// Plates under small loads, by every bending model on every triangulation. In the plane state bending sees
// deflections alone, so that its exact Hessian there gives a linear problem for them.

#include <Eigen/SparseCholesky>

#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/free_stiffness.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

const char* const hinge_and_others[] = {"hinge", "quadratic_bending",
                                        "{type: midedge_bending, correction_tolerance: 1}",  // plain averages
                                        "midedge_bending"};

using Matrix = Eigen::SparseMatrix<double>;
using Place = Eigen::Vector2d;

/// Stiffness of the free vertices' deflections.
Matrix plate_stiffness_of(const Level& level, const std::string& model, double nu, const FreeVertices& free) {
  const auto energy = on_unit_plate(model, level, nu);
  return stiffness_of(hessian_of(*energy, level.rest.vertices, Projection::none), free, {2});
}

/// A rectangle whose vertices cannot move at some places, under its weight or a force of 1 N at its last
/// corner.
struct LoadCase {
  const char* name;
  Eigen::Vector2d size;
  double nu;
  bool (*holds)(const Place&);
  bool at_corner;
  double deflection;  ///< of the plate, the largest or the corner's
  double bound;       ///< of midedge_bending's error on the finest mesh
};

bool on_ends(const Place& p) { return p.x() == 0 || p.x() == 1; }
bool on_sides(const Place& p) { return on_ends(p) || p.y() == 0 || p.y() == 1; }
bool on_corners(const Place& p) { return p.minCoeff() == 0 && (p.maxCoeff() == 0 || p.maxCoeff() == 1); }

const LoadCase load_cases[] = {
    {"strip on two supports", {1, 0.2}, 0, on_ends, false, 5. / 384, 0.002},
    {"plate on its sides", {1, 1}, 0.3, on_sides, false, 0.00406235, 0.002},
    {"plate twisted by its corners", {1, 1}, 0.3, on_corners, true, 1 / 1.4, 0.001}};  // P x y / 2 D (1 − ν)

/// Stiffness over the plate's.
double relative_stiffness(const LoadCase& load, const std::string& triangulation, const std::string& model,
                          double a) {
  const Level level = Level::of(0, triangulated(triangulation, load.size, a));
  const FreeVertices free(level, load.holds);
  Eigen::Index corner = 0;
  level.rest.vertices.leftCols<2>().rowwise().sum().maxCoeff(&corner);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(free.count);
  free.each([&](int v, int i) { force[i] = load.at_corner ? v == corner : level.vertex_area[v]; });
  const Eigen::SimplicialLDLT<Matrix> factor(plate_stiffness_of(level, model, load.nu, free));
  REQUIRE(factor.info() == Eigen::Success);
  REQUIRE(factor.vectorD().minCoeff() > 0);
  const Eigen::VectorXd w = factor.solve(force);
  return load.deflection / (load.at_corner ? w[free.number[corner]] : w.maxCoeff());
}

}  // namespace

TEST_CASE("Only midedge_bending is a plate, and on every triangulation") {
  for (const LoadCase& load : load_cases) {
    table(std::string("Stiffness over that of the plate: ") + load.name, "triangles", "a", "hinge",
          "quadratic", "average", "midedge");
    for (const std::string& triangulation : all_triangulations) {
      double last = 0;
      for (const double a : {0.1, 0.05, 0.025}) {
        double s[4];
        for (int m = 0; m < 4; ++m) s[m] = relative_stiffness(load, triangulation, hinge_and_others[m], a);
        row(triangulation, a, s[0], s[1], s[2], s[3]);
        CHECK(s[1] == Approx(s[0]).epsilon(1e-9));
        const double error = std::abs(s[3] - 1);
        if (last > 1e-3) CHECK(error < last);
        if (a == 0.025) CHECK(error < load.bound);
        last = error;
      }
    }
  }
}

TEST_CASE("midedge_bending has the modes of a plate on every triangulation, and no others below them") {
  table("Eigenvalues of a square plate on its sides over those of the plate, pi^4 (m² + n²)²; a = 1/20",
        "triangles", "1st", "2nd", "5th", "10th", "20th");
  std::vector<double> expected;
  for (int m = 1; m < 8; ++m)
    for (int n = 1; n < 8; ++n) expected.push_back(std::pow(M_PI, 4) * std::pow(m * m + n * n, 2));
  std::sort(expected.begin(), expected.end());
  for (const std::string& triangulation : all_triangulations) {
    const Level level = Level::of(0, triangulated(triangulation, {1, 1}, 0.05));
    const FreeVertices free(level, on_sides);
    Eigen::VectorXd scale(free.count);
    free.each([&](int v, int i) { scale[i] = 1 / std::sqrt(level.vertex_area[v]); });
    const Eigen::MatrixXd k = plate_stiffness_of(level, "midedge_bending", 0.3, free);
    const Eigen::VectorXd found = eigenvalues_of(scale.asDiagonal() * k * scale.asDiagonal());
    const auto ratio = [&](int i) { return found[i] / expected[i]; };
    row(triangulation, ratio(0), ratio(1), ratio(4), ratio(9), ratio(19));
    for (int i = 0; i < 20; ++i) CHECK(ratio(i) == Approx(1).epsilon(0.15));
  }
}
