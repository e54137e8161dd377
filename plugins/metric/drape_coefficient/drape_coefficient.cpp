#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {
namespace {

using std::numbers::pi;

constexpr int directions = 3600;
/// A fold stands out by this part of the specimen's radius at least.
constexpr double least_fold = 0.01;

/// The outline's turning points, highest and lowest by turns, that differ by `least` from the next.
struct Folds {
  double highest = 0, lowest = 0;  ///< sums
  int count = 0;

  Folds(const std::vector<double>& radii, double least) {
    const auto n = static_cast<int>(radii.size());
    const auto start = static_cast<int>(std::max_element(radii.begin(), radii.end()) -
                                        radii.begin());  // of the highest fold
    double high = radii[start], low = high;
    bool falling = true;
    for (int i = 1; i <= n; ++i) {
      const double r = radii[(start + i) % n];
      if (falling) {
        low = std::min(low, r);
        if (r - low < least) continue;
        highest += high, lowest += low, ++count;  // the fold before this valley, and the valley
        high = r, falling = false;
      } else {
        high = std::max(high, r);
        if (high - r < least) continue;
        low = r, falling = true;
      }
    }
  }
};

/// Distance of the shadow's outline from the cloth's centre, in `directions` evenly spaced directions from x
/// on [m].
std::vector<double> outline(const Level& level, const Positions& x) {
  std::vector<double> radii(directions, 0);
  const Eigen::Vector2d centre = (x.leftCols<2>().transpose() * level.vertex_area) / level.vertex_area.sum();
  for (Eigen::Index e = 0; e < level.topology.edges.rows(); ++e) {
    const auto at = [&](int end) -> Eigen::Vector2d {
      return x.row(level.topology.edges(e, end)).head<2>().transpose() - centre;
    };
    Eigen::Vector2d a = at(0), b = at(1);
    const auto cross = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
      return p.x() * q.y() - p.y() * q.x();
    };
    if (cross(a, b) < 0) std::swap(a, b);
    // The directions from a, counter-clockwise, to b.
    const double turn = std::atan2(cross(a, b), a.dot(b)), spacing = 2 * pi / directions,
                 begin = std::atan2(a.y(), a.x());
    const int first = static_cast<int>(std::ceil(begin / spacing)),
              last = static_cast<int>(std::floor((begin + turn) / spacing));
    for (int i = first; i <= last; ++i) {
      const Eigen::Vector2d m(std::cos(i * spacing), std::sin(i * spacing));
      const double across = cross(m, b - a);
      const double r = across == 0 ? std::max(a.norm(), b.norm()) : cross(a, b - a) / across;
      double& own = radii[(i % directions + directions) % directions];
      own = std::max(own, std::min(r, std::max(a.norm(), b.norm())));
    }
  }
  return radii;
}

}  // namespace

/// Cusick's drape test, seen along z: drape_coefficient [%], folds [1] and fold_amplitude [m].
class DrapeCoefficient : public Metric {
 public:
  double support_radius = 0.09;

  static void declare(Declaration<DrapeCoefficient>& d) {
    d.add("support_radius", &DrapeCoefficient::support_radius,
          "radius of the disc that carries the specimen; 0.09 m in BS 5058 and ISO 9073-9")
        .unit("m")
        .above(0)
        .at_most(1e3)
        .required();
  }

  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "drape_coefficient",
                         .unit = "%",
                         .better = Better::neither,
                         .shown = Shown::summary},
                        {.name = "folds", .unit = "1", .better = Better::neither, .shown = Shown::summary},
                        {.name = "fold_amplitude", .unit = "m", .better = Better::neither}},
            .text =
                "The drape coefficient is the part of the overhanging ring that the cloth's shadow covers "
                "(BS 5058, ISO 9073-9): 100 % does not drape. Fold amplitude is half the mean difference of "
                "folds "
                "and valleys in the shadow's outline."};
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    const std::vector<double> radii = outline(input.level, input.x);
    double shadow = 0;
    for (std::size_t i = 0; i < radii.size(); ++i)
      shadow += radii[i] * radii[(i + 1) % radii.size()] * std::sin(2 * pi / directions) / 2;
    const double specimen = input.level.vertex_area.sum(), support = pi * support_radius * support_radius;
    if (specimen <= support)
      throw std::runtime_error(
          "drape_coefficient: the cloth is not larger than its support; choose a smaller "
          "\"support_radius\"");
    const Folds folds(radii, least_fold * std::sqrt(specimen / pi));
    return {{{"drape_coefficient", 100 * (shadow - support) / (specimen - support)},
             {"folds", static_cast<double>(folds.count)},
             {"fold_amplitude", folds.count == 0 ? 0 : (folds.highest - folds.lowest) / folds.count / 2}},
            {}};
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::DrapeCoefficient>(
      "drape_coefficient", "Cusick's drape coefficient, with the number and amplitude of folds.");
}
