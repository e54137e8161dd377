#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/kernel/files/message_text.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh/texture_coordinates.h"
#include "core/numerics/patterns/delaunay.h"

namespace drape {
namespace {

using Eigen::Vector2d;

/// The connected parts of a mesh in the order of their first triangles, each with vertices of its own.
std::vector<TriangleMesh> parts_of(const TriangleMesh& mesh) {
  const std::vector<int> part_of = connected_parts(mesh);
  std::vector<int> number(mesh.vertices.rows(), -1);
  std::vector<std::vector<int>> triangles(*std::ranges::max_element(part_of) + 1);
  for (int t = 0; t < mesh.triangles.rows(); ++t) triangles[part_of[t]].push_back(t);
  std::vector<TriangleMesh> parts;
  for (const std::vector<int>& own : triangles) {
    TriangleMesh& part = parts.emplace_back(TriangleMesh{{}, mesh.triangles(own, Eigen::all)});
    std::vector<int> kept;
    for (int& v : part.triangles.reshaped()) {
      if (number[v] < 0) number[v] = static_cast<int>(kept.size()), kept.push_back(v);
      v = number[v];
    }
    part.vertices = mesh.vertices(kept, Eigen::all);
    if (mesh.uv.rows() > 0) part.uv = mesh.uv(own, Eigen::all);
    if (mesh.warp.rows() > 0) part.warp = mesh.warp(own, Eigen::all);
  }
  return parts;
}

/// A border's corners without those between which it hardly turns in less than an edge: a curve that was
/// sampled finely is divided again.
Polygon thinned(const Polygon& border, double edge_length) {
  constexpr double corner = 0.866;  // cosine of 30°, from which on a corner stays
  constexpr double shortest = 0.8;  // of an edge
  const auto is_corner = [&](std::size_t i) {
    const std::size_t n = border.size();
    const Vector2d in = border[i] - border[(i + n - 1) % n], out = border[(i + 1) % n] - border[i];
    return in.dot(out) < corner * in.norm() * out.norm();
  };
  Polygon kept;
  std::vector<char> stays;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const bool sharp = is_corner(i);
    const bool near = !kept.empty() && (border[i] - kept.back()).norm() < shortest * edge_length;
    if (near && !sharp) continue;
    if (near && !stays.back()) kept.pop_back(), stays.pop_back();
    kept.push_back(border[i]), stays.push_back(sharp);
  }
  if (kept.size() > 3 && !stays.back() && (kept.back() - kept[0]).norm() < shortest * edge_length)
    kept.pop_back();
  if (kept.size() >= 3) return kept;
  constexpr std::size_t fewest = 6;  // of a hole that is smaller than an edge
  if (border.size() <= fewest) return border;
  kept.clear();
  for (std::size_t k = 0; k < fewest; ++k) kept.push_back(border[k * border.size() / fewest]);
  return kept;
}

/// A flat piece of cloth in its own plane.
struct FlatPart {
  Eigen::Matrix<double, 2, 3> axes;
  Eigen::RowVector3d offset;   ///< of the plane from the origin [m]
  std::vector<Polygon> loops;  ///< the outline, then the holes

  /// Nothing for a part that is not flat, has no border, or faces both ways.
  static std::optional<FlatPart> of(const TriangleMesh& mesh) {
    const std::optional<PlanarUv> plane = PlanarUv::of(mesh);
    if (!plane) return {};
    FlatPart part;
    part.axes = plane->axes.rowwise().normalized();
    const Eigen::RowVector3d normal = part.axes.row(0).cross(part.axes.row(1));
    part.offset = (mesh.vertices * normal.transpose()).mean() * normal;
    if ((area_vectors(mesh) * normal.transpose()).minCoeff() <= 0) return {};
    std::vector<int> next(mesh.vertices.rows(), -1);
    for (const int h : border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows()))) {
      const HalfEdge e = HalfEdge::of(mesh.triangles, h);
      next[e.from] = e.to;
    }
    double largest = 0;
    for (int v = 0; v < std::ssize(next); ++v) {
      Polygon loop;
      for (int at = v; next[at] >= 0; at = std::exchange(next[at], -1))
        loop.push_back(part.axes * mesh.vertices.row(at).transpose());
      if (loop.empty()) continue;
      const double area = area_of(loop);
      part.loops.push_back(std::move(loop));
      if (area > largest) largest = area, std::swap(part.loops[0], part.loops.back());
    }
    return part.loops.empty() ? std::nullopt : std::optional(std::move(part));
  }
};

