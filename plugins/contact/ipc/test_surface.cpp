// The barrier between vertices and a surface of triangles.

#include <catch2/catch.hpp>

#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/contact/surface_contacts.h"
#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/obstacle.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/near_surface.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::ipc;

namespace {

using Vector = Eigen::Vector3d;

constexpr double dhat = NearSurface::dhat;

struct Scene : NearSurface {
  using NearSurface::NearSurface;
  Vector gradient(const Vector& p) const { return gradient_of(*set(p), p.transpose()).transpose(); }
  Eigen::Matrix3d hessian(const Vector& p, Projection projection) const {
    return dense(hessian_of(*set(p), p.transpose(), projection));
  }
  double distance(const Vector& p) const {
    double smallest = 1e300;
    const Positions& v = obstacles.vertices;
    for (const auto& t : obstacles.topology->triangles.rowwise()) {
      PairPositions x;
      x << p, v.row(t[0]).transpose(), v.row(t[1]).transpose(), v.row(t[2]).transpose();
      smallest = std::min(smallest, connection(x, closest(PairKind::point_triangle, x)).norm());
    }
    return smallest;
  }
};

/// A sheet of 5 cm with hills and valleys of this height and wave length, its vertices moved in its plane.
TriangleMesh hills(int columns, double height, double wave, RandomNumbers& random) {
  TriangleMesh mesh = grid({0.05, 0.05}, columns, columns, Diagonals::criss_cross);
  const double cell = 0.05 / (columns - 1), a = random(0, 6), b = random(0, 6);
  for (auto v : mesh.vertices.rowwise()) {
    for (int c = 0; c < 2; ++c)
      if (v[c] > 1e-9 && v[c] < 0.05 - 1e-9) v[c] += random(-0.2, 0.2) * cell;
    if (height > 0)
      v[2] = height * (std::sin(2 * M_PI * v[0] / wave + a) * std::sin(2 * M_PI * v[1] / wave + b) +
                       random(-0.1, 0.1));
  }
  return mesh;
}

/// Over the middle of a mesh, or below it.
Vector near_middle(const Scene& scene, RandomNumbers& random) {
  const auto vertices = scene.obstacles.vertices;
  const Eigen::Index v = static_cast<Eigen::Index>(random(0, 1) * static_cast<double>(vertices.rows() - 1));
  return Vector(0.5 * vertices.row(v)) + Vector(0.0125, 0.0125, 0) +
         Vector(random(-1, 1), random(-1, 1), random(-1.5, 1.5)) * dhat;
}

int count_negative(const std::vector<NearestFeature>& features) {
  return static_cast<int>(
      std::ranges::count_if(features, [](const NearestFeature& f) { return f.coefficient < 0; }));
}

}  // namespace

TEST_CASE("surface: a flat sheet acts as its plane, for any triangulation") {
  RandomNumbers random;
  std::vector<TriangleMesh> sheets = {grid({0.05, 0.05}, 2, 2, Diagonals::one_way),
                                      random_triangulation({0.05, 0.05}, 300, 1)};
  for (const int columns : {3, 11, 41}) sheets.push_back(hills(columns, 0, 1, random));
  for (const TriangleMesh& flat : sheets) {
    const Scene scene(flat);
    int off_border = 0;
    for (int i = 0; i < 400; ++i) {
      Vector p(random(-0.01, 0.06), random(-0.01, 0.06), random(-1, 1) * dhat);
      if (i % 4 == 0) p.head<2>() = flat.vertices.row(i % flat.vertices.rows()).head<2>();  // above a vertex
      const Vector foot(std::clamp(p.x(), 0.0, 0.05), std::clamp(p.y(), 0.0, 0.05), 0);
      const double distance = (p - foot).norm();
      const Derivatives b = barrier(distance / dhat);
      CAPTURE(p.transpose(), flat.vertices.rows());
      CHECK(scene.value(p) == Approx(b.value).epsilon(1e-10).margin(1e-14));
      const Vector g = b.first / dhat * (p - foot) / distance;
      CHECK((scene.gradient(p) - g).norm() <= 1e-9 * (1 + g.norm()));
      if (i % 4 != 0) CHECK(scene.features(p).size() == (distance < dhat ? 1 : 0));
      off_border += foot == p - Vector(0, 0, p.z());
    }
    CHECK(off_border > 100);
  }
}

