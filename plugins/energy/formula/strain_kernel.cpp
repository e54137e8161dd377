#include "plugins/energy/formula/strain_kernel.h"

namespace drape::formula {
namespace {

using T = StrainKernel::T;
using Vector = StrainKernel::Vector;

}  // namespace

// Out of line: value and gradient must return the same bits. Flat, so that a pack stays in registers.
[[gnu::noinline, gnu::flatten]] void StrainKernel::read(const Batch& packs, const Program& program,
                                                        T* registers, Deformation* kept) const {
  using I = TriangleInput;
  const auto of = [&](I input) { return registers + program.register_of(input) * batch; };
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

void StrainKernel::value(const Batch& packs, T* energies) const {
  T registers[Program::slots * batch];
  read(packs, programs_.value, registers, nullptr);
  programs_.value.run<T, batch>(registers);
  read_energies(programs_.value, registers, energies);
}

StrainKernel::ByStrains StrainKernel::first_by_strains(const Deformation& f, const T* registers,
                                                       const Program& program, int i, int first) const {
  const auto output = [&](int k) { return registers[program.output(first + k) * batch + i]; };
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

StrainKernel::ByStrains StrainKernel::by_strains(const Deformation& f, const T* registers, int i) const {
  const Program& program = programs_.hessian;
  ByStrains w = first_by_strains(f, registers, program, i, 0);
  const int variables = with_stretches_ ? 5 : 3;
  const auto second = [&](int j, int k) {
    return registers[program.output(variables + Jet<5, T>::index(j, k)) * batch + i];
  };
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j <= k; ++j) w.second[Jet<3, T>::index(j, k)] = second(j, k);
  if (!with_stretches_) return w;

  // Strains along v₁ and v₂ and the shear between them are linear in g; so are changes of the stretches.
  const PrincipalStretch<T> s(f.f1, f.f2);
  const T s1 = StretchDerivatives<T>::floored(s.largest), s2 = StretchDerivatives<T>::floored(s.smallest);
  const T cc = s.cosine * s.cosine, ss = s.sine * s.sine, cs = s.cosine * s.sine;
  const T a1[] = {cc, ss, 2.0 * cs}, a2[] = {ss, cc, -2.0 * cs}, shear[] = {-cs, cs, cc - ss};
  const T first1 = registers[program.output(3) * batch + i],
          first2 = registers[program.output(4) * batch + i];
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
                                          k12 * (a1[j] * a2[k] + a2[j] * a1[k]) + q * (shear[j] * shear[k]) +
                                          across1 + across2;
    }
  return w;
}

[[gnu::flatten]] void StrainKernel::gradient(const Batch& packs, T* energies, Vector (*g)[2]) const {
  T registers[Program::slots * batch];
  const Program& program = programs_.gradient;
  Deformation kept[batch];
  read(packs, program, registers, kept);
  program.run<T, batch>(registers);
  read_energies(program, registers, energies);
  for (int i = 0; i < batch; ++i) {
    const Deformation& f = kept[i];
    const ByStrains w = first_by_strains(f, registers, program, i, 1);
    StrainDerivatives<T>::gradient(f.f1, f.f2, w.first, packs.rest[i], g[i]);
  }
}

[[gnu::flatten]] void StrainKernel::exact_hessian(const Deformation& f, const T* m, const T* registers, int i,
                                                  Batch::Hessian& h) const {
  const ByStrains w = by_strains(f, registers, i);
  Eigen::Matrix<T, 6, 6> full;
  StrainDerivatives<T>::hessian(f.f1, f.f2, w.first, w.second, m, full);
  h = Batch::Hessian(full);
}

void StrainKernel::hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const {
  T registers[Program::slots * batch];
  Deformation kept[batch];
  read(packs, programs_.hessian, registers, kept);
  programs_.hessian.run<T, batch>(registers);
  for (int i = 0; i < batch; ++i) {
    exact_hessian(kept[i], packs.rest[i], registers, i, h[i]);
    project_hessian(h[i], projection);
  }
}

}  // namespace drape::formula
