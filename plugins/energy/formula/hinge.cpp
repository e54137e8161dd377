#include "plugins/energy/formula/hinge.h"

#include "core/numerics/elements/batched_energy.h"
#include "core/numerics/formulas/fold_formula.h"
#include "plugins/energy/formula/compile.h"
#include "plugins/energy/formula/strain_kernel.h"

namespace drape::formula {
namespace {

/// A hinge's energy as a function of its angle.
class HingeFormulaKernel {
 public:
  static constexpr int vertices = 4, batch = batch_packs;
  using Rest = RestHinge;  ///< HingeInput from `rest` to `w`
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<4, native_pack_width, batch>;
  using Vector = Batch::Vector;

  explicit HingeFormulaKernel(Programs programs) : programs_(std::move(programs)) {}

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
    }
    program.run<T, batch>(registers);
  }

  Programs programs_;
};

}  // namespace

std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material) {
  HingeFormulaKernel kernel(compile_hinge(law, material));
  return std::make_unique<BatchedEnergy<HingeFormulaKernel>>(std::move(kernel), level.hinges,
                                                             rest_hinges(level), level.hinge_order);
}

}  // namespace drape::formula