TEST_CASE("surface: energy and force are continuous where the nearest features change") {
  RandomNumbers random;
  int changes = 0, negative = 0;
  for (int round = 0; round < 12; ++round) {
    const Scene scene(hills(12, round % 3 == 0 ? 3e-4 : 2e-3, 0.02, random));
    const Vector from = near_middle(scene, random), to = near_middle(scene, random);
    constexpr int steps = 4000;
    const Vector step = (to - from) / steps;
    const double h = step.norm();
    std::vector<std::array<int, 3>> before;
    double energy = 0;
    Vector force;
    for (int k = 0; k <= steps; ++k) {
      const Vector p = from + k * step;
      const std::vector<NearestFeature> near = scene.features(p);
      negative += count_negative(near);
      std::vector<std::array<int, 3>> features;
      double slope = 0, curvature = 20 / dhat / dhat;  // bounds of the first and second derivative
      for (const NearestFeature& f : near) {
        features.push_back(f.vertices);
        const double nearer = std::max(f.distance - h, 1e-3 * f.distance);
        const Derivatives b = barrier(nearer / dhat);
        slope += std::abs(f.coefficient * b.first) / dhat;
        curvature += 2 * std::abs(f.coefficient) * (b.second / dhat - b.first / nearer) / dhat;
      }
      const double value = scene.value(p);
      const Vector gradient = scene.gradient(p);
      if (k > 0 && !near.empty() && scene.distance(p) > 0.1 * dhat) {
        changes += features != before;
        CAPTURE(round, k, p.transpose(), features.size(), before.size());
        CHECK((gradient - force).norm() <= curvature * h + 1e-3 * slope * h / dhat);
        CHECK(std::abs(value - energy - 0.5 * step.dot(gradient + force)) <=
              (curvature + 20 / dhat / dhat) * h * h);
      }
      before = features;
      energy = value;
      force = gradient;
    }
  }
  CHECK(changes > 300);
  CHECK(negative > 300);
}

TEST_CASE("surface: derivatives and projections") {
  RandomNumbers random;
  int negative = 0, indefinite = 0;
  for (int round = 0; round < 10; ++round) {
    const Scene scene(hills(12, 2e-3, 0.02, random));
    const auto value = [&](const Vector& x) { return scene.value(x); };
    const auto gradient = [&](const Vector& x) { return scene.gradient(x); };
    for (int i = 0; i < 200; ++i) {
      const Vector p = near_middle(scene, random);
      if (scene.distance(p) > 0.95 * dhat || scene.distance(p) < 0.02 * dhat) continue;
      const Vector g = scene.gradient(p);
      const Eigen::Matrix3d h = scene.hessian(p, Projection::none);
      const double size = 1e-5 * dhat;
      const std::size_t count = scene.features(p + 3 * size * Vector::UnitX()).size();
      bool steady = true;  // differences are of no use where the number of features changes
      for (int c = 0; c < 6; ++c)
        steady &= scene.features(p + (c % 2 ? 3 : -3) * size * Vector::Unit(c / 2)).size() == count;
      CAPTURE(p.transpose(), scene.features(p).size());
      CHECK((differences(value, p, size).transpose() - g).norm() <= 1e-5 * (g.norm() + 1 / dhat));
      if (steady) CHECK((differences(gradient, p, size) - h).norm() <= 1e-4 * h.norm());
      negative += count_negative(scene.features(p));
      const Eigenpairs eigen = eigenpairs_of(h);
      indefinite += eigen.values[0] < -1e-9 * h.norm();
      for (const auto projection : {Projection::clamp, Projection::absolute})
        CHECK((scene.hessian(p, projection) - recomposed(eigen, projection)).norm() <= 1e-12 * h.norm());
    }
  }
  CHECK(negative > 100);
  CHECK(indefinite > 100);
}

TEST_CASE("surface: the nearest feature's coefficient is at least 1, and friction uses the net force") {
  RandomNumbers random;
  int negative = 0;
  // From hills that are wide against d̂ to pits that are a tenth of it.
  for (const auto& [columns, height, wave] :
       {std::tuple(41, 2e-4, 0.03), std::tuple(21, 6e-4, 0.03), std::tuple(12, 2e-3, 0.02),
        std::tuple(41, 2e-3, 0.03), std::tuple(41, 5e-4, 0.005), std::tuple(81, 1e-3, 0.002),
        std::tuple(81, 2e-4, 0.002), std::tuple(81, 3e-5, 0.002)}) {
    const Scene scene(hills(columns, height, wave, random));
    double least = 1e300;
    for (int i = 0; i < 300; ++i) {
      const Vector p = near_middle(scene, random);
      const double distance = scene.distance(p);
      if (distance >= dhat || distance < 1e-6 * dhat) continue;
      const std::vector<NearestFeature> features = scene.features(p);
      CAPTURE(columns, height, wave, p.transpose(), distance);
      REQUIRE(!features.empty());
      const auto nearest = std::ranges::min(features, {}, &NearestFeature::distance);
      CHECK(nearest.distance == Approx(distance).epsilon(1e-9));
      CHECK(nearest.coefficient >= 1 - 1e-9);
      least = std::min(least, scene.value(p) / barrier(distance / dhat).value);
      double sum = 0, net = 0;
      for (const double pressure : scene.contact(p).pressures(dhat)) {
        CHECK(pressure >= 0);
        sum += pressure;
      }
      CHECK(sum > 0);
      for (const NearestFeature& f : features) net -= f.coefficient * barrier(f.distance / dhat).first;
      if (distance > 1e-3 * dhat) CHECK(sum == Approx(std::max(net, 0.0)).epsilon(1e-9).margin(1e-12));
      negative += count_negative(features);
    }
    CAPTURE(columns, height, wave, least);
    CHECK(least > 0.99);
  }
  CHECK(negative > 50);
}
