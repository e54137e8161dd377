#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/linear_energy.h"
#include "core/numerics/elements/project_hessian.h"

namespace drape {

/// Sum of one kernel over all vertices of a level. A Kernel has, with T = Pack<native_pack_width>, of
/// position x and the numbers rest[0 … 4]: rest position u, v, w [m], area [m²] and mass [kg],
///
///     T value(const T* x, const T* rest) const;
///     T gradient(const T* x, const T* rest, T* g) const;                            // returns the value
///     void hessian(const T* x, const T* rest, Eigen::Matrix<T, 3, 3>& h) const;     // upper triangle
///
/// Energies that are NaN or -∞ count as +∞.
template <class Kernel>
class VertexEnergy final : public BoundEnergy {
 public:
  VertexEnergy(const Level& level, const Material& material, Kernel kernel)
      : kernel_(std::move(kernel)), rest_(level.vertex_count(), 5) {
    rest_ << level.rest.vertices, level.vertex_area, material.area_density() * level.vertex_area;
  }

  double value(const Positions& x) const override {
    return sum(x, [&](int, int, const T* position, const T* rest) { return kernel_.value(position, rest); });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    return sum(x, [&](int first, int count, const T* position, const T* rest) {
      T own[3];
      const T energy = kernel_.gradient(position, rest, own);
      for (int lane = 0; lane < count; ++lane)
        for (int c = 0; c < 3; ++c) g(first + lane, c) += own[c][lane];
      return energy;
    });
  }

  Stencils stencils() const override {
    return Eigen::VectorXi::LinSpaced(rest_.rows(), 0, static_cast<int>(rest_.rows()) - 1);
  }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    for_each_pack(x, [&](int first, int count, const T* position, const T* rest) {
      Eigen::Matrix<T, 3, 3> h;
      kernel_.hessian(position, rest, h);
      project_part(h, projection);
      for (int lane = 0; lane < count; ++lane) {
        double block[9];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) block[3 * i + j] = h(std::min(i, j), std::max(i, j))[lane];
        sink.add(first + lane, 0, 0, block);
      }
    });
  }

 private:
  static constexpr int width = native_pack_width, packs_per_task = 64;
  using T = Pack<width>;

  /// Calls body(first vertex, how many, x, rest) for every pack of vertices.
  template <class Body>
  void for_each_pack(const Positions& x, const Body& body) const {
    const auto n = static_cast<int>(x.rows());
    parallel_for((n + width - 1) / width, packs_per_task, [&](int begin, int end) {
      for (int pack = begin; pack < end; ++pack) {
        const int first = pack * width, count = std::min(width, n - first);
        T position[3], rest[5];
        for (int lane = 0; lane < width; ++lane) {
          const int vertex = first + std::min(lane, count - 1);
          for (int c = 0; c < 3; ++c) position[c].v[lane] = x(vertex, c);
          for (int c = 0; c < 5; ++c) rest[c].v[lane] = rest_(vertex, c);
        }
        body(first, count, position, rest);
      }
    });
  }

  /// Sum of the energies, in the order of the packs.
  template <class Body>
  double sum(const Positions& x, const Body& body) const {
    std::vector<double> energies(static_cast<std::size_t>(x.rows() / width + 1), 0);
    for_each_pack(x, [&](int first, int count, const T* position, const T* rest) {
      const T energy = body(first, count, position, rest);
      double& own = energies[static_cast<std::size_t>(first / width)];
      for (int lane = 0; lane < count; ++lane) own += energy[lane];
    });
    double total = 0;
    for (const double energy : energies) total += energy;
    const bool lowest = total == -std::numeric_limits<double>::infinity();
    return std::isnan(total) || lowest ? std::numeric_limits<double>::infinity() : total;
  }

  Kernel kernel_;
  Eigen::MatrixXd rest_;
};

/// An energy that is linear in positions, as constant forces; itself where it is not finite.
inline std::unique_ptr<BoundEnergy> as_linear(std::unique_ptr<BoundEnergy> energy, const Level& level) {
  Positions g = Positions::Zero(level.vertex_count(), 3);
  const double constant = energy->add_gradient(Positions::Zero(level.vertex_count(), 3), g);
  if (!g.allFinite() || !std::isfinite(constant)) return energy;
  return std::make_unique<LinearEnergy>(-g, constant);
}

}  // namespace drape
