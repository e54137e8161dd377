#include "core/app/run/garment_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/app/view/surface_fields.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/mesh/area_vectors.h"

namespace drape {

namespace {

constexpr double pascals_in_mmhg = 133.322;
constexpr double pascals_in_kpa = 1000;
/// The share of a piece's area below the values `…_95`: single triangles at corners of seams stand above it.
constexpr double share = 0.95;

/// Values with the area of each. Those that are not finite, as the ease of a vertex far from the body, do not
/// count.
class AreaSamples {
 public:
  void add(double value, double area) {
    if (std::isfinite(value)) samples_.emplace_back(value, area);
  }
  Json mean() const {
    double sum = 0, area = 0;
    for (const auto& [value, own] : samples_) sum += own * value, area += own;
    return area > 0 ? Json(sum / area) : Json();
  }
  /// Adds the largest value, and the one that bounds `share` of the area, over a unit.
  void add_bounds(Json& entry, const std::string& name, double unit = 1) {
    if (samples_.empty()) return;
    std::ranges::sort(samples_);
    double area = 0, below = 0;
    for (const auto& [value, own] : samples_) area += own;
    const auto bound = std::ranges::find_if(
        samples_, [&](const auto& sample) { return (below += sample.second) >= share * area; });
    entry[name + "_95"] = (bound == samples_.end() ? samples_.back() : *bound).first / unit;
    entry["largest_" + name] = samples_.back().first / unit;
  }

 private:
  std::vector<std::pair<double, double>> samples_;
};

struct PieceSamples {
  AreaSamples warp, weft, ease, pressure;
};

Json entry_of(const std::string& name, PieceSamples& piece, bool has_pressure) {
  Json entry = {{"piece", name}};
  for (auto [field, samples] :
       {std::pair("stretch_warp", &piece.warp), std::pair("stretch_weft", &piece.weft)}) {
    entry[field] = samples->mean();
    samples->add_bounds(entry, field);
  }
  entry["ease"] = piece.ease.mean();
  if (!has_pressure) return entry;
  const double mean = piece.pressure.mean().get<double>();
  entry["pressure"] = mean / pascals_in_kpa;
  entry["pressure_mmhg"] = mean / pascals_in_mmhg;
  piece.pressure.add_bounds(entry, "pressure", pascals_in_kpa);
  return entry;
}

}  // namespace

Json garment_pieces(const Level& level, const Positions& x, const Eigen::VectorXd& ease,
                    const Eigen::VectorXd& pressure) {
  const TriangleMesh& cloth = level.rest;
  const std::vector<MaterialTriangle> rest = material_triangles(level);
  const Eigen::MatrixX2d stretch = stretch_percent(level, x);
  const Eigen::VectorXd area = 0.5 * area_vectors({x, cloth.triangles}).rowwise().norm();
  std::vector<PieceSamples> pieces(cloth.piece_names.size());
  for (int t = 0; t < level.triangle_count(); ++t) {
    PieceSamples& piece = pieces[cloth.piece[t]];
    piece.warp.add(stretch(t, 0), rest[t][4]);
    piece.weft.add(stretch(t, 1), rest[t][4]);
    for (const int v : cloth.triangles.row(t)) {
      piece.ease.add(ease[v], rest[t][4] / 3);
      if (pressure.size() > 0) piece.pressure.add(pressure[v], area[t] / 3);
    }
  }
  Json entries = Json::array();
  for (std::size_t p = 0; p < pieces.size(); ++p)
    entries.push_back(entry_of(cloth.piece_names[p], pieces[p], pressure.size() > 0));
  return entries;
}

}  // namespace drape
