#include "core/numerics/buckling/buckling_strains.h"

#include <catch2/catch.hpp>

#include "core/numerics/buckling/buckling_membrane.h"
#include "core/numerics/elements/jet_functions.h"
#include "tests/support/evaluate.h"

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

struct StvkByStretches {
  static constexpr int constants = 1;
  template <class T>
  PrincipalDerivatives<T> operator()(const T& t1, const T& t2, const T* rest) const {
    using J = Jet<2, T>;
    const J s1 = J::variable(t1, 0), s2 = J::variable(t2, 1);
    const J g1 = 0.5 * (s1 * s1 - 1.0), g2 = 0.5 * (s2 * s2 - 1.0);
    const J w = rest[0] * stiff * (g1 * g1 + g2 * g2 + 0.5 * (g1 + g2) * (g1 + g2));
    return {w.value, w.first[0], w.first[1], w.second_by(0, 0), w.second_by(1, 1), w.second_by(0, 1)};
  }
};

/// One triangle whose first edge is the material's first axis, and states of it.
struct Fixture {
  Level level = Level::of(0, [] {
    TriangleMesh mesh{Positions(3, 3), Triangles(1, 3)};
    mesh.vertices << 0, 0, 0, 1, 0, 0, 0.3, 0.9, 0;
    mesh.triangles << 0, 1, 2;
    return mesh;
  }());
  double area = level.vertex_area.sum(), s = largest_compression * stiff * area;
  std::vector<MaterialTriangle> triangles = material_triangles(level);

  std::unique_ptr<BoundEnergy> bind(const StrainLaw& law, double own_s) const {
    return bind_buckling_strains(law, triangles, level, own_s);
  }
  /// Stretched by s1 along `angle` in the material and by s2 across.
  Positions state(double s1, double s2, double angle) const {
    const Eigen::Rotation2Dd v(angle);
    const Matrix2d f =
        v.toRotationMatrix() * Vector2d(s1, s2).asDiagonal() * v.toRotationMatrix().transpose();
    Positions x = level.rest.vertices;
    x.leftCols<2>() = level.rest.vertices.leftCols<2>() * f.transpose();
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
      CHECK((gradient_by_differences(*energy, x, 1e-5) - flat(gradient_of(*energy, x))).norm() <=
            1e-8 * stiff);
      const Eigen::MatrixXd h = dense(hessian_of(*energy, x, Projection::none));
      CHECK((h - hessian_by_differences(*energy, x, 1e-5)).norm() <= 1e-5 * stiff);
    });
  }
}

TEST_CASE("The forces of a membrane that buckles are exact where its energy has lost digits") {
  const Fixture f;
  for (const double s : {1e-3 * f.s, f.s}) {
    const auto energy = f.bind(exponential<P>, s);
    f.for_each_state([&](const Positions& x) {
      const Eigen::MatrixXd h = dense(hessian_of(*energy, x, Projection::none));
      for (const double step : {1e-6, 1e-7}) {
        INFO("s " << s << ", step " << step);
        CHECK((h - hessian_by_differences(*energy, x, step)).norm() <= 1e-7 * h.norm());
      }
    });
  }
}

TEST_CASE("An isotropic law buckles in the same way by strains as by stretches") {
  const Fixture f;
  const auto strains = f.bind(stvk<P>, f.s);
  const auto stretches = bind_buckling_membrane(StvkByStretches(), f.triangles, f.level, f.s);
  f.for_each_state([&](const Positions& x) {
    CHECK(strains->value(x) == Approx(stretches->value(x)).epsilon(1e-9));
    CHECK((gradient_of(*strains, x) - gradient_of(*stretches, x)).norm() <= 1e-9 * stiff);
    CHECK((dense(hessian_of(*strains, x, Projection::none)) -
           dense(hessian_of(*stretches, x, Projection::none)))
              .norm() <= 1e-6 * stiff);
  });
}

TEST_CASE("The energy of an anisotropic membrane that buckles is the smallest over all shortenings") {
  const Fixture f;
  const auto energy = f.bind(woven<P>, f.s);
  constexpr double remainder = Buckling<double>::remainder, most = Buckling<double>::most;
  f.for_each_state([&](const Positions& x) {
    const double* place = f.triangles[0].data() + 4;
    const Matrix2d deformation = x.leftCols<2>().bottomRows<2>().transpose() *
                                 f.level.rest.vertices.leftCols<2>().bottomRows<2>().transpose().inverse();
    const Matrix2d c = deformation.transpose() * deformation;
    const auto strains = [](const Matrix2d& m) {
      return Vector3d(0.5 * (m(0, 0) - 1), 0.5 * (m(1, 1) - 1), 0.5 * m(0, 1));
    };
    double smallest = 1e9;
    for (double q1 = 1; q1 <= most; q1 += (most - 1) / 100)
      for (double q2 = 1; q2 <= most; q2 += (most - 1) / 100)
        for (double angle = 0; angle < 1.57; angle += 0.06) {
          const Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
          const Matrix2d m =
              deformation.transpose() * turn * Vector2d(q1, q2).asDiagonal() * turn.transpose() * deformation;
          smallest = std::min(smallest, woven(strains(m), place).value + f.s * (m - c).trace() / 2);
        }
    const double found = (energy->value(x) - remainder * woven(strains(c), place).value) / (1 - remainder);
    CHECK(found <= smallest + 1e-12 * stiff);
    CHECK(found >= smallest - 1e-3 * stiff * f.area);
  });
}

TEST_CASE("A woven strip that is compressed along its weft resists with the bound alone") {
  const Fixture f;
  const auto energy = f.bind(woven<P>, f.s);
  const double width = 1e-6;
  const double slope =
      (energy->value(f.state(1.02, 0.8 + width, 0)) - energy->value(f.state(1.02, 0.8 - width, 0))) /
      (2 * width);
  const double plain = 0.01 * stiff * f.area * (0.2 * -0.18 + 0.06 * 0.0202) * 0.8;  // the remainder's
  CHECK(slope == Approx(-0.99 * f.s * 0.8 + plain).epsilon(1e-6));
}

TEST_CASE("A triangle that buckles has the same bits whichever triangles are evaluated with it") {
  const Fixture f;
  const auto alone = f.bind(woven<P>, f.s);
  std::vector<Positions> states;
  f.for_each_state([&](const Positions& x) { states.push_back(x); });
  const auto count = static_cast<Eigen::Index>(states.size());
  TriangleMesh mesh{Positions(3 * count, 3), Triangles(count, 3)};
  Positions x(3 * count, 3);
  for (Eigen::Index t = 0; t < count; ++t) {
    mesh.vertices.middleRows<3>(3 * t) = f.level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 2.0 * t, 0);
    mesh.triangles.row(t) << 3 * t, 3 * t + 1, 3 * t + 2;
    x.middleRows<3>(3 * t) = states[static_cast<std::size_t>(t)];
  }
  const Level level = Level::of(0, mesh);
  const std::vector<MaterialTriangle> same(static_cast<std::size_t>(count), f.triangles[0]);
  const Positions g = gradient_of(*bind_buckling_strains(woven<P>, same, level, f.s), x);
  for (Eigen::Index t = 0; t < count; ++t)
    CHECK(g.middleRows<3>(3 * t) == gradient_of(*alone, states[static_cast<std::size_t>(t)]));
}
