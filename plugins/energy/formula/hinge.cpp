#include "plugins/energy/formula/hinge.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/kernel/elements/batched_energy.h"
#include "core/kernel/elements/dihedral_angle.h"
#include "core/kernel/mesh/generate.h"
#include "plugins/energy/formula/compile.h"
#include "plugins/energy/formula/strain_kernel.h"

namespace drape::formula {
namespace {

/// A hinge's energy as a function of its angle.
class HingeFormulaKernel {
 public:
  static constexpr int vertices = 4, batch = batch_packs;
  using Rest = Eigen::Matrix<double, 5, 1>;  ///< HingeInput from `rest` to `area`
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<4, native_pack_width, batch>;
  using Vector = Batch::Vector;

  HingeFormulaKernel(Programs programs, Places<4, 2> places)
      : programs_(std::move(programs)), places_(std::move(places)) {}

  /// From the rest vectors e, u, v [m] of a hinge.
  static Rest rest(const Eigen::Vector3d* x) {
    const double length = x[0].norm(), area1 = x[0].cross(x[1]).norm() / 2,
                 area2 = x[0].cross(x[2]).norm() / 2;
    Rest r;
    r << DihedralAngle<double>(x).angle(), length, 2 * area1 / length, 2 * area2 / length, area1 + area2;
    return r;
  }

  void value(const Batch& packs, T* energies) const {
    T registers[Program::slots * batch];
    run(packs, programs_.value, registers, nullptr);
    read_energies(programs_.value, registers, energies);
  }

  [[gnu::flatten]] void gradient(const Batch& packs, T* energies, Vector (*g)[3]) const {
    T registers[Program::slots * batch];
    const Program& p = programs_.gradient;
    Vector d[batch][3];
    run(packs, p, registers, d);
    read_energies(p, registers, energies);
    for (int i = 0; i < batch; ++i) {
      DihedralAngle<T>(d[i]).gradient(registers[p.output(1) * batch + i], g[i]);
    }
  }

  void hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const {
    T registers[Program::slots * batch];
    const Program& p = programs_.hessian;
    Vector d[batch][3];
    run(packs, p, registers, d);
    for (int i = 0; i < batch; ++i) {
      Eigen::Matrix<T, 9, 9> full;
      DihedralAngle<T>(d[i]).hessian(registers[p.output(1) * batch + i], registers[p.output(0) * batch + i],
                                     full, [&](auto& part) { project_part(part, projection); });
      h[i] = Batch::Hessian(full);
    }
  }

 private:
  // Out of line: value and gradient must return the same bits.
  [[gnu::noinline, gnu::flatten]] void run(const Batch& packs, const Program& program, T* registers,
                                           Vector (*kept)[3]) const {
    constexpr int numbers = Rest::SizeAtCompileTime;
    int of_rest[numbers];
    for (int r = 0; r < numbers; ++r)
      of_rest[r] = program.register_of(static_cast<int>(HingeInput::rest) + r) * batch;
    T* const bend = registers + program.register_of(HingeInput::bend) * batch;
    for (int i = 0; i < batch; ++i) {
      const T* rest = packs.rest[i];
      Vector d[3];
      packs.gather(i, d);
      for (int v = 0; kept && v < 3; ++v) kept[i][v] = d[v];
      bend[i] = bend_from(rest[0], DihedralAngle<T>(d).angle());
      for (int r = 0; r < numbers; ++r) registers[of_rest[r] + i] = rest[r];
      places_.fill(program, registers, i, *packs.elements[i], HingeInput::u);
    }
    program.run<T, batch>(registers);
  }

  Programs programs_;
  Places<4, 2> places_;
};

/// The energy of a hinge at rest but for its bend.
double energy_at(const Program& p, double bend, double length, double h1, double h2) {
  double registers[Program::slots] = {};
  using I = HingeInput;
  for (const auto& [input, value] :
       {std::pair(I::bend, bend), std::pair(I::rest, 0.0), std::pair(I::length, length), std::pair(I::h1, h1),
        std::pair(I::h2, h2), std::pair(I::area, 0.5 * length * (h1 + h2))})
    registers[p.register_of(input)] = value;
  p.run<double, 1>(registers);
  return registers[p.output(0)];
}

}  // namespace

std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material) {
  const Stencils& hinges = level.hinges;
  std::vector<HingeFormulaKernel::Rest> rest;
  for (Eigen::Index h = 0; h < hinges.rows(); ++h) {
    rest.push_back(HingeFormulaKernel::rest(rest_vectors(level, h).data()));
    if (!rest.back().allFinite() || !(rest.back()[2] > 0) || !(rest.back()[3] > 0))
      throw std::runtime_error("a triangle at the edge of vertices " + std::to_string(hinges(h, 0)) +
                               " and " + std::to_string(hinges(h, 1)) + " of level " +
                               std::to_string(level.index) + " has no area at rest");
  }
  HingeFormulaKernel kernel(compile_hinge(law, material),
                            law.depends_on_place() ? Places<4, 2>(level) : Places<4, 2>());
  return std::make_unique<BatchedEnergy<HingeFormulaKernel>>(std::move(kernel), hinges, rest,
                                                             level.hinge_order);
}

// Of a hinge that is split at midpoints, both halves keep its angles, with half its lengths. The new hinges
// inside a triangle are flat.
std::optional<double> hinge_midpoint_factor(const Law& law, const Material& material) {
  if (law.depends_on_place()) return std::nullopt;
  const Program p = compile_hinge(law, material).value;
  constexpr double lengths[][3] = {{0.01, 0.013, 0.007}, {0.2, 0.11, 0.14}};
  std::optional<double> factor;
  for (const auto& l : lengths) {
    const double most = std::abs(energy_at(p, 1, l[0], l[1], l[2]));
    if (!(std::abs(energy_at(p, 0, l[0] / 2, l[1] / 2, l[2] / 2)) <= 1e-14 * most)) return std::nullopt;
    for (const double bend : {-2.0, -0.3, 0.1, 0.7, 1.9}) {
      const double own =
          2 * energy_at(p, bend, l[0] / 2, l[1] / 2, l[2] / 2) / energy_at(p, bend, l[0], l[1], l[2]);
      if (!factor) factor = std::round(own * 1e9) / 1e9;
      if (!(std::abs(own - *factor) <= 1e-9 * std::abs(own))) return std::nullopt;
    }
  }
  return factor;
}

// What the borders have cancels between four sheets. Bent to both sides, so that forces at rest cancel too.
double hinge_plate_stiffness(const Law& law, const Material& material) {
  constexpr double cell = 0.01, radius = 100 * cell;
  constexpr int n = 3;
  const auto excess = [&](int columns, int rows) {
    const Level level =
        Level::of(0, grid({columns * cell, rows * cell}, columns + 1, rows + 1, Diagonals::one_way));
    const auto energy = bind_hinges(law, level, material);
    const auto rolled = [&](double side) {
      Positions x = level.rest.vertices;
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const double angle = x(i, 0) / radius;
        x(i, 0) = radius * std::sin(angle);
        x(i, 2) = side * radius * (1 - std::cos(angle));
      }
      return energy->value(x);
    };
    return rolled(1) + rolled(-1) - 2 * energy->value(level.rest.vertices);
  };
  const double inner = excess(2 * n, 2 * n) - excess(n, 2 * n) - excess(2 * n, n) + excess(n, n);
  const double stiffness = inner / std::pow(n * cell, 2) * (radius * radius);
  return std::isfinite(stiffness) ? std::max(stiffness, 0.0) : 0;
}

}  // namespace drape::formula
