#include <algorithm>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/element_energy.h"
#include "core/numerics/model/stretch_limit.h"
#include "plugins/energy/strain_limit/strain_limit_law.h"
#include "plugins/energy/strain_limit/stretch_path.h"

namespace drape {
namespace {

using Kernel = StretchKernel<StrainLimitLaw>;
constexpr double min_margin_fraction = 0.1;  // of the margin to the limit, left after a filtered step

/// The limited triangles of a level.
struct Limited {
  std::vector<int> triangles;  ///< by rising index
  Stencils corners;            ///< of each
  std::vector<Kernel::Rest> rest;
  std::shared_ptr<const Positions> rest_positions;
};

class BoundStrainLimit final : public ElementEnergy<Kernel>, public StretchLimited {
 public:
  /// `order` orders limited.corners.
  BoundStrainLimit(double limit, Limited limited, ElementOrder order)
      : ElementEnergy(limited.corners, limited.rest, std::move(order)),
        limit_(limit),
        limited_(std::move(limited)) {}

  const StretchLimited* stretch_limit() const override { return this; }
  StepLimit max_step(const Positions& x0, const Positions& x1) const override {
    std::vector<double> fractions(count(), 1);
    parallel_for(count(), 256, [&](int begin, int end) {
      for (int first = begin; first < end; first += W) {
        const PackMask<W> inside = stay_inside(first, x0, x1);
        for (int i = first; i < std::min(first + W, end); ++i)
          if (!inside[i - first]) fractions[i] = reach(path(i, x0, x1));
      }
    });
    const auto shortest = std::ranges::min_element(fractions);
    if (shortest == fractions.end() || *shortest >= 1) return {};
    const auto i = static_cast<int>(shortest - fractions.begin());
    const double stretch = path(i, x0, x1).at(*shortest).largest;
    return {*shortest, to_string({limited_.triangles[i], stretch}, limit_)};
  }

  double limit() const override { return limit_; }

  std::vector<StretchedTriangle> violations(const Positions& x) const override {
    std::vector<StretchedTriangle> found;
    for (int i = 0; i < count(); ++i) {
      const double stretch = path(i, x, x).at(0).largest;
      if (!(stretch < limit_)) found.push_back({limited_.triangles[i], stretch});
    }
    return found;
  }

  std::unique_ptr<BoundEnergy> restricted(const std::vector<char>& excluded) const override {
    Limited left{{}, {}, {}, limited_.rest_positions};
    std::vector<int> kept;
    for (int i = 0; i < count(); ++i) {
      if (excluded[limited_.triangles[i]]) continue;
      kept.push_back(i);
      left.triangles.push_back(limited_.triangles[i]);
      left.rest.push_back(limited_.rest[i]);
    }
    left.corners = limited_.corners(kept, Eigen::all);
    ElementOrder order = ElementOrder::of(left.corners, *left.rest_positions);
    return std::make_unique<BoundStrainLimit>(limit_, std::move(left), std::move(order));
  }

 private:
  static constexpr int W = native_pack_width;

  int count() const { return static_cast<int>(limited_.triangles.size()); }

  /// Marks those of W triangles from `first` on whose reach is certainly 1: σ₁, convex along the step, is
  /// inside the bound at both ends. Lanes beyond the last triangle repeat it.
  __attribute__((flatten)) PackMask<W> stay_inside(int first, const Positions& x0,
                                                   const Positions& x1) const {
    using T = Pack<W>;
    constexpr double margin = 1e-9;  // far above round-off
    int start[3][W];
    T rest[3];
    for (int lane = 0; lane < W; ++lane) {
      const int i = std::min(first + lane, count() - 1);
      for (int k = 0; k < 3; ++k) {
        start[k][lane] = 3 * limited_.corners(i, k);
        rest[k].v[lane] = limited_.rest[i][k];
      }
    }
    const auto largest_stretch = [&](const Positions& x) {
      Eigen::Matrix<T, 3, 1> corner[3];
      for (int k = 0; k < 3; ++k) gather_rows(x.data(), start[k], corner[k][0], corner[k][1], corner[k][2]);
      const Eigen::Matrix<T, 3, 1> e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
      return PrincipalStretch<T>(rest[0] * e1, rest[1] * e1 + rest[2] * e2).largest;
    };
    const T stretch = largest_stretch(x0);
    const T bound = limit_ - min_margin_fraction * (limit_ - max(stretch, T(1.0))) - margin;
    return (stretch < bound) & (largest_stretch(x1) < bound);
  }

  StretchPath path(int i, const Positions& x0, const Positions& x1) const {
    const auto v = limited_.corners.row(i);
    const Kernel::Rest& rest = limited_.rest[i];
    const auto columns = [&](const Positions& x, Eigen::Vector3d& f1, Eigen::Vector3d& f2) {
      const Eigen::Vector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
      f1 = rest[0] * e1;
      f2 = rest[1] * e1 + rest[2] * e2;
    };
    StretchPath path;
    columns(x0, path.f1, path.f2);
    columns(x1, path.d1, path.d2);
    path.d1 -= path.f1;
    path.d2 -= path.f2;
    return path;
  }

  /// Largest step fraction that leaves a triangle part of its margin. Without stretch the margin is s - 1.
  double reach(const StretchPath& path) const {
    const double stretch = path.at(0).largest;
    if (!(stretch < limit_)) return 0;
    const double bound = limit_ - min_margin_fraction * (limit_ - std::max(stretch, 1.0));
    return stretch < bound ? path.reach(bound) : 0;
  }

  double limit_;
  Limited limited_;
};

}  // namespace

/// Strain limit of C-IPC (docs/theory/method.md, section 5): a barrier on principal stretches above 1, +∞ at
/// the limit. Its bound energy has a max_step and a stretch_limit.
class StrainLimit final : public Energy {
 public:
  double limit = 1.1;
  double stiffness = 1e3;

  static void declare(Declaration<StrainLimit>& d) {
    d.add("limit", &StrainLimit::limit, "largest principal stretch s of every triangle, never reached")
        .between(1.0001, 100)
        .source("our default; cotton 1.0608 and wool-lycra 1.134: Li et al. 2021");
    d.add("stiffness", &StrainLimit::stiffness, "κ_s, stiffness of the barrier: energy per volume")
        .unit("Pa")
        .between(1e-9, bounds::largest_modulus)
        .source("Li et al. 2021, section 5");
  }

  EnergyRole role() const override { return EnergyRole::limit; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    Limited all{{}, level.rest.triangles, {}, std::make_shared<Positions>(level.rest.vertices)};
    for (int t = 0; t < level.triangle_count(); ++t) {
      const RestTriangle triangle = RestTriangle::of(level, t);
      Kernel::Rest rest;
      rest << triangle.a, triangle.b, triangle.c, stiffness * material.thickness * triangle.area,
          1 / (limit - 1);
      all.triangles.push_back(t);
      all.rest.push_back(rest);
    }
    return std::make_unique<BoundStrainLimit>(limit, std::move(all), level.triangle_order);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::StrainLimit>(
      "strain_limit", "Barrier that keeps every triangle's principal stretches below a limit.");
}
