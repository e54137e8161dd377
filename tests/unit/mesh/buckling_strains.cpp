#include "core/numerics/buckling/buckling_strains.h"

#include <catch2/catch.hpp>

#include "core/numerics/buckling/buckling_membrane.h"
#include "core/numerics/elements/jet_functions.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"
#include "tests/support/registry.h"

using namespace drape;
using Eigen::Matrix2d, Eigen::Vector2d, Eigen::Vector3d;
using P = Pack<native_pack_width>;

namespace {

constexpr double stiff = 1e3, largest_compression = 4e-3;  // [N/m], [1]: s over stiffness and area

/// Warp, weft and shear of woven cloth, with contraction across.
template <class T>
Jet<3, T> woven(const Eigen::Matrix<T, 3, 1>& g, const T* place) {
  using J = Jet<3, T>;
  const J g11 = J::variable(g[0], 0), g22 = J::variable(g[1], 1), g12 = J::variable(g[2], 2);
  return (stiff * place[0]) * (0.5 * g11 * g11 + 0.1 * g22 * g22 + 0.06 * g11 * g22 + 0.06 * g12 * g12);
}

/// A convex law whose energy has lost digits where strains are small, as 1 is subtracted.
template <class T>
Jet<3, T> exponential(const Eigen::Matrix<T, 3, 1>& g, const T* place) {
  using J = Jet<3, T>;
  const J g11 = J::variable(g[0], 0), g22 = J::variable(g[1], 1), g12 = J::variable(g[2], 2);
  return (stiff * place[0]) * (exp(4.0 * (g11 * g11 + g22 * g22) + g12 * g12) - 1.0);
}

/// St. Venant–Kirchhoff with λ = μ = 1 kN/m.
template <class T>
Jet<3, T> stvk(const Eigen::Matrix<T, 3, 1>& g, const T* place) {
  using J = Jet<3, T>;
  const J g11 = J::variable(g[0], 0), g22 = J::variable(g[1], 1), g12 = J::variable(g[2], 2);
  const J trace = g11 + g22;
  return (stiff * place[0]) * (g11 * g11 + g22 * g22 + 2.0 * g12 * g12 + 0.5 * trace * trace);
}

/// One triangle whose first edge is the material's first axis, and states of it.
struct Fixture {
  Level level = Level::of(0, mesh_of({{0, 0, 0}, {1, 0, 0}, {0.3, 0.9, 0}}, {{0, 1, 2}}));
  double area = level.vertex_area.sum(), s = largest_compression * stiff * area;
  std::vector<MaterialTriangle> triangles = material_triangles(level);

  std::unique_ptr<BoundEnergy> bind(const StrainLaw& law, double own_s) const {
    return bind_buckling_strains(law, triangles, level, own_s);
  }
  /// Stretched by s1 along `angle` in the material and by s2 across.
  Positions state(double s1, double s2, double angle) const {
    const Matrix2d v = Eigen::Rotation2Dd(angle).toRotationMatrix();
    Positions x = level.rest.vertices;
    x.leftCols<2>() *= v * Vector2d(s1, s2).asDiagonal() * v.transpose();
    return x;
  }
  /// Taut, wrinkled, slack, fully wrinkled along one axis or both, at several angles.
  template <class Body>
  void for_each_state(const Body& body) const {
    static constexpr double stretches[][2] = {{1.06, 1.03}, {1.05, 0.8}, {1.01, 0.95}, {0.96, 0.85},
                                              {1.2, 0.3},   {0.9, 0.3},  {0.4, 0.3},   {0.99, 0.6}};
    for (const auto& [s1, s2] : stretches)
      for (const double angle : {0.0, 0.3, 0.8, 1.5}) {
        INFO("stretches " << s1 << ", " << s2 << " at " << angle);
        body(state(s1, s2, angle));
      }
  }
};

}  // namespace

TEST_CASE("An anisotropic membrane that buckles has the derivatives of its energy") {
  const Fixture f;
  for (const double s : {0.0, f.s}) {
    const auto energy = f.bind(woven<P>, s);
    f.for_each_state([&](const Positions& x) {
      const Eigen::VectorXd g = gradient_by_differences(*energy, x, 1e-5);
      CHECK((g - flat(gradient_of(*energy, x))).norm() <= 1e-8 * stiff);
      const Eigen::MatrixXd h = dense(hessian_of(*energy, x, Projection::none));
      CHECK((h - hessian_by_differences(*energy, x, 1e-5)).norm() <= 1e-5 * stiff);
    });
  }
  // Forces are exact where the energy has lost digits.
  for (const double s : {1e-3 * f.s, f.s}) {
    const auto energy = f.bind(exponential<P>, s);
    f.for_each_state([&](const Positions& x) {
      const Eigen::MatrixXd h = dense(hessian_of(*energy, x, Projection::none));
      for (const double step : {1e-6, 1e-7})
        CHECK((h - hessian_by_differences(*energy, x, step)).norm() <= 1e-7 * h.norm());
    });
  }
}

