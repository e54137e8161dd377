#include "core/numerics/mesh/texture_coordinates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/numerics/mesh/area_vectors.h"

namespace drape {

namespace {

constexpr double flatness = 1e-3;  // of the diagonal
constexpr double steep = 0.7;      // a plane whose unit normal has a smaller |z| stands upright

/// The unit normal of a flat mesh, towards the side that most of its area faces. Triangles may face either
/// way, as those of a flat bag do.
Eigen::Vector3d plane_normal(const TriangleMesh& mesh) {
  const Positions areas = area_vectors(mesh);
  Eigen::Index largest = 0;
  areas.rowwise().squaredNorm().maxCoeff(&largest);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), sum = Eigen::Vector3d::Zero();
  for (Eigen::Index t = 0; t < areas.rows(); ++t) {
    const Eigen::Vector3d area = areas.row(t);
    normal += areas.row(t).dot(areas.row(largest)) < 0 ? Eigen::Vector3d(-area) : area;
    sum += area;
  }
  return (sum.dot(normal) < 0 ? Eigen::Vector3d(-normal) : normal).normalized();
}

}  // namespace

CornerUv split_uv(const CornerUv& coarse) {
  CornerUv uv(4 * coarse.rows(), 6);
  for (Eigen::Index t = 0; t < coarse.rows(); ++t) {
    const auto at = [&](int k) -> Eigen::RowVector2d { return coarse.block<1, 2>(t, 2 * (k % 3)); };
    const auto middle = [&](int k) -> Eigen::RowVector2d { return 0.5 * (at(k + 1) + at(k + 2)); };
    uv.row(4 * t + 0) << at(0), middle(2), middle(1);
    uv.row(4 * t + 1) << middle(2), at(1), middle(0);
    uv.row(4 * t + 2) << middle(1), middle(0), at(2);
    uv.row(4 * t + 3) << middle(0), middle(1), middle(2);
  }
  return uv;
}

UvVertices split_at_seams(const TriangleMesh& mesh) {
  const auto n = static_cast<int>(mesh.vertices.rows());
  UvVertices split{std::vector<int>(n), {}, mesh.triangles};
  std::iota(split.vertex.begin(), split.vertex.end(), 0);
  if (mesh.uv.rows() == 0) return split;
  std::vector<Eigen::RowVector2d> uv(n, Eigen::RowVector2d::Zero());
  std::vector<int> next(n, -2);  // the next split vertex at the same vertex; -1 for none, -2 before the first
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector2d own = mesh.uv.block<1, 2>(t, 2 * k);
      int i = mesh.triangles(t, k);
      if (next[i] == -2) {
        uv[i] = own;
        next[i] = -1;
      }
      while (uv[i] != own && next[i] >= 0) i = next[i];
      if (uv[i] != own) {
        next[i] = static_cast<int>(uv.size());
        i = next[i];
        split.vertex.push_back(mesh.triangles(t, k));
        uv.push_back(own);
        next.push_back(-1);
      }
      split.triangles(t, k) = i;
    }
  split.uv.resize(static_cast<Eigen::Index>(uv.size()), 2);
  for (std::size_t i = 0; i < uv.size(); ++i) split.uv.row(static_cast<Eigen::Index>(i)) = uv[i];
  return split;
}

UvVertices laid_out(TriangleMesh cloth) {
  std::vector<Eigen::AlignedBox2d> boxes(cloth.piece_names.size());
  cloth.uv *= cloth.sewing->uv_length;
  for (Eigen::Index t = 0; t < cloth.uv.rows(); ++t)
    for (int k = 0; k < 3; ++k) boxes[cloth.piece[t]].extend(cloth.uv.block<1, 2>(t, 2 * k).transpose());
  double area = 0, widest = 0;
  for (const Eigen::AlignedBox2d& box : boxes)
    area += box.sizes().prod(), widest = std::max(widest, box.sizes()[0]);
  const double width = std::max(widest, 1.2 * std::sqrt(area)), apart = 0.04 * width;
  std::vector<Eigen::RowVector2d> shifts;
  Eigen::RowVector2d corner(0, 0);  // upper left one of the next piece
  double height = 0;                // of this row
  for (const Eigen::AlignedBox2d& box : boxes) {
    if (corner[0] > 0 && corner[0] + box.sizes()[0] > width)
      corner = {0, corner[1] - height - apart}, height = 0;
    shifts.push_back(corner - Eigen::RowVector2d(box.min()[0], box.max()[1]));
    corner[0] += box.sizes()[0] + apart;
    height = std::max(height, box.sizes()[1]);
  }
  for (Eigen::Index t = 0; t < cloth.uv.rows(); ++t)
    for (int k = 0; k < 3; ++k) cloth.uv.block<1, 2>(t, 2 * k) += shifts[cloth.piece[t]];
  return split_at_seams(cloth);
}

std::optional<PlanarUv> PlanarUv::of(const TriangleMesh& mesh) {
  const Eigen::Vector3d normal = plane_normal(mesh);
  const Eigen::VectorXd heights = mesh.vertices * normal;
  if (!(heights.maxCoeff() - heights.minCoeff() <= 2 * flatness * bounding_box_diagonal(mesh.vertices)))
    return {};
  const Eigen::Vector3d up =
      std::abs(normal.z()) < steep ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d v = (up - up.dot(normal) * normal).normalized();
  PlanarUv planar;
  planar.axes.row(0) = v.cross(normal);
  planar.axes.row(1) = v;
  const UvVertices::Coordinates flat = mesh.vertices * planar.axes.transpose();
  const double longer = (flat.colwise().maxCoeff() - flat.colwise().minCoeff()).maxCoeff();
  planar.axes /= longer;
  planar.origin = flat.colwise().minCoeff().transpose() / longer;
  return planar;
}

CornerUv PlanarUv::at(const TriangleMesh& mesh) const {
  CornerUv uv(mesh.triangles.rows(), 6);
  for (Eigen::Index t = 0; t < uv.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      uv.block<1, 2>(t, 2 * k) =
          (axes * mesh.vertices.row(mesh.triangles(t, k)).transpose() - origin).transpose();
  return uv;
}

}  // namespace drape
