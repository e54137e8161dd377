#include <algorithm>
#include <utility>

#include "core/numerics/buckling/buckling_membrane.h"
#include "core/numerics/buckling/buckling_strains.h"
#include "core/numerics/elements/batched_energy.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/formulas/formula_properties.h"
#include "plugins/energy/formula/formula.h"
#include "plugins/energy/formula/program.h"

namespace drape::formula {
namespace {

/// Columns of the deformation gradient F of a pack of triangles.
struct Deformation {
  Eigen::Matrix<Pack<native_pack_width>, 3, 1> f1, f2;
};

/// A triangle's energy as a function of its Green strains, for BatchedEnergy, and also of its principal
/// stretches where a formula uses them.
class StrainKernel {
 public:
  static constexpr int vertices = 3, batch = Program::batch_packs;
  using Rest = MaterialTriangle;
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<3, batch>;
  using Vector = Batch::Vector;

  StrainKernel(Programs programs, bool with_stretches)
      : programs_(std::move(programs)), with_stretches_(with_stretches) {}

  void value(const Batch& packs, T* energies) const {
    T registers[Program::slots * batch];
    read(packs, programs_.value, registers, nullptr);
    programs_.value.run<T, batch>(registers);
    std::copy_n(programs_.value.packs_of(0, registers), batch, energies);
  }
  [[gnu::flatten]] void gradient(const Batch& packs, T* energies, Vector (*g)[2]) const {
    T registers[Program::slots * batch];
    const Program& program = programs_.gradient;
    Deformation kept[batch];
    read(packs, program, registers, kept);
    program.run<T, batch>(registers);
    std::copy_n(program.packs_of(0, registers), batch, energies);
    for (int i = 0; i < batch; ++i) {
      const Deformation& f = kept[i];
      const ByStrains w = first_by_strains(f, registers, program, i, 1);
      StrainDerivatives<T>::gradient(f.f1, f.f2, w.first, packs.rest[i], g[i]);
    }
  }

  void hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const {
    T registers[Program::slots * batch];
    Deformation kept[batch];
    read(packs, programs_.hessian, registers, kept);
    programs_.hessian.run<T, batch>(registers);
    for (int i = 0; i < batch; ++i) {
      exact_hessian(kept[i], packs.rest[i], registers, i, h[i]);
      project_hessian(h[i], projection);
    }
  }

 private:
  /// Derivatives by the strains g11, g22, g12, the second as the upper triangle of Jet<3>.
  struct ByStrains {
    T first[3], second[6];
  };

  /// Fills the registers of the program, and `kept`, unless it is null, with the packs' deformations.
  // Out of line: value and gradient must return the same bits. Flat, so that a pack stays in registers.
  [[gnu::noinline, gnu::flatten]] void read(const Batch& packs, const Program& program, T* registers,
                                            Deformation* kept) const {
    using I = TriangleInput;
    const auto of = [&](int input) { return registers + program.register_of(input) * batch; };
    T *const g11 = of(I::g11), *const g22 = of(I::g22), *const g12 = of(I::g12), *const det = of(I::det),
             *const s1 = of(I::s1), *const s2 = of(I::s2);
    T* const of_rest[] = {of(I::area), of(I::u), of(I::v), of(I::w)};
    const bool reads_det = program.reads(I::det),
               reads_stretches = with_stretches_ && (program.reads(I::s1) || program.reads(I::s2));
    const int numbers = program.reads(I::u) || program.reads(I::v) || program.reads(I::w) ? 4 : 1;
    for (int i = 0; i < batch; ++i) {
      const T* m = packs.rest[i];
      Vector e[2];
      packs.gather(i, e);
      const GreenStrain<T> g(e, m);
      if (kept) kept[i] = {g.f1, g.f2};
      g11[i] = g.g11;
      g22[i] = g.g22;
      g12[i] = g.g12;
      if (reads_det) det[i] = g.det();
      if (reads_stretches) {
        const PrincipalStretch<T> s(g.f1, g.f2);
        s1[i] = s.largest;
        s2[i] = s.smallest;
      }
      for (int r = 0; r < numbers; ++r) of_rest[r][i] = m[4 + r];
    }
  }

  ByStrains first_by_strains(const Deformation& f, const T* registers, const Program& program, int i,
                             int first) const {
    const auto output = [&](int k) { return program.packs_of(first + k, registers)[i]; };
    ByStrains w;
    for (int k = 0; k < 3; ++k) w.first[k] = output(k);
    if (!with_stretches_) return w;
    const PrincipalStretch<T> s(f.f1, f.f2);
    const T b1 = output(3) / StretchDerivatives<T>::floored(s.largest),
            b2 = output(4) / StretchDerivatives<T>::floored(s.smallest);
    const T cc = s.cosine * s.cosine, ss = s.sine * s.sine, cs = s.cosine * s.sine;
    w.first[0] += b1 * cc + b2 * ss;
    w.first[1] += b1 * ss + b2 * cc;
    w.first[2] += 2.0 * cs * (b1 - b2);
    return w;
  }

