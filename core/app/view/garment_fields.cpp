#include "core/app/view/garment_fields.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/kernel/files/string_utils.h"
#include "core/numerics/elements/green_strain.h"

namespace drape {

namespace {

constexpr double ease_range = 0.06;  // [m]
constexpr double pascals_in_mmhg = 133.322;

/// Weighted mean and largest of the finite values.
struct Mean {
  double sum = 0, weight = 0;
  std::optional<double> largest;

  void add(double value, double own) {
    if (!std::isfinite(value)) return;
    sum += own * value, weight += own;
    largest = std::max(largest.value_or(value), value);
  }
  Json mean() const { return weight > 0 ? Json(sum / weight) : Json(); }
  Json most() const { return largest ? Json(*largest) : Json(); }
};

}  // namespace

const std::vector<FieldKind>& garment_fields() {
  static const std::vector<FieldKind> kinds = {
      {"stretch_warp", "stretch along warp", "%", "diverging", "of the triangles around; 0 is unstretched"},
      {"stretch_weft", "stretch along weft", "%", "diverging", "of the triangles around; 0 is unstretched"},
      {"ease", "ease", "mm", "force", "distance to the body; beyond 60 mm in cloth colour"}};
  return kinds;
}

VertexFields garment_fields_at(const Level& level, const Positions& x,
                               const std::vector<TriangleMesh>& obstacles) {
  const std::vector<MaterialTriangle> rest = material_triangles(level);
  Eigen::VectorXd warp = Eigen::VectorXd::Zero(x.rows()), weft = warp, area = warp;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const Eigen::RowVector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
    const MaterialTriangle& m = rest[t];
    const double along = (m[0] * e1 + m[1] * e2).norm() - 1, across = (m[2] * e1 + m[3] * e2).norm() - 1;
    for (int k = 0; k < 3; ++k) warp[v[k]] += m[4] * along, weft[v[k]] += m[4] * across, area[v[k]] += m[4];
  }
  const auto percent = [&](const Eigen::VectorXd& sums) {
    return Eigen::VectorXd(100 * sums.cwiseQuotient(area));
  };
  return {{"stretch_warp", percent(warp)},
          {"stretch_weft", percent(weft)},
          {"ease", 1000 * obstacle_distance(x, obstacles, ease_range)}};
}

std::string garment_place(const Level& level, int vertex) {
  const TriangleMesh& cloth = level.rest;
  if (cloth.piece_names.empty()) return "";
  std::vector<std::string> pieces;
  for (const int t : level.topology.vertex_triangles.row(vertex))
    add_new(pieces, cloth.piece_names[cloth.piece[t]]);
  return pieces.size() == 1 ? "piece " + pieces[0] : "the seam of " + joined(pieces, ", ", " and ");
}

Json garment_pieces(const Level& level, const VertexFields& fields, const Eigen::VectorXd& pressure) {
  const TriangleMesh& cloth = level.rest;
  Json pieces = Json::array();
  for (std::size_t p = 0; p < cloth.piece_names.size(); ++p) {
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(level.vertex_count());
    for (int t = 0; t < level.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k)
        if (cloth.piece[t] == static_cast<int>(p)) weight[cloth.triangles(t, k)] += 1;
    const auto over_piece = [&](const Eigen::VectorXd& values) {
      Mean mean;
      for (Eigen::Index i = 0; i < values.size(); ++i)
        if (weight[i] > 0) mean.add(values[i], weight[i]);
      return mean;
    };
    Json& entry = pieces.emplace_back(Json{{"piece", cloth.piece_names[p]}});
    for (const VertexField& field : fields) {
      const Mean mean = over_piece(field.values);
      entry[field.name] = mean.mean();
      if (field.name != "ease") entry["largest_" + field.name] = mean.most();
    }
    if (pressure.size() == 0) continue;
    const Mean mean = over_piece(pressure);
    entry["pressure"] = mean.sum / mean.weight / 1000;
    entry["pressure_mmhg"] = mean.sum / mean.weight / pascals_in_mmhg;
    entry["largest_pressure"] = mean.largest.value_or(0) / 1000;
  }
  return pieces;
}

}  // namespace drape
