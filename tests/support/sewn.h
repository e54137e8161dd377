#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "tests/support/evaluate.h"
#include "tests/support/registry.h"

// Cloth of flat pieces, and its energies beside those of a surface in space.

/// The largest relative difference of an energy, or of its forces, between two levels at a crumpled state.
inline double energy_difference(const std::string& energy, const drape::Level& one, const drape::Level& other,
                                const drape::Material& material = {}) {
  const auto plugin = make_plugin_from<drape::Energy>(energy);
  const auto a = plugin->bind(one, material), b = plugin->bind(other, material);
  drape::Positions x = one.rest.vertices;
  const double size = 0.1 * std::sqrt(one.vertex_area.sum() / one.triangle_count());
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += size * std::sin(static_cast<double>(37 * i + 1));
  const drape::Positions g = gradient_of(*a, x), h = gradient_of(*b, x);
  REQUIRE(a->value(x) > 0);
  return std::max(std::abs(b->value(x) / a->value(x) - 1), (g - h).norm() / g.norm());
}

inline const std::vector<std::string> sewn_membranes = {
    "stvk", "neo_hookean",
    "{type: formula, per: triangle, constants: {k: {value: 40, unit: N/m}}, density: \"k*(s1-1)^2\"}"};
inline const std::vector<std::string> bending = {
    "hinge", "midedge_bending",
    "{type: formula, per: hinge, constants: {k: {value: 1e-5, unit: "
    "J}}, energy: \"k*length/(h1+h2)*bend^2\"}"};

/// Turns, mirrors, moves and scales the texture coordinates of the marked triangles.
inline void place_piece(drape::TriangleMesh& mesh, const std::vector<char>& marked, double degrees,
                        bool mirrored, const Eigen::Vector2d& by) {
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  const Eigen::Matrix2d turn =
      Eigen::Matrix2d{{c, -s}, {s, c}} * Eigen::Vector2d(mirrored ? -1 : 1, 1).asDiagonal();
  for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
    for (int k = 0; k < 3 && marked[t]; ++k) {
      const Eigen::Vector2d at = mesh.uv.block<1, 2>(t, 2 * k).transpose();
      mesh.uv.block<1, 2>(t, 2 * k) = (turn * at + by).transpose();
    }
}

/// A flat mesh in z = 0 as one flat piece where it lies.
inline drape::TriangleMesh as_piece(drape::TriangleMesh mesh) {
  mesh.uv.resize(mesh.triangles.rows(), 6);
  for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      mesh.uv.block<1, 2>(t, 2 * k) = mesh.vertices.row(mesh.triangles(t, k)).head<2>();
  mesh.sewing = drape::Sewing{};
  return mesh;
}

inline std::vector<char> left_half(const drape::TriangleMesh& mesh) {
  std::vector<char> left(mesh.triangles.rows());
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    left[t] = mesh.vertices(mesh.triangles.row(t), 0).sum() < 0;
  return left;
}
