#include "plugins/refiner/coarsen/flat_cloth.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/mesh/texture_coordinates.h"

namespace drape {
namespace {

/// The places of each triangle's corners in the planes of their parts, m×6 [m]; nothing if one is not flat.
std::optional<CornerUv> places_of_parts(const TriangleMesh& mesh, const std::vector<int>& part, int count) {
  std::vector<std::vector<int>> triangles(count);
  for (int t = 0; t < std::ssize(part); ++t) triangles[part[t]].push_back(t);
  CornerUv places(mesh.triangles.rows(), 6);
  for (int p = 0; p < count; ++p) {
    TriangleMesh own{{}, mesh.triangles(triangles[p], Eigen::all)};
    own.vertices = mesh.vertices(own.triangles.reshaped<Eigen::RowMajor>(), Eigen::all);
    for (Eigen::Index k = 0; k < own.triangles.size(); ++k) own.triangles.data()[k] = static_cast<int>(k);
    const std::optional<PlanarUv> plane = PlanarUv::of(own);
    if (!plane) return std::nullopt;
    const Eigen::Matrix<double, 2, 3> axes = plane->axes.rowwise().normalized();
    for (std::size_t k = 0; k < triangles[p].size(); ++k)
      for (int c = 0; c < 3; ++c)
        places.block<1, 2>(triangles[p][k], 2 * c) =
            (axes * own.vertices.row(static_cast<Eigen::Index>(3 * k) + c).transpose()).transpose();
  }
  return places;
}

double signed_area(const FlatCloth& flat, int t) {
  const Eigen::Vector2d &a = flat.images[flat.triangles(t, 0)].place,
                        &b = flat.images[flat.triangles(t, 1)].place,
                        &c = flat.images[flat.triangles(t, 2)].place;
  return ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
}

/// Draws pieces that are mirrored with their fronts up.
void turn_fronts_up(FlatCloth& flat) {
  std::vector<double> area(flat.piece_count, 0);
  for (int t = 0; t < flat.triangles.rows(); ++t) area[flat.piece[t]] += signed_area(flat, t);
  for (FlatCloth::Image& image : flat.images)
    if (area[image.piece] < 0) image.place.x() *= -1;
  for (int t = 0; t < flat.triangles.rows(); ++t)
    if (!(signed_area(flat, t) > 0))
      throw std::runtime_error("triangle " + std::to_string(t) +
                               " is turned over in its flat piece, or has no area there; coarser levels need "
                               "pieces whose triangles all face one way");
}

}  // namespace

std::optional<FlatCloth> FlatCloth::of(const Level& level) {
  const TriangleMesh& mesh = level.rest;
  FlatCloth flat;
  flat.piece = mesh.sewing ? flat_pieces(mesh, level.topology) : connected_parts(mesh);
  flat.piece_count = 1 + *std::ranges::max_element(flat.piece);
  const std::optional<CornerUv> places = mesh.sewing ? CornerUv(mesh.sewing->uv_length * mesh.uv)
                                                     : places_of_parts(mesh, flat.piece, flat.piece_count);
  if (!places) return std::nullopt;
  std::vector<std::vector<int>> of_vertex(level.vertex_count());
  flat.triangles.resize(mesh.triangles.rows(), 3);
  for (int t = 0; t < level.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(t, k), piece = flat.piece[t];
      const Eigen::Vector2d place = places->block<1, 2>(t, 2 * k).transpose();
      auto& own = of_vertex[v];
      const auto same = std::ranges::find_if(own, [&](int i) {
        return flat.images[i].piece == piece && (!mesh.sewing || flat.images[i].place == place);
      });
      flat.triangles(t, k) = same != own.end() ? *same : static_cast<int>(flat.images.size());
      if (same != own.end()) continue;
      own.push_back(flat.triangles(t, k));
      const bool has_uv = mesh.uv.rows() > 0;
      flat.images.push_back(
          {v, piece, place, has_uv ? Eigen::Vector2d(mesh.uv.block<1, 2>(t, 2 * k)) : Eigen::Vector2d(0, 0)});
    }
  turn_fronts_up(flat);
  flat.of_vertex = AdjacencyList::of(level.vertex_count(), [&](const auto& add) {
    for (int i = 0; i < std::ssize(flat.images); ++i) add(flat.images[i].vertex, i);
  });
  flat.on_outline.assign(level.vertex_count(), 0);
  const Topology& topology = level.topology;
  for (int e = 0; e < topology.edges.rows(); ++e) {
    if (topology.edge_triangles(e, 1) != -1 && !is_seam(mesh, topology, e)) continue;
    for (const int v : topology.edges.row(e)) flat.on_outline[v] = 1;
    for (const int t : topology.edge_triangles.row(e)) {
      if (t < 0) continue;
      const int k = topology.corner_opposite(e, t);
      flat.outline.push_back({e, flat.triangles(t, (k + 1) % 3), flat.triangles(t, (k + 2) % 3)});
    }
  }
  flat.triangle_area = Eigen::VectorXd::Zero(level.vertex_count());
  for (int t = 0; t < level.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) flat.triangle_area[mesh.triangles(t, k)] += signed_area(flat, t);
  for (int v = 0; v < level.vertex_count(); ++v)
    flat.triangle_area[v] /= std::max(1, level.topology.vertex_triangles.size(v));
  return flat;
}

}  // namespace drape
