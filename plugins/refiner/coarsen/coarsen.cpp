#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/mesh/grain.h"
#include "plugins/refiner/coarsen/choose_vertices.h"
#include "plugins/refiner/coarsen/curved_cloth.h"
#include "plugins/refiner/coarsen/former_pieces.h"
#include "plugins/refiner/coarsen/interpolation.h"

namespace drape {

/// Coarser levels under a given mesh (after Zhang et al., Progressive Shell
/// Quasistatics for Unstructured Meshes, 2023); finer ones by midpoint subdivision.
class CoarsenRefiner : public Refiner {
 public:
  double ratio = 4;

  static void declare(Declaration<CoarsenRefiner>& d) {
    d.add("ratio", &CoarsenRefiner::ratio, "vertices of a level over those of the next coarser one, about")
        .between(2, 16);
  }

  ProlongationMatrix weights(const Level& coarse) const override { return midpoint_weights(coarse); }

  std::optional<CoarserMesh> coarser(const Level& fine) const override {
    const std::optional<FlatCloth> flat = FlatCloth::of(fine);
    CoarserMesh made = flat ? of_pieces(fine, *flat) : of_surface(fine);
    if (std::ssize(made.vertices) == fine.vertex_count())
      throw std::runtime_error(
          "level " + std::to_string(fine.index) + " of " + std::to_string(fine.vertex_count()) +
          " vertices has no vertex that its corners, outlines and seams do not need; ask for "
          "fewer coarser levels");
    return made;
  }

 private:
  CoarserMesh of_pieces(const Level& fine, const FlatCloth& flat) const {
    std::optional<CoarsePieces> former;
    if (ratio == 4) former = former_pieces(fine, flat);
    const CoarsePieces pieces =
        former ? std::move(*former) : CoarsePieces::of(flat, chosen_vertices(fine, flat, ratio));
    CoarserMesh made;
    std::vector<int> number(fine.vertex_count(), -1);
    for (int v = 0; v < fine.vertex_count(); ++v)
      if (pieces.kept[v]) number[v] = static_cast<int>(made.vertices.size()), made.vertices.push_back(v);
    made.rest = coarse_rest(fine, flat, pieces, made.vertices, number);
    made.weights = flat_interpolation(flat, pieces, number, static_cast<int>(made.vertices.size()));
    return made;
  }

  CoarserMesh of_surface(const Level& fine) const {
    CoarseSurface coarse = CoarseSurface::of(fine, ratio);
    CoarserMesh made{{fine.rest.vertices(coarse.vertices, Eigen::all), coarse.triangles},
                     std::move(coarse.vertices),
                     coarse.weights};
    std::vector<int> number(fine.vertex_count(), -1), same;
    for (int i = 0; i < std::ssize(made.vertices); ++i) number[made.vertices[i]] = i;
    for (int& corner : made.rest.triangles.reshaped()) corner = number[corner];
    const bool has_uv = fine.rest.uv.rows() > 0;
    if (has_uv) made.rest.uv.resize(coarse.triangles.rows(), 6);
    for (Eigen::Index t = 0; t < coarse.triangles.rows(); ++t) {
      const Eigen::Vector3d own = centroid(fine, coarse.triangles.row(t));
      const auto distance = [&](int f) { return (centroid(fine, fine.rest.triangles.row(f)) - own).norm(); };
      std::array<int, 3> near;  // at each corner
      for (int k = 0; k < 3; ++k) {
        near[k] = *std::ranges::min_element(fine.topology.vertex_triangles.row(coarse.triangles(t, k)), {},
                                            distance);
        const auto f = fine.rest.triangles.row(near[k]);
        const auto corner = std::ranges::find(f, coarse.triangles(t, k)) - f.begin();
        if (has_uv) made.rest.uv.block<1, 2>(t, 2 * k) = fine.rest.uv.block<1, 2>(near[k], 2 * corner);
      }
      same.push_back(*std::ranges::min_element(near, {}, distance));
    }
    take_directions(fine, same, made.rest);
    return made;
  }

  static Eigen::Vector3d centroid(const Level& level, const Eigen::RowVector3i& vertices) {
    return level.rest.vertices(vertices, Eigen::all).colwise().mean().transpose();
  }

  /// Gives the coarse triangles piece and warp of fine ones.
  static void take_directions(const Level& fine, const std::vector<int>& same, TriangleMesh& rest) {
    rest.piece_names = fine.rest.piece_names;
    if (!fine.rest.piece.empty())
      for (const int t : same) rest.piece.push_back(fine.rest.piece[t]);
    if (fine.rest.warp.rows() > 0) {
      rest.warp = fine.rest.warp(same, Eigen::all);
      if (!rest.sewing) rest.warp = projected_warp(rest.warp, rest);
    }
  }

  static TriangleMesh coarse_rest(const Level& fine, const FlatCloth& flat, const CoarsePieces& pieces,
                                  const std::vector<int>& vertices, const std::vector<int>& number) {
    TriangleMesh rest{fine.rest.vertices(vertices, Eigen::all), pieces.triangles};
    for (int& corner : rest.triangles.reshaped()) corner = number[flat.images[corner].vertex];
    rest.sewing = fine.rest.sewing;
    if (fine.rest.uv.rows() > 0) {
      rest.uv.resize(pieces.triangles.rows(), 6);
      for (Eigen::Index t = 0; t < rest.uv.rows(); ++t)
        for (int k = 0; k < 3; ++k)
          rest.uv.block<1, 2>(t, 2 * k) = flat.images[pieces.triangles(t, k)].uv.transpose();
    }
    std::vector<int> same;
    for (const auto& t : pieces.triangles.rowwise()) same.push_back(fine_triangle_near(fine, flat, t));
    take_directions(fine, same, rest);
    return rest;
  }

  /// The fine triangle nearest to a coarse triangle's centroid, among those at its corners in its piece.
  static int fine_triangle_near(const Level& fine, const FlatCloth& flat, const Eigen::RowVector3i& images) {
    const auto centroid = [&](const auto& t) -> Eigen::Vector2d {
      return (flat.images[t[0]].place + flat.images[t[1]].place + flat.images[t[2]].place) / 3;
    };
    const Eigen::Vector2d own = centroid(images);
    int nearest = -1;
    double smallest = std::numeric_limits<double>::infinity();
    for (const int i : images)
      for (const int t : fine.topology.vertex_triangles.row(flat.images[i].vertex)) {
        const double distance = (centroid(flat.triangles.row(t)) - own).norm();
        if (flat.piece[t] == flat.images[i].piece && distance < smallest) smallest = distance, nearest = t;
      }
    return nearest;
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, drape::CoarsenRefiner>(
      "coarsen", "Coarser levels under a given mesh, whose vertices they share; finer ones by midpoints.");
}
