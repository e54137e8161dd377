#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/numerics/elements/batched_energy.h"
#include "core/numerics/elements/vertex_energy.h"
#include "core/numerics/formulas/fold_formula.h"
#include "plugins/energy/formula/formula.h"
#include "plugins/energy/formula/program.h"

namespace drape::formula {
namespace {

/// A hinge's energy as a function of its angle.
class HingeFormulaKernel {
 public:
  static constexpr int vertices = 4, batch = Program::batch_packs;
  using Rest = RestHinge;
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<4, batch>;
  using Vector = Batch::Vector;

  explicit HingeFormulaKernel(Programs programs) : programs_(std::move(programs)) {}

  void value(const Batch& packs, T* energies) const {
    T registers[Program::slots * batch];
    run(packs, programs_.value, registers, nullptr);
    std::copy_n(programs_.value.packs_of(0, registers), batch, energies);
  }

  [[gnu::flatten]] void gradient(const Batch& packs, T* energies, Vector (*g)[3]) const {
    T registers[Program::slots * batch];
    const Program& p = programs_.gradient;
    Vector d[batch][3];
    run(packs, p, registers, d);
    std::copy_n(p.packs_of(0, registers), batch, energies);
    for (int i = 0; i < batch; ++i) {
      DihedralAngle<T>(d[i]).gradient(p.packs_of(1, registers)[i], g[i]);
    }
  }

  void hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const {
    T registers[Program::slots * batch];
    const Program& p = programs_.hessian;
    Vector d[batch][3];
    run(packs, p, registers, d);
    for (int i = 0; i < batch; ++i) {
      Eigen::Matrix<T, 9, 9> full;
      DihedralAngle<T>(d[i]).hessian(p.packs_of(1, registers)[i], p.packs_of(0, registers)[i], full,
                                     [&](auto& part) { project_part(part, projection); });
      h[i] = Batch::Hessian(full);
    }
  }

 private:
  // Out of line: value and gradient must return the same bits.
  [[gnu::noinline, gnu::flatten]] void run(const Batch& packs, const Program& program, T* registers,
                                           Vector (*kept)[3]) const {
    using I = HingeInput;
    constexpr int inputs[] = {I::rest, I::length, I::h1, I::h2, I::area, I::u, I::v, I::w};
    constexpr int numbers = Rest::SizeAtCompileTime;
    int of_rest[numbers];
    for (int r = 0; r < numbers; ++r) of_rest[r] = program.register_of(inputs[r]) * batch;
    T* const bend = registers + program.register_of(I::bend) * batch;
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

/// The energy of a vertex, for VertexEnergy.
class VertexProgramKernel {
 public:
  using T = Pack<native_pack_width>;

  explicit VertexProgramKernel(Programs programs) : programs_(std::move(programs)) {}

  T value(const T* x, const T* rest) const {
    T registers[Program::slots];
    run(programs_.value, x, rest, registers);
    return registers[programs_.value.output(0)];
  }
  T gradient(const T* x, const T* rest, T* g) const {
    T registers[Program::slots];
    const Program& p = programs_.gradient;
    run(p, x, rest, registers);
    for (int c = 0; c < 3; ++c) g[c] = registers[p.output(1 + c)];
    return registers[p.output(0)];
  }
  void hessian(const T* x, const T* rest, Eigen::Matrix<T, 3, 3>& h) const {
    T registers[Program::slots];
    const Program& p = programs_.hessian;
    run(p, x, rest, registers);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i <= j; ++i) h(i, j) = registers[p.output(3 + Jet<3, T>::index(i, j))];
  }

 private:
  static void run(const Program& program, const T* x, const T* rest, T* registers) {
    for (int i = 0; i < 3; ++i) registers[program.register_of(i)] = x[i];
    for (int i = 0; i < 5; ++i) registers[program.register_of(3 + i)] = rest[i];
    program.run<T, 1>(registers);
  }

  Programs programs_;
};

/// A vertex's law on traces: its degree in x, y and z, whatever the values of its constants, which a schedule
/// may change.
Trace trace(const Law& law) {
  std::map<std::string, Trace> names;
  for (const char* variable : {"x", "y", "z"}) names[variable] = Trace(1, 0);
  for (const Part& part : law.parts) {
    std::vector<Trace> traces;
    for (const Node& node : part.tree) {
      const auto argument = [&](int i) { return traces[node.arguments[i]]; };
      Trace result = names[node.word];  // a constant, but for names
      if (node.kind == Node::Kind::call) {
        result = argument(0);
        if (node.arguments.size() == 1 && node.word != "-")
          result = abs(result);  // as any other function
        else if (node.word == "*")
          result = result * argument(1);
        else if (node.word == "/")
          result = result / argument(1);
        else if (node.word == "if")
          result = select(result, argument(1), argument(2));
        else
          for (std::size_t i = 1; i < node.arguments.size(); ++i)
            result = node.word == "+" || node.word == "-" ? result + argument(i) : max(result, argument(i));
      }
      traces.push_back(result);
    }
    names[part.name] = traces.back();
  }
  return names[law.parts.back().name];
}

}  // namespace

std::unique_ptr<BoundEnergy> bind_hinges(const Law& law, const Level& level, const Material& material) {
  HingeFormulaKernel kernel(compile_hinge(law, material));
  return std::make_unique<BatchedEnergy<HingeFormulaKernel>>(std::move(kernel), level.hinges,
                                                             rest_hinges(level), level.hinge_order);
}

std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material) {
  auto bound = std::make_unique<VertexEnergy<VertexProgramKernel>>(
      level, material, VertexProgramKernel(compile_vertex(law, material)));
  if (trace(law).degree > 1) return bound;
  return as_linear(std::move(bound), level);
}

}  // namespace drape::formula
