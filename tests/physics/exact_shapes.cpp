// Bending energies of given shapes: of those that a flat or curved rest shape takes without stretching, by
// every bending model on every triangulation, beside the energy of a Kirchhoff–Love plate; of creases; and of
// small curvatures by hinges, whose stiffness follows from the triangulation.

#include "tests/support/strip.h"

using namespace drape;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double poisson = 0.3;

/// A surface and another one of the same metric, over a rectangle from (0, 0) to `size`.
struct Shape {
  const char* name;
  Vector2d size;
  Vector3d (*rest)(const Vector2d& p);
  /// Null for the rest shape in a mirror: the same lengths, and the shape operator times −1.
  Vector3d (*bent)(const Vector2d& p);
  /// Plate energy per area of the rectangle: ½ ((1 − ν) tr S² + ν (tr S)²) of the change S of the shape
  /// operator, times the area that the surface has there.
  double (*density)(const Vector2d& p);

  Vector3d deformed(const Vector2d& p) const {
    return bent ? bent(p) : Vector3d(rest(p).cwiseProduct(Vector3d(1, 1, -1)));
  }
};

double plate_density(double first, double second) {
  return (first * first + second * second + 2 * poisson * first * second) / 2;
}

Vector3d in_plane(const Vector2d& p) { return {p.x(), p.y(), 0}; }

Vector3d half_cylinder(const Vector2d& p) { return {std::sin(p.x()), p.y(), std::cos(p.x())}; }
double of_cylinder(const Vector2d&) { return plate_density(1, 0); }

// The tangents of a helix with curvature 1 and torsion 1 unrolled: those of the unit circle. A point of the
// plane at the distance v from where its tangent touches has the curvature τ / κ v.
Vector2d outside_circle(const Vector2d& p) { return {p.x() - 1, p.y() + 1.2}; }
double along_tangent(const Vector2d& p) { return std::sqrt(outside_circle(p).squaredNorm() - 1); }
Vector3d tangents_of_helix(const Vector2d& p) {
  const Vector2d q = outside_circle(p);
  const double v = along_tangent(p), s = std::atan2(q.y(), q.x()) - std::atan(v);
  // Radius and rise per angle ½, so that both curvature and torsion are r / (r² + h²) = 1; arc length s.
  const double angle = s * std::sqrt(2.0), r = 0.5;
  const Vector3d place(r * std::cos(angle), r * std::sin(angle), r * angle);
  return place + v * Vector3d(-std::sin(angle), std::cos(angle), 1) / std::sqrt(2.0);
}
double of_tangents(const Vector2d& p) { return plate_density(1 / along_tangent(p), 0); }

const Vector2d pole(0.5, 0.5);
Vector3d sphere(const Vector2d& p) {
  const double angle = (p - pole).norm();
  const Vector2d q = std::sin(angle) * (p - pole).normalized();
  return {q.x(), q.y(), std::cos(angle)};
}
double of_sphere(const Vector2d& p) {
  const double angle = (p - pole).norm();
  return plate_density(2, 2) * std::sin(angle) / angle;
}

constexpr double tube_radius = 0.4;  // of a torus of radius 1
double from_axis(const Vector2d& p) { return 1 + tube_radius * std::cos(p.y() / tube_radius); }
Vector3d half_torus(const Vector2d& p) {
  const double r = from_axis(p);
  return {r * std::cos(p.x()), r * std::sin(p.x()), tube_radius * std::sin(p.y() / tube_radius)};
}
double of_torus(const Vector2d& p) {
  return plate_density(2 / tube_radius, 2 * std::cos(p.y() / tube_radius) / from_axis(p)) * from_axis(p);
}

constexpr double half_width = 0.75;
Vector3d helicoid(const Vector2d& p) {
  const double r = std::sinh(p.y() - half_width);
  return {r * std::sin(p.x()), -r * std::cos(p.x()), p.x()};
}
Vector3d catenoid(const Vector2d& p) {
  const double r = std::cosh(p.y() - half_width);
  return {r * std::cos(p.x()), r * std::sin(p.x()), p.y() - half_width};
}
double of_catenoid(const Vector2d& p) {
  const double metric = std::pow(std::cosh(p.y() - half_width), 2), change = std::sqrt(2.0) / metric;
  return plate_density(change, -change) * metric;
}

const Shape exact_shapes[] = {
    {"half cylinder", {M_PI, 1}, in_plane, half_cylinder, of_cylinder},
    {"tangents of a helix", {2, 1}, in_plane, tangents_of_helix, of_tangents},
    {"sphere, inside out", {1, 1}, sphere, nullptr, of_sphere},
    {"half torus, inside out", {M_PI, M_PI* tube_radius}, half_torus, nullptr, of_torus},
    {"helicoid to catenoid", {2, 2 * half_width}, helicoid, catenoid, of_catenoid}};

