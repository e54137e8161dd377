#include "plugins/energy/formula/vertex.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/kernel/elements/linear_energy.h"
#include "core/kernel/elements/project_hessian.h"
#include "core/kernel/linear_algebra/parallel.h"
#include "plugins/energy/formula/compile.h"

namespace drape::formula {
namespace {

using T = Pack<native_pack_width>;
constexpr int width = native_pack_width;

/// Σ E(x_i) over the vertices.
class BoundVertexFormula final : public BoundEnergy {
 public:
  BoundVertexFormula(Programs programs, Eigen::MatrixXd rest)
      : programs_(std::move(programs)), rest_(std::move(rest)) {}

  double value(const Positions& x) const override {
    return sum(x, programs_.value, [](int, int, const T*) {});
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    const Program& p = programs_.gradient;
    return sum(x, p, [&](int first, int count, const T* registers) {
      for (int lane = 0; lane < count; ++lane)
        for (int c = 0; c < 3; ++c) g(first + lane, c) += registers[p.output(1 + c)][lane];
    });
  }

  Stencils stencils() const override {
    return Eigen::VectorXi::LinSpaced(rest_.rows(), 0, static_cast<int>(rest_.rows()) - 1);
  }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    const Program& p = programs_.hessian;
    for_each_pack(x, p, [&](int first, int count, const T* registers) {
      Eigen::Matrix<T, 3, 3> h;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i <= j; ++i) h(i, j) = registers[p.output(3 + Jet<3, T>::index(i, j))];
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
  static constexpr int packs_per_task = 64;

  /// Calls body(first vertex, how many, registers after the run) for every pack of vertices.
  template <class Body>
  void for_each_pack(const Positions& x, const Program& program, const Body& body) const {
    const auto n = static_cast<int>(x.rows());
    parallel_for((n + width - 1) / width, packs_per_task, [&](int begin, int end) {
      T registers[Program::slots];
      for (int pack = begin; pack < end; ++pack) {
        const int first = pack * width, count = std::min(width, n - first);
        for (int input = 0; input < 3 + rest_.cols(); ++input) {
          if (!program.reads(input)) continue;
          const int r = program.register_of(input);
          for (int lane = 0; lane < width; ++lane) {
            const int vertex = first + std::min(lane, count - 1);
            registers[r].v[lane] = input < 3 ? x(vertex, input) : rest_(vertex, input - 3);
          }
        }
        program.run<T, 1>(registers);
        body(first, count, registers);
      }
    });
  }

  /// Sum of the energies, in the order of the packs; +∞ where one is not a number or -∞.
  template <class Body>
  double sum(const Positions& x, const Program& program, const Body& body) const {
    std::vector<double> energies(static_cast<std::size_t>(x.rows() / width + 1), 0);
    for_each_pack(x, program, [&](int first, int count, const T* registers) {
      double& own = energies[static_cast<std::size_t>(first / width)];
      for (int lane = 0; lane < count; ++lane) own += registers[program.output(0)][lane];
      body(first, count, registers);
    });
    double total = 0;
    for (const double energy : energies) total += energy;
    const bool lowest = total == -std::numeric_limits<double>::infinity();
    return std::isnan(total) || lowest ? std::numeric_limits<double>::infinity() : total;
  }

  Programs programs_;
  Eigen::MatrixXd rest_;  // n×5: VertexInput from u on
};

Eigen::MatrixXd rest_of(const Level& level, const Material& material) {
  Eigen::MatrixXd rest(level.vertex_count(), 5);
  rest << level.rest.vertices, level.vertex_area, material.area_density() * level.vertex_area;
  return rest;
}

}  // namespace

std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material) {
  Programs programs = compile_vertex(law, material);
  const bool is_linear = programs.is_linear;
  auto bound = std::make_unique<BoundVertexFormula>(std::move(programs), rest_of(level, material));
  if (!is_linear) return bound;
  Positions g = Positions::Zero(level.vertex_count(), 3);
  const double constant = bound->add_gradient(Positions::Zero(level.vertex_count(), 3), g);
  // An energy that is not finite stays as it is, for the check at rest.
  if (!g.allFinite() || !std::isfinite(constant)) return bound;
  return std::make_unique<LinearEnergy>(-g, constant);
}

std::optional<double> vertex_midpoint_factor(const Law& law, const Material& material) {
  if (law.depends_on_place()) return std::nullopt;
  const Programs programs = compile_vertex(law, material);
  if (!programs.is_linear) return std::nullopt;
  const auto force = [&](double area) {
    double registers[Program::slots] = {};
    const Program& p = programs.gradient;
    using I = VertexInput;
    for (const auto& [input, value] : {std::pair(I::area, area), std::pair(I::mass, 0.7 * area)})
      registers[p.register_of(input)] = value;
    p.run<double, 1>(registers);
    return Eigen::Vector4d(registers[p.output(0)], registers[p.output(1)], registers[p.output(2)],
                           registers[p.output(3)]);
  };
  const Eigen::Vector4d one = force(1e-4), three = force(3e-4);
  if (!((three - 3 * one).norm() <= 1e-12 * three.norm())) return std::nullopt;
  return 1;
}

}  // namespace drape::formula
