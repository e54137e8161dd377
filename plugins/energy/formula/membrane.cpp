#include "plugins/energy/formula/membrane.h"

#include <cmath>

#include "core/numerics/elements/buckling_membrane.h"
#include "core/numerics/elements/buckling_strains.h"
#include "core/numerics/formulas/formula_properties.h"
#include "plugins/energy/formula/strain_kernel.h"

namespace drape::formula {
namespace {

bool uses_stretches(const Law& law) { return law.uses("s1") || law.uses("s2"); }
bool uses_strains(const Law& law) { return law.uses("g11") || law.uses("g22") || law.uses("g12"); }

/// A triangle's energy by its principal stretches, for BucklingLaw. The constants are its area and the
/// centroid at rest.
struct PrincipalProgram {
  static constexpr int constants = 4;
  Program program;

  template <class T>
  PrincipalDerivatives<T> operator()(const T& t1, const T& t2, const T* rest) const {
    T registers[Program::slots];
    constexpr TriangleInput inputs[] = {TriangleInput::s1, TriangleInput::s2, TriangleInput::area,
                                        TriangleInput::u,  TriangleInput::v,  TriangleInput::w};
    const T values[] = {t1, t2, rest[0], rest[1], rest[2], rest[3]};
    for (int i = 0; i < 6; ++i) registers[program.register_of(inputs[i])] = values[i];
    program.run<T, 1>(registers);
    const auto output = [&](int k) { return registers[program.output(k)]; };
    return {output(0), output(1), output(2), output(3), output(5), output(4)};
  }
};

/// A StrainLaw by a program of strains.
Jet<3, double> energy_at(const Program& program, const Eigen::Vector3d& g, const double* place) {
  double registers[Program::slots] = {};
  using I = TriangleInput;
  const double det = (1 + 2 * g[0]) * (1 + 2 * g[1]) - 4 * g[2] * g[2];
  for (const auto& [input, value] :
       {std::pair(I::g11, g[0]), std::pair(I::g22, g[1]), std::pair(I::g12, g[2]), std::pair(I::det, det),
        std::pair(I::area, place[0]), std::pair(I::u, place[1]), std::pair(I::v, place[2]),
        std::pair(I::w, place[3])})
    registers[program.register_of(input)] = value;
  program.run<double, 1>(registers);
  const auto output = [&](int k) { return registers[program.output(k)]; };
  Jet<3, double> w(output(0));
  for (int k = 0; k < 3; ++k) w.first[k] = output(1 + k);
  for (int k = 0; k < 6; ++k) w.second[k] = output(4 + k);
  return w;
}

}  // namespace

std::unique_ptr<BoundEnergy> bind_membrane(const Law& law, const Level& level, const Material& material) {
  const std::vector<MaterialTriangle> triangles = material_triangles(level);
  const bool stretches = uses_stretches(law);
  StrainKernel kernel(
      compile_triangle(law, material, stretches ? TriangleVariables::both : TriangleVariables::strains),
      stretches);
  return std::make_unique<BatchedEnergy<StrainKernel>>(std::move(kernel), level.rest.triangles, triangles,
                                                       level.triangle_order);
}

std::unique_ptr<BoundEnergy> bind_buckling(const Law& law, const Level& level, const Material& material,
                                           double s) {
  const std::vector<MaterialTriangle> triangles = material_triangles(level);
  if (uses_strains(law)) {
    if (uses_stretches(law)) return bind_membrane(law, level, material);
    const Program program = compile_triangle(law, material, TriangleVariables::strains).all;
    const auto energy = [program](const Eigen::Vector3d& g, const double* place) {
      return energy_at(program, g, place);
    };
    const double at_origin[] = {1, 0, 0, 0};
    if (!is_isotropic([&](const Eigen::Vector3d& g) { return energy(g, at_origin).value; }))
      return bind_buckling_strains(energy, triangles, level, s);
  }
  std::vector<Eigen::Vector4d> numbers;
  for (const MaterialTriangle& triangle : triangles) numbers.emplace_back(triangle.tail<4>());
  return bind_buckling_membrane(
      PrincipalProgram{compile_triangle(law, material, TriangleVariables::stretches).all}, level, numbers, s);
}

}  // namespace drape::formula
