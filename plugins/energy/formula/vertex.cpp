#include "plugins/energy/formula/vertex.h"

#include <utility>

#include "core/numerics/elements/vertex_energy.h"
#include "plugins/energy/formula/compile.h"

namespace drape::formula {
namespace {

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

}  // namespace

std::unique_ptr<BoundEnergy> bind_vertices(const Law& law, const Level& level, const Material& material) {
  Programs programs = compile_vertex(law, material);
  const bool is_linear = programs.is_linear;
  auto bound = std::make_unique<VertexEnergy<VertexProgramKernel>>(level, material,
                                                                   VertexProgramKernel(std::move(programs)));
  if (!is_linear) return bound;
  return as_linear(std::move(bound), level);
}

}  // namespace drape::formula