/// Gives a new mesh the texture coordinates and the warp of the old one, if the former are an affine function
/// of the place and the latter is the same everywhere; nothing otherwise.
void keep_pattern(const TriangleMesh& old, const FlatPart& part, TriangleMesh& mesh) {
  constexpr double rounding = 1e-6;  // of what a file has with a few digits
  const auto places = [&](const TriangleMesh& m) {
    Eigen::Matrix<double, Eigen::Dynamic, 3> rows(3 * m.triangles.rows(), 3);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      rows.row(i) << (m.vertices.row(m.triangles(i / 3, i % 3)) * part.axes.transpose()), 1;
    return rows;
  };
  using CornerRows = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
  if (old.uv.rows() > 0) {
    const Eigen::Map<const CornerRows> uv(old.uv.data(), 3 * old.uv.rows(), 2);
    const auto all = places(old);
    const Eigen::Matrix<double, 3, 2> affine = all.colPivHouseholderQr().solve(uv);
    if ((all * affine - uv).cwiseAbs().maxCoeff() <= rounding * std::max(1.0, uv.cwiseAbs().maxCoeff())) {
      mesh.uv.resize(mesh.triangles.rows(), 6);
      Eigen::Map<CornerRows>(mesh.uv.data(), 3 * mesh.uv.rows(), 2) = places(mesh) * affine;
    }
  }
  if (old.warp.rows() > 0 && (old.warp.rowwise() - old.warp.row(0)).cwiseAbs().maxCoeff() <= rounding)
    mesh.warp = old.warp.row(0).replicate(mesh.triangles.rows(), 1);
}

/// The rows of all meshes' matrices, one below the other; none unless every mesh has as many as triangles.
template <class Rows>
Rows stacked(const std::vector<TriangleMesh>& meshes, Rows TriangleMesh::*rows, bool of_triangles) {
  Eigen::Index count = 0;
  for (const TriangleMesh& mesh : meshes) {
    if (of_triangles && (mesh.*rows).rows() < mesh.triangles.rows()) return {};
    count += (mesh.*rows).rows();
  }
  Rows all(count, Rows::ColsAtCompileTime);
  for (Eigen::Index k = std::ssize(meshes) - 1; k >= 0; --k) {
    const Rows& own = meshes[k].*rows;
    count -= own.rows();
    all.middleRows(count, own.rows()) = own;
  }
  return all;
}

}  // namespace

OutlineSize OutlineSize::of(const TriangleMesh& mesh) {
  OutlineSize size{area_vectors(mesh).rowwise().norm().sum() / 2};
  for (const int h : border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows()))) {
    const HalfEdge e = HalfEdge::of(mesh.triangles, h);
    size.border += (mesh.vertices.row(e.to) - mesh.vertices.row(e.from)).norm();
  }
  return size;
}

double OutlineSize::vertices(double edge_length) const {
  return (border + 4 / std::numbers::sqrt3 * area / edge_length) / (2 * edge_length);
}

TriangleMesh mesh_outline(const TriangleMesh& flat, double edge_length, unsigned seed) {
  std::vector<TriangleMesh> meshes;
  int first_vertex = 0;
  for (const TriangleMesh& old : parts_of(flat)) {
    const std::optional<FlatPart> part = FlatPart::of(old);
    if (!part)
      throw std::runtime_error("part " + std::to_string(meshes.size()) +
                               " of the mesh is not flat with one side up; \"vertices\" and \"edge_length\" "
                               "mesh flat pieces within their outlines: leave them out, and mesh the cloth "
                               "where it comes from");
    std::vector<Polygon> loops;
    for (const Polygon& loop : part->loops) loops.push_back(thinned(loop, edge_length));
    const long about = std::lround(OutlineSize::of(old).vertices(edge_length));
    const std::string name = "part " + std::to_string(meshes.size()) + " of the mesh, with edges of " +
                             three_digits(edge_length) + " m";
    TriangleMesh& mesh = meshes.emplace_back(with_name(name, [&] {
      return delaunay_polygon(loops, static_cast<int>(std::max(3L, about)), seed,
                              VertexCount::at_least_about);
    }));
    mesh.vertices = ((mesh.vertices.leftCols<2>() * part->axes).rowwise() + part->offset).eval();
    keep_pattern(old, *part, mesh);
    mesh.triangles.array() += first_vertex;
    first_vertex += static_cast<int>(mesh.vertices.rows());
  }
  return {stacked(meshes, &TriangleMesh::vertices, false), stacked(meshes, &TriangleMesh::triangles, false),
          stacked(meshes, &TriangleMesh::uv, true), stacked(meshes, &TriangleMesh::warp, true)};
}

}  // namespace drape