  ByStrains by_strains(const Deformation& f, const T* registers, int i) const {
    const Program& program = programs_.hessian;
    ByStrains w = first_by_strains(f, registers, program, i, 0);
    const int variables = with_stretches_ ? 5 : 3;
    const auto second = [&](int j, int k) {
      return program.packs_of(variables + Jet<5, T>::index(j, k), registers)[i];
    };
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j <= k; ++j) w.second[Jet<3, T>::index(j, k)] = second(j, k);
    if (!with_stretches_) return w;

    // Strains along v₁ and v₂ and the shear between them are linear in g; so are changes of the stretches.
    const PrincipalStretch<T> s(f.f1, f.f2);
    const T s1 = StretchDerivatives<T>::floored(s.largest), s2 = StretchDerivatives<T>::floored(s.smallest);
    const T cc = s.cosine * s.cosine, ss = s.sine * s.sine, cs = s.cosine * s.sine;
    const T a1[] = {cc, ss, 2.0 * cs}, a2[] = {ss, cc, -2.0 * cs}, shear[] = {-cs, cs, cc - ss};
    const T first1 = program.packs_of(3, registers)[i], first2 = program.packs_of(4, registers)[i];
    CoupledSlopes<T> slopes;
    slopes.first1 = first1, slopes.first2 = first2;
    slopes.second1 = second(3, 3), slopes.mixed = second(3, 4), slopes.second2 = second(4, 4);
    slopes.divide(s.largest, s.smallest);
    const T b1 = first1 / s1, b2 = first2 / s2;
    const T k11 = (slopes.second1 - b1) / (s1 * s1), k22 = (slopes.second2 - b2) / (s2 * s2),
            k12 = slopes.mixed / (s1 * s2), q = 4.0 * ((slopes.divided - b2) / (s1 * (s1 + s2)));
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j <= k; ++j) {
        const T across1 = (second(j, 3) * a1[k] + a1[j] * second(k, 3)) / s1,
                across2 = (second(j, 4) * a2[k] + a2[j] * second(k, 4)) / s2;
        w.second[Jet<3, T>::index(j, k)] += k11 * (a1[j] * a1[k]) + k22 * (a2[j] * a2[k]) +
                                            k12 * (a1[j] * a2[k] + a2[j] * a1[k]) +
                                            q * (shear[j] * shear[k]) + across1 + across2;
      }
    return w;
  }

  [[gnu::flatten]] void exact_hessian(const Deformation& f, const T* m, const T* registers, int i,
                                      Batch::Hessian& h) const {
    const ByStrains w = by_strains(f, registers, i);
    Eigen::Matrix<T, 6, 6> full;
    StrainDerivatives<T>::hessian(f.f1, f.f2, w.first, w.second, m, full);
    h = Batch::Hessian(full);
  }

  Programs programs_;
  bool with_stretches_;
};

bool uses_stretches(const Law& law) { return law.uses("s1") || law.uses("s2"); }
bool uses_strains(const Law& law) { return law.uses("g11") || law.uses("g22") || law.uses("g12"); }

/// Runs a triangle's program with the inputs by TriangleInput.
template <class T>
void run(const Program& program, const T (&inputs)[10], T* registers) {
  for (int i = 0; i < 10; ++i) registers[program.register_of(i)] = inputs[i];
  program.run<T, 1>(registers);
}

/// A triangle's energy by its principal stretches, for BucklingLaw. The constants are its area and the
/// centroid at rest.
struct PrincipalProgram {
  static constexpr int constants = 4;
  Program program;

  template <class T>
  PrincipalDerivatives<T> operator()(const T& t1, const T& t2, const T* rest) const {
    T registers[Program::slots];
    const T none = 0.0;
    run(program, {none, none, none, t1, t2, none, rest[0], rest[1], rest[2], rest[3]}, registers);
    const auto output = [&](int k) { return registers[program.output(k)]; };
    return {output(0), output(1), output(2), output(3), output(5), output(4)};
  }
};

/// A StrainLaw by a program of strains.
template <class T>
Jet<3, T> energy_at(const Program& program, const Eigen::Matrix<T, 3, 1>& g, const T* place) {
  T registers[Program::slots];
  const T det = (1.0 + 2.0 * g[0]) * (1.0 + 2.0 * g[1]) - 4.0 * (g[2] * g[2]), none = 0.0;
  run(program, {g[0], g[1], g[2], none, none, det, place[0], place[1], place[2], place[3]}, registers);
  const auto output = [&](int k) { return registers[program.output(k)]; };
  Jet<3, T> w(output(0));
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
    if (uses_stretches(law)) return nullptr;
    const Program program = compile_triangle(law, material, TriangleVariables::strains).all;
    const auto energy = [program](const auto& g, const auto* place) { return energy_at(program, g, place); };
    const auto value = [&](const Eigen::Vector3d& g, const double* place) { return energy(g, place).value; };
    if (!is_isotropic(triangles, law.depends_on_place() || law.uses("area"), value))
      return bind_buckling_strains(energy, triangles, level, s);
  }
  return bind_buckling_membrane(
      PrincipalProgram{compile_triangle(law, material, TriangleVariables::stretches).all}, triangles, level,
      s);
}

}  // namespace drape::formula
