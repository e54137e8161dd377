// Bending energies of shapes that a flat or curved rest shape takes without stretching, by every bending
// model on every triangulation, beside the energy of a Kirchhoff–Love plate.

#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/files/number_text.h"
#include "core/kernel/interfaces/energy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/strip.h"

using namespace drape;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double poisson = 0.3;

/// A surface and another one of the same metric, over a rectangle from (0, 0) to `size`.
struct Shape {
  std::string name;
  Vector2d size;
  Vector3d (*rest)(const Vector2d& p);
  Vector3d (*bent)(const Vector2d& p);
  /// Plate energy per area of the rectangle: ½ ((1 − ν) tr S² + ν (tr S)²) of the change S of the shape
  /// operator, times the area that the surface has there.
  double (*density)(const Vector2d& p);
  bool is_flat;  ///< at rest
};

double plate_density(double first, double second) {
  return (first * first + second * second + 2 * poisson * first * second) / 2;
}

Vector3d in_plane(const Vector2d& p) { return {p.x(), p.y(), 0}; }

/// Seen in a mirror: the same lengths, and the shape operator times −1.
Vector3d mirrored(const Vector3d& x) { return {x.x(), x.y(), -x.z()}; }

Vector3d half_cylinder(const Vector2d& p) { return {std::sin(p.x()), p.y(), std::cos(p.x())}; }

// The tangents of a helix with curvature 1 and torsion 1 unrolled: those of the unit circle. A point of the
// plane at the distance v from where its tangent touches has the curvature τ / κ v.
constexpr double from_circle = 1.2;
Vector2d outside_circle(const Vector2d& p) { return {p.x() - 1, p.y() + from_circle}; }
double along_tangent(const Vector2d& p) { return std::sqrt(outside_circle(p).squaredNorm() - 1); }
Vector3d tangents_of_helix(const Vector2d& p) {
  const Vector2d q = outside_circle(p);
  const double v = along_tangent(p), s = std::atan2(q.y(), q.x()) - std::atan(v);
  // Radius and rise per angle ½, so that both curvature and torsion are r / (r² + h²) = 1; arc length s.
  const double angle = s * std::sqrt(2.0), r = 0.5;
  const Vector3d place(r * std::cos(angle), r * std::sin(angle), r * angle);
  return place + v * Vector3d(-std::sin(angle), std::cos(angle), 1) / std::sqrt(2.0);
}

constexpr double cap = 0.5;
Vector3d sphere(const Vector2d& p) {
  const Vector2d q = p - Vector2d(cap, cap);
  const double angle = q.norm();
  return {std::sin(angle) * q.normalized().x(), std::sin(angle) * q.normalized().y(), std::cos(angle)};
}

constexpr double torus_radius = 1, tube_radius = 0.4;
double from_axis(const Vector2d& p) { return torus_radius + tube_radius * std::cos(p.y() / tube_radius); }
Vector3d half_torus(const Vector2d& p) {
  const double r = from_axis(p);
  return {r * std::cos(p.x() / torus_radius), r * std::sin(p.x() / torus_radius),
          tube_radius * std::sin(p.y() / tube_radius)};
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

const Shape exact_shapes[] = {
    {"half cylinder",
     {M_PI, 1},
     in_plane,
     half_cylinder,
     [](const Vector2d&) { return plate_density(1, 0); },
     true},
    {"tangents of a helix",
     {2, 1},
     in_plane,
     tangents_of_helix,
     [](const Vector2d& p) { return plate_density(1 / along_tangent(p), 0); },
     true},
    {"sphere, inside out",
     {2 * cap, 2 * cap},
     sphere,
     [](const Vector2d& p) { return mirrored(sphere(p)); },
     [](const Vector2d& p) {
       const double angle = (p - Vector2d(cap, cap)).norm();
       return plate_density(2, 2) * std::sin(angle) / angle;
     },
     false},
    {"half torus, inside out",
     {M_PI * torus_radius, M_PI* tube_radius},
     half_torus,
     [](const Vector2d& p) { return mirrored(half_torus(p)); },
     [](const Vector2d& p) {
       return plate_density(2 / tube_radius, 2 * std::cos(p.y() / tube_radius) / from_axis(p)) *
              from_axis(p) / torus_radius;
     },
     false},
    {"helicoid to catenoid",
     {2, 2 * half_width},
     helicoid,
     catenoid,
     [](const Vector2d& p) {
       const double metric = std::pow(std::cosh(p.y() - half_width), 2), change = std::sqrt(2.0) / metric;
       return plate_density(change, -change) * metric;
     },
     false}};

template <class Surface>
Positions on(const Surface& surface, const TriangleMesh& pattern) {
  Positions x = pattern.vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    x.row(i) = surface(Vector2d(pattern.vertices.row(i).head<2>().transpose())).transpose();
  return x;
}

double energy_of(const std::string& model, const TriangleMesh& rest, const Positions& x) {
  return make_plugin_from<Energy>(model)->bind(Level::of(0, rest), unit_plate(poisson))->value(x);
}

double plate_energy(const Shape& shape) {
  const int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      sum += shape.density({(i + 0.5) / n * shape.size.x(), (j + 0.5) / n * shape.size.y()});
  return sum * shape.size.prod() / (n * n);
}

/// The model's energy over the plate's.
double ratio_to_plate(const std::string& model, const Shape& shape, const std::string& triangulation,
                      double a) {
  TriangleMesh rest = triangulated(triangulation, shape.size, a);
  const Positions bent = on(shape.bent, rest);
  rest.vertices = on(shape.rest, rest);
  return energy_of(model, rest, bent) / plate_energy(shape);
}

}  // namespace