template <class Surface>
Positions on(const Surface& surface, const TriangleMesh& pattern) {
  Positions x = pattern.vertices;
  for (auto v : x.rowwise()) v = surface(Vector2d(v[0], v[1])).transpose();
  return x;
}

double plate_energy(const Shape& shape) {
  const int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += shape.density(Vector2d(i + 0.5, j + 0.5).cwiseProduct(shape.size) / n);
  return sum * shape.size.prod() / (n * n);
}

/// The model's energy over the plate's.
double ratio_to_plate(const std::string& model, const Shape& shape, const std::string& triangulation,
                      double a) {
  TriangleMesh rest = triangulated(triangulation, shape.size, a);
  const Positions bent = on([&](const Vector2d& p) { return shape.deformed(p); }, rest);
  rest.vertices = on(shape.rest, rest);
  return on_unit_plate(model, Level::of(0, rest), poisson)->value(bent) / plate_energy(shape);
}

}  // namespace

TEST_CASE("midedge_bending has the plate's energy of exact shapes, on every triangulation") {
  table(
      "Bending energy of exact shapes over the plate's: hinge and quadratic_bending (of flat rest shapes) "
      "at a = 1/40, midedge_bending as a falls, and its limit",
      "triangles", "hinge", "quadratic", "1/10", "1/20", "1/40", "limit");
  for (const Shape& shape : exact_shapes)
    for (const std::string& triangulation : all_triangulations) {
      const auto ratio = [&](const char* model, double a) {
        return ratio_to_plate(model, shape, triangulation, a);
      };
      const double coarse = ratio("midedge_bending", 0.1), middle = ratio("midedge_bending", 0.05),
                   fine = ratio("midedge_bending", 0.025), limit = 2 * fine - middle;
      row(triangulation, ratio("hinge", 0.025),
          shape.rest == in_plane ? ratio("quadratic_bending", 0.025) : std::nan(""), coarse, middle, fine,
          limit, shape.name);
      // The bands along the border, which no moment bends, are in proportion to a.
      CHECK((middle - 1) / (fine - 1) == Approx(2).epsilon(0.1));
      CHECK(limit == Approx(1).epsilon(0.002));
    }
}

TEST_CASE("A crease costs as much as a bend over a cell's width, and more on finer meshes") {
  const double angle = M_PI / 3;
  table("Energy E a / D theta² L of a crease of 60 degrees along a square's middle, by edges a", "triangles",
        "a", "hinge", "quadratic", "midedge");
  for (const std::string& triangulation : all_triangulations)
    for (const int cells : {10, 20, 40}) {
      const double a = 1. / cells;
      TriangleMesh rest = triangulated(triangulation, {1, 1}, a);
      double width = a;                      // of the row of triangles on either side
      if (triangulation == "equilateral") {  // with a row of edges in the middle
        const int strips = 2 * static_cast<int>(std::lround(cells / std::sqrt(3.0)));
        rest = equilateral({1, 1}, cells + 1, strips + 1);
        width = 1. / strips;
      }
      const auto creased = [&](const Vector2d& p) {
        const double v = p.y() - 0.5;
        return Vector3d(p.x(), v * std::cos(angle / 2), std::abs(v) * std::sin(angle / 2));
      };
      const auto energy = [&](const char* model) {
        return on_unit_plate(model, Level::of(0, rest), poisson)->value(on(creased, rest)) * a /
               (angle * angle);
      };
      const double hinge = energy("hinge"), quadratic = energy("quadratic_bending"),
                   midedge = energy("midedge_bending");
      row(triangulation, a, hinge, quadratic, midedge);
      if (triangulation == "random") {  // the crease runs through triangles
        CHECK(midedge == Approx(0.34).epsilon(0.1));
        continue;
      }
      CHECK(midedge == Approx(0.5 * a / width).epsilon(0.2 * a));  // less at its ends
      if (width == a) {
        CHECK(hinge == Approx(1.5).epsilon(1e-9));
        CHECK(quadratic == Approx(1.5 * std::pow(2 * std::sin(angle / 2) / angle, 2)).epsilon(1e-9));
      }
    }
}

