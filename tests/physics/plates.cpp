// Plates under small loads, by every bending model on every triangulation. In the plane state bending sees
// deflections alone, so that its exact Hessian there gives a linear problem for them.

#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/free_stiffness.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

struct Model {
  std::string name, yaml;
};

const Model models[] = {{"hinge", "hinge"},
                        {"quadratic", "quadratic_bending"},
                        {"average", "{type: midedge_bending, correction_tolerance: 1}"},
                        {"midedge", "midedge_bending"}};

using Matrix = Eigen::SparseMatrix<double>;

BlockMatrix hessian_at_rest(const Level& level, const Model& model, double nu) {
  const auto energy = make_plugin_from<Energy>(model.yaml)->bind(level, unit_plate(nu));
  return hessian_of(*energy, level.rest.vertices, Projection::none);
}

/// Deflections under forces, where no vertex for whose place held(p) holds moves.
template <class Held>
Eigen::VectorXd deflections(const Level& level, const BlockMatrix& h, const Eigen::VectorXd& forces,
                            const Held& held) {
  const FreeVertices free(level, held);
  const std::vector<int>& number = free.number;
  Eigen::VectorXd f(free.count);
  for (int v = 0; v < level.vertex_count(); ++v)
    if (number[v] >= 0) f[number[v]] = forces[v];
  const Eigen::SimplicialLDLT<Matrix> factor(stiffness_of(h, free, {2}));
  REQUIRE(factor.info() == Eigen::Success);
  REQUIRE(factor.vectorD().minCoeff() > 0);
  const Eigen::VectorXd solved = factor.solve(f);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(level.vertex_count());
  for (int v = 0; v < level.vertex_count(); ++v)
    if (number[v] >= 0) w[v] = solved[number[v]];
  return w;
}

/// A strip on two supports under its weight, ν = 0: stiffness over the beam's, from 5 q L⁴ / 384 D in the
/// middle.
double beam(const std::string& triangulation, const Model& model, double a) {
  const Level level = Level::of(0, triangulated(triangulation, {1, 0.2}, a));
  const BlockMatrix h = hessian_at_rest(level, model, 0);
  const Eigen::VectorXd w = deflections(level, h, level.vertex_area,
                                        [](const Eigen::Vector2d& p) { return p.x() == 0 || p.x() == 1; });
  return 5. / 384 / w.maxCoeff();
}

bool on_sides(const Eigen::Vector2d& p) { return p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1; }

/// A square plate on its four sides under its weight: stiffness over the plate's, 0.00406235 q L⁴ / D.
double supported_plate(const std::string& triangulation, const Model& model, double a) {
  const Level level = Level::of(0, triangulated(triangulation, {1, 1}, a));
  const BlockMatrix h = hessian_at_rest(level, model, 0.3);
  const Eigen::VectorXd w = deflections(level, h, level.vertex_area, on_sides);
  return 0.00406235 / w.maxCoeff();
}

/// A square plate on three corners with a force P on the fourth, w = P x y / 2 D (1 − ν): stiffness over the
/// plate's.
double twisted_plate(const std::string& triangulation, const Model& model, double a) {
  const double nu = 0.3;
  const Level level = Level::of(0, triangulated(triangulation, {1, 1}, a));
  const BlockMatrix h = hessian_at_rest(level, model, nu);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(level.vertex_count());
  Eigen::Index corner = 0;  // (1, 1)
  level.rest.vertices.leftCols<2>().rowwise().sum().maxCoeff(&corner);
  force[corner] = 1;
  const Eigen::VectorXd w = deflections(level, h, force, [](const Eigen::Vector2d& p) {
    return (p.x() == 0 && p.y() == 0) || (p.x() == 1 && p.y() == 0) || (p.x() == 0 && p.y() == 1);
  });
  return 1 / (2 * (1 - nu)) / w[corner];
}

struct LoadCase {
  std::string name;
  double (*stiffness)(const std::string& triangulation, const Model& model, double a);
  double bound;  ///< of midedge_bending's error on the finest mesh
};

const LoadCase load_cases[] = {{"beam", beam, 0.002},
                               {"plate on its sides", supported_plate, 0.002},
                               {"plate twisted by its corners", twisted_plate, 0.001}};

}  // namespace

TEST_CASE("Only midedge_bending is a plate, and on every triangulation", "[physics]") {
  for (const LoadCase& load : load_cases) {
    row("\nStiffness of a %s over that of the plate", load.name.c_str());
    row("%14s %8s %10s %10s %10s %10s", "triangles", "a", "hinge", "quadratic", "average", "midedge");
    for (const std::string& triangulation : all_triangulations) {
      double last = 0;
      for (const double a : {0.1, 0.05, 0.025}) {
        double s[4];
        for (int m = 0; m < 4; ++m) s[m] = load.stiffness(triangulation, models[m], a);
        row("%14s %8g %10.4f %10.4f %10.4f %10.4f", triangulation.c_str(), a, s[0], s[1], s[2], s[3]);
        INFO(load.name << ", " << triangulation << ", a = " << a);
        CHECK(s[1] == Approx(s[0]).epsilon(1e-9));
        const double error = std::abs(s[3] - 1);
        if (last > 1e-3) CHECK(error < last);
        if (a == 0.025) CHECK(error < load.bound);
        last = error;
      }
    }
  }
}

TEST_CASE("midedge_bending has the modes of a plate on every triangulation, and no others below them",
          "[physics]") {
  row("\nEigenvalues of a square plate on its sides over those of the plate, pi^4 (m² + n²)²; a = 1/20");
  std::vector<double> expected;
  for (int m = 1; m < 8; ++m)
    for (int n = 1; n < 8; ++n) expected.push_back(std::pow(M_PI, 4) * std::pow(m * m + n * n, 2));
  std::sort(expected.begin(), expected.end());
  for (const std::string& triangulation : all_triangulations)
    for (const Model& model : models) {
      if (model.name == "quadratic") continue;
      const Level level = Level::of(0, triangulated(triangulation, {1, 1}, 0.05));
      const FreeVertices free(level, on_sides);
      Eigen::MatrixXd k = stiffness_of(hessian_at_rest(level, model, 0.3), free, {2});
      for (int v = 0; v < level.vertex_count(); ++v)
        if (const int i = free.number[v]; i >= 0) {
          const double scale = 1 / std::sqrt(level.vertex_area[v]);
          k.row(i) *= scale;
          k.col(i) *= scale;
        }
      const Eigen::VectorXd found = eigenvalues_of(k);
      row("%14s %10s  1st %.4f  2nd %.4f  5th %.4f  10th %.4f  20th %.4f", triangulation.c_str(),
          model.name.c_str(), found[0] / expected[0], found[1] / expected[1], found[4] / expected[4],
          found[9] / expected[9], found[19] / expected[19]);
      INFO(triangulation);
      if (model.name == "midedge")
        for (int i = 0; i < 20; ++i) CHECK(found[i] / expected[i] == Approx(1).epsilon(0.15));
    }
}
