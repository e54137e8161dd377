#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "tests/support/meshes.h"

// Rest shapes whose layers lie on each other, and starts in which the layers are apart. Lengths in metres.

/// A mesh at rest and where it starts.
struct LayeredShape {
  drape::TriangleMesh rest;
  drape::Positions start;
};

/// One straight part of a folded strip: its length, and its direction in the x-z plane as an angle from the
/// x axis at rest and at the start [rad].
struct Leaf {
  double length, rest, start;
};

/// A strip along y of this width that is folded between its leaves, in cells of about `spacing`.
inline LayeredShape folded(const std::vector<Leaf>& leaves, double width, double spacing) {
  std::vector<Eigen::Vector2d> rest{{0, 0}}, start{{0, 0}};
  const auto along = [](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  for (const Leaf& leaf : leaves) {
    const int cells = std::max(1, static_cast<int>(std::lround(leaf.length / spacing)));
    for (int k = 0; k < cells; ++k) {
      rest.push_back(rest.back() + leaf.length / cells * along(leaf.rest));
      start.push_back(start.back() + leaf.length / cells * along(leaf.start));
    }
  }
  const int columns = static_cast<int>(rest.size()),
            rows = static_cast<int>(std::lround(width / spacing)) + 1;
  std::vector<Eigen::Vector3d> at_rest, at_start;
  std::vector<Eigen::Vector3i> triangles;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int v = i + columns * j;
      const double y = width * j / (rows - 1);
      at_rest.emplace_back(rest[i].x(), y, rest[i].y());
      at_start.emplace_back(start[i].x(), y, start[i].y());
      if (i + 1 == columns || j + 1 == rows) continue;
      triangles.emplace_back(v, v + 1, v + 1 + columns);
      triangles.emplace_back(v, v + 1 + columns, v + columns);
    }
  return {mesh_of(at_rest, triangles), mesh_of(at_start, {}).vertices};
}

/// Layers of the cells of one square grid in the x-y plane, sewn to each other at common vertices.
class Sewing {
 public:
  struct Layer {
    int columns, rows;                             ///< of cells
    std::function<bool(int i, int j)> has_cell;    ///< whether a cell is part of the layer
    std::function<bool(int i, int j)> is_joined;   ///< whether a vertex is the first layer's
    std::function<double(double x, double y)> up;  ///< height at the start
    bool faces_up = true;                          ///< layers that are joined face opposite ways
    double up_at_rest = 0;
  };

  explicit Sewing(double spacing) : spacing_(spacing) {}

  void add(const Layer& layer) {
    std::map<std::pair<int, int>, int> own;
    const bool is_first = first_.empty();
    const auto vertex = [&](int i, int j) {
      if (!is_first && layer.is_joined(i, j)) return first_.at({i, j});
      const auto [entry, is_new] = own.try_emplace({i, j}, static_cast<int>(rest_.size()));
      if (is_new) {
        rest_.emplace_back(i * spacing_, j * spacing_, layer.up_at_rest);
        start_.emplace_back(i * spacing_, j * spacing_, layer.up(i * spacing_, j * spacing_));
      }
      return entry->second;
    };
    const auto add_triangle = [&](int a, int b, int c) {
      layer.faces_up ? triangles_.emplace_back(a, b, c) : triangles_.emplace_back(a, c, b);
    };
    for (int j = 0; j < layer.rows; ++j)
      for (int i = 0; i < layer.columns; ++i) {
        if (!layer.has_cell(i, j)) continue;
        const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
        // A triangle whose vertices are all joined would be in both layers.
        const bool sewn_rising = layer.is_joined(i, j) && layer.is_joined(i + 1, j + 1) &&
                                 (layer.is_joined(i + 1, j) || layer.is_joined(i, j + 1));
        if (!sewn_rising) {
          add_triangle(a, b, c);
          add_triangle(a, c, d);
        } else {
          add_triangle(a, b, d);
          add_triangle(b, c, d);
        }
      }
    if (is_first) first_ = own;
  }

  LayeredShape shape() const { return {mesh_of(rest_, triangles_), mesh_of(start_, {}).vertices}; }

 private:
  double spacing_;
  std::vector<Eigen::Vector3d> rest_, start_;
  std::vector<Eigen::Vector3i> triangles_;
  std::map<std::pair<int, int>, int> first_;  // the first layer's vertices
};