TEST_CASE("An isotropic law buckles in the same way by strains as by stretches") {
  const Fixture f;
  Material material;  // λ and μ of 1 kN/m
  material.thickness = 1e-3, material.membrane_modulus = 8e6 / 3, material.poisson_ratio = 1. / 3;
  const auto strains = f.bind(stvk<P>, f.s),
             stretches = make_plugin_from<Energy>("stvk")->bind_buckling(f.level, material, f.s);
  f.for_each_state([&](const Positions& x) {
    CHECK(strains->value(x) == Approx(stretches->value(x)).epsilon(1e-9));
    CHECK((gradient_of(*strains, x) - gradient_of(*stretches, x)).norm() <= 1e-9 * stiff);
    const Eigen::MatrixXd h = dense(hessian_of(*strains, x, Projection::none));
    CHECK((h - dense(hessian_of(*stretches, x, Projection::none))).norm() <= 1e-6 * stiff);
  });
}

TEST_CASE("The energy of an anisotropic membrane that buckles is the smallest over all shortenings") {
  const Fixture f;
  const auto energy = f.bind(woven<P>, f.s);
  constexpr double remainder = Buckling<double>::remainder, most = Buckling<double>::most;
  const auto plain = [&](const Matrix2d& m) {
    const Vector3d strains(0.5 * (m(0, 0) - 1), 0.5 * (m(1, 1) - 1), 0.5 * m(0, 1));
    return woven(strains, f.triangles[0].data() + 4).value;
  };
  const auto edges = [](const Positions& x) -> Matrix2d { return x.bottomLeftCorner<2, 2>().transpose(); };
  f.for_each_state([&](const Positions& x) {
    const Matrix2d deformation = edges(x) * edges(f.level.rest.vertices).inverse();
    const Matrix2d c = deformation.transpose() * deformation;
    double smallest = 1e9;
    for (double q1 = 1; q1 <= most; q1 += (most - 1) / 100)
      for (double q2 = 1; q2 <= most; q2 += (most - 1) / 100)
        for (double angle = 0; angle < 1.57; angle += 0.06) {
          const Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
          const Matrix2d m =
              deformation.transpose() * turn * Vector2d(q1, q2).asDiagonal() * turn.transpose() * deformation;
          smallest = std::min(smallest, plain(m) + f.s * (m - c).trace() / 2);
        }
    const double found = (energy->value(x) - remainder * plain(c)) / (1 - remainder);
    CHECK(found <= smallest + 1e-12 * stiff);
    CHECK(found >= smallest - 1e-3 * stiff * f.area);
  });
  // A strip that is compressed along its weft resists with the bound alone.
  const auto value = [&](double across) { return energy->value(f.state(1.02, across, 0)); };
  const double slope = (value(0.8 + 1e-6) - value(0.8 - 1e-6)) / 2e-6;
  const double own = 0.01 * stiff * f.area * (0.2 * -0.18 + 0.06 * 0.0202) * 0.8;  // the remainder's
  CHECK(slope == Approx(-0.99 * f.s * 0.8 + own).epsilon(1e-6));
}

TEST_CASE("A triangle that buckles has the same bits whichever triangles are evaluated with it") {
  const Fixture f;
  const auto alone = f.bind(woven<P>, f.s);
  std::vector<Positions> states;
  TriangleMesh rest, deformed;
  f.for_each_state([&](const Positions& x) {
    rest = both_of(rest, f.level.rest, {0, 2. * static_cast<double>(states.size()), 0});
    deformed = both_of(deformed, {x, f.level.rest.triangles}, {0, 0, 0});
    states.push_back(x);
  });
  const std::vector<MaterialTriangle> same(states.size(), f.triangles[0]);
  const auto together = bind_buckling_strains(woven<P>, same, Level::of(0, rest), f.s);
  const Positions g = gradient_of(*together, deformed.vertices);
  for (std::size_t t = 0; t < states.size(); ++t)
    CHECK(g.middleRows<3>(3 * t) == gradient_of(*alone, states[t]));
}