TEST_CASE("midedge_bending has the plate's energy of exact shapes, on every triangulation", "[physics]") {
  row("\nBending energy of exact shapes over the plate's: hinge and quadratic_bending at a = 1/40, "
      "midedge_bending as a falls, and its limit");
  row("%24s %12s %8s %10s %8s %8s %8s %8s", "shape", "triangles", "hinge", "quadratic", "1/10", "1/20",
      "1/40", "limit");
  for (const Shape& shape : exact_shapes)
    for (const std::string& triangulation : all_triangulations) {
      double midedge[3], a = 0.1;
      for (double& r : midedge) r = ratio_to_plate("midedge_bending", shape, triangulation, a), a /= 2;
      const double hinge = ratio_to_plate("hinge", shape, triangulation, 0.025),
                   limit = 2 * midedge[2] - midedge[1];
      const std::string quadratic =
          shape.is_flat ? fixed_text(ratio_to_plate("quadratic_bending", shape, triangulation, 0.025), 4)
                        : "-";
      row("%24s %12s %8.4f %10s %8.4f %8.4f %8.4f %8.4f", shape.name.c_str(), triangulation.c_str(), hinge,
          quadratic.c_str(), midedge[0], midedge[1], midedge[2], limit);
      INFO(shape.name << ", " << triangulation);
      // The bands along the border, which no moment bends, are in proportion to a.
      CHECK((midedge[1] - 1) / (midedge[2] - 1) == Approx(2).epsilon(0.1));
      CHECK(limit == Approx(1).epsilon(0.002));
    }
}

TEST_CASE("A crease costs as much as a bend over a cell's width, and more on finer meshes", "[physics]") {
  const double angle = M_PI / 3;
  row("\nEnergy E a / D theta² L of a crease of 60 degrees along a square's middle, by edges a");
  row("%12s %8s %8s %10s %8s", "triangles", "a", "hinge", "quadratic", "midedge");
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
      const Positions bent = on(
          [&](const Vector2d& p) {
            const double v = p.y() - 0.5;
            return Vector3d(p.x(), v * std::cos(angle / 2), std::abs(v) * std::sin(angle / 2));
          },
          rest);
      double e[3];
      const char* const models[] = {"hinge", "quadratic_bending", "midedge_bending"};
      for (int m = 0; m < 3; ++m) e[m] = energy_of(models[m], rest, bent) * a / (angle * angle);
      row("%12s %8g %8.4f %10.4f %8.4f", triangulation.c_str(), a, e[0], e[1], e[2]);
      INFO(triangulation << ", a = " << a);
      if (triangulation == "random") {  // the crease runs through triangles
        CHECK(e[2] == Approx(0.34).epsilon(0.1));
        continue;
      }
      CHECK(e[2] == Approx(0.5 * a / width).epsilon(0.2 * a));  // less at its ends
      if (width == a) {
        CHECK(e[0] == Approx(1.5).epsilon(1e-9));
        CHECK(e[1] == Approx(1.5 * std::pow(2 * std::sin(angle / 2) / angle, 2)).epsilon(1e-9));
      }
    }
}