namespace {

/// In units of k = E_bend d³ / 24 (1 − ν²), half of the plate's D.
double hinge_energy(const TriangleMesh& rest, const Positions& x) {
  return 2 * on_unit_plate("hinge", Level::of(0, rest), poisson)->value(x);
}

struct HingePattern {
  const char* name;
  Diagonals diagonals;
  bool is_equilateral;  ///< sheared to a parallelogram of equilateral triangles
  /// Factors of k κ² that follow from the pattern's hinges for a cylinder whose axis is along y, one that
  /// bends along (1, 1), one that bends along (1, -1), for a sphere and for a saddle.
  double expected[5];
};

const HingePattern hinge_patterns[] = {{"one_way", Diagonals::one_way, false, {3, 9, 3, 6, 6}},
                                       {"criss_cross", Diagonals::criss_cross, false, {3, 4.5, 4.5, 6, 6}},
                                       {"equilateral", Diagonals::one_way, true, {3, 3, 3, 4, 8}}};

/// f(n) = A n² + B n + C, an energy of n × n cells: A.
template <class Function>
double per_cell(const Function& f) {
  const int n = 4;
  return (f(3 * n) - 2 * f(2 * n) + f(n)) / (2 * n * n);
}

/// Energy density over k κ² of the pattern where its vertices lie on z = ½ κ (A₁ x² + 2 A₂ x y + A₃ y²).
double bending_energy_density(const HingePattern& pattern, const Vector3d& shape) {
  const double a = 0.1, curvature = 1e-4;
  const double height = pattern.is_equilateral ? std::sqrt(0.75) : 1;  // of a cell over a
  const auto energy = [&](int n) {
    TriangleMesh rest = grid({n * a, n * a}, n + 1, n + 1, pattern.diagonals);
    if (pattern.is_equilateral) {
      rest.vertices.col(0) -= rest.vertices.col(1) / 2;
      rest.vertices.col(1) *= height;
    }
    const auto curved = [&](const Vector2d& p) {
      return Vector3d(p.x(), p.y(),
                      curvature / 2 * shape.dot(Vector3d(p.x() * p.x(), 2 * p.prod(), p.y() * p.y())));
    };
    return hinge_energy(rest, on(curved, rest));
  };
  return per_cell(energy) / (height * a * a * curvature * curvature);
}

/// D_eff / k of a lattice of criss-cross cells a × r a bent along x, with every other vertex raised by the q
/// of least energy.
double relaxed_stiffness(double r) {
  const double a = 0.1, curvature = 1e-4, step = curvature * a * a / 10;
  const auto energy = [&](double q) {
    return per_cell([&](int n) {
      const TriangleMesh rest = grid({n * a, n * r * a}, n + 1, n + 1, Diagonals::criss_cross);
      Positions x = rest.vertices;
      for (Eigen::Index i = 0; i < x.rows(); ++i)
        x(i, 2) = curvature / 2 * x(i, 0) * x(i, 0) + ((i % (n + 1) + i / (n + 1)) % 2 == 0 ? q : 0);
      return hinge_energy(rest, x);
    });
  };
  const double minus = energy(-step), zero = energy(0), plus = energy(step), bend = plus - 2 * zero + minus;
  REQUIRE(bend > 0);
  const double least = zero - (plus - minus) * (plus - minus) / (8 * bend);
  return 2 * least / (r * a * a * curvature * curvature);
}

/// D_eff / k of a strip under a small load at its end.
double strip_stiffness(double r) {
  BeamStrip strip(20);
  strip.stiffness = 100;  // were it 6 k
  strip.slenderness = r;
  const double alpha = 0.01, load = alpha * strip.stiffness * strip.width();
  const Solved s =
      converged(solve_yaml(strip.yaml("hinge, " + strip.end_load({0, 0, -load}), newton_to(1e-4))));
  // The deflection of a chain of hinges of stiffness 6 k is less than that of the beam by its lumping.
  const double chain = alpha / 3 * (1 - 0.25 / std::pow(strip.cells - 0.5, 2));
  return 6 * chain / -end_of(s).z();
}

}  // namespace

TEST_CASE("What the hinge model charges for a curvature depends on the triangulation") {
  const char* const shapes[] = {"along x", "along (1,1)", "along (1,-1)", "sphere", "saddle"};
  const double h = 0.5;
  const Vector3d operators[] = {{1, 0, 0}, {h, h, h}, {h, -h, h}, {1, 0, 1}, {1, 0, -1}};
  table("Bending energy density over k kappa², vertices on the surface", "triangles", "shape", "density");
  for (const HingePattern& pattern : hinge_patterns)
    for (int i = 0; i < 5; ++i) {
      const double density = bending_energy_density(pattern, operators[i]);
      row(pattern.name, shapes[i], density);
      CHECK(density == Approx(pattern.expected[i]).epsilon(1e-5));
    }
}

TEST_CASE("Wide cells make cloth softer: their diagonals bend along") {
  table("Stiffness D_eff / k along x of a criss-cross of cells a × r a, free to move every other vertex by q",
        "r", "lattice", "by formula", "strip, 2 × 20");
  double last = 7;
  for (const double r : {0.06, 0.25, 0.5, 1.0, 2.0}) {
    const double lattice = relaxed_stiffness(r), strip = strip_stiffness(r);
    // 3 k [r² (κ a + 2 q/a)² + (2 q)² (1/r² + (1 + r²)²/r²)/a²] a cell, at its least by q.
    const double formula = 6 * (1 - std::pow(r, 4) / (2 * (1 + r * r + std::pow(r, 4))));
    row(r, lattice, formula, strip);
    CHECK(lattice == Approx(formula).epsilon(1e-5));
    CHECK(strip == Approx(formula).epsilon(0.05));  // its sides are free
    CHECK(strip < last);
    if (r == 0.06) CHECK(strip == Approx(6).epsilon(1e-4));
    last = strip;
  }
}
