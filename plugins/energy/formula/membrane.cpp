#include "plugins/energy/formula/membrane.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/kernel/elements/buckling_membrane.h"
#include "plugins/energy/formula/strain_kernel.h"

namespace drape::formula {
namespace {

bool uses_stretches(const Law& law) { return law.uses("s1") || law.uses("s2"); }
/// The places of the level's triangles, for a law that depends on them.
Places<3, 3> places_of(const Law& law, const Level& level) {
  return law.depends_on_place() ? Places<3, 3>(level) : Places<3, 3>();
}

bool uses_strains(const Law& law) { return law.uses("g11") || law.uses("g22") || law.uses("g12"); }

Eigen::Vector3d centroid(const Level& level, int t) {
  const auto v = level.rest.triangles.row(t);
  const Positions& x = level.rest.vertices;
  return (x.row(v[0]) + x.row(v[1]) + x.row(v[2])) / 3;
}

/// The axis within a plane with this normal; where it is the normal, the next one of the frame.
Eigen::Vector3d projected(Eigen::Vector3d axis, const Eigen::Vector3d& normal) {
  for (int turn = 0;; ++turn) {
    const Eigen::Vector3d own = axis - axis.dot(normal) * normal;
    if (turn == 2 || own.norm() > 1e-6 * axis.norm()) return own.normalized();
    axis = Eigen::Vector3d(axis[2], axis[0], axis[1]);
  }
}

StrainKernel::Rest strain_rest(const Eigen::Vector3d& axis, const Level& level, int t) {
  const double area = RestTriangle::of(level, t).area;  // refuses one without area
  const auto v = level.rest.triangles.row(t);
  const Positions& x = level.rest.vertices;
  const Eigen::Vector3d e1 = x.row(v[1]) - x.row(v[0]), e2 = x.row(v[2]) - x.row(v[0]);
  const Eigen::Vector3d normal = e1.cross(e2).normalized(), first = projected(axis, normal),
                        second = normal.cross(first);
  Eigen::Matrix2d edges;
  edges << first.dot(e1), first.dot(e2), second.dot(e1), second.dot(e2);
  const double det = edges(0, 0) * edges(1, 1) - edges(0, 1) * edges(1, 0);
  StrainKernel::Rest rest;
  rest << edges(1, 1) / det, -edges(1, 0) / det, -edges(0, 1) / det, edges(0, 0) / det, area;
  return rest;
}

StretchFormulaKernel::Rest stretch_rest(const Level& level, int t) {
  const RestTriangle triangle = RestTriangle::of(level, t);
  StretchFormulaKernel::Rest rest;
  rest << triangle.a, triangle.b, triangle.c, triangle.area;
  return rest;
}

/// A triangle's energy and its derivatives by stretches t1 and t2, for Buckling. `rest` has the area and the
/// centroid's rest position.
template <class T>
struct PrincipalProgram {
  const Program& program;
  const T* rest;

  PrincipalDerivatives<T> operator()(const T& t1, const T& t2) const {
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

/// An isotropic formula that buckles below the mesh.
class BucklingFormulaKernel {
 public:
  static constexpr int vertices = 3, batch = 1;
  /// RestTriangle's a, b, c, the area, the centroid's rest position, and the stretch of both axes where both
  /// wrinkle.
  using Rest = Eigen::Matrix<double, 8, 1>;
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<3, native_pack_width, batch>;

  BucklingFormulaKernel(Programs programs, double s) : programs_(std::move(programs)), s_(s) {}

  double both_wrinkled(const double* area_and_centroid) const {
    return Buckling<double>::both_wrinkled(PrincipalProgram<double>{programs_.all, area_and_centroid}, s_);
  }

  void value(const Batch& packs, T* energies) const { energies[0] = energy(stretch(packs), packs); }

  void gradient(const Batch& packs, T* energies, Batch::Vector (*g)[2]) const {
    const PrincipalStretch<T> s = stretch(packs);
    StretchDerivatives<T>::gradient(s, state(s, packs).slopes(), packs.rest[0], g[0]);
    energies[0] = energy(s, packs);
  }

  void hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const {
    const PrincipalStretch<T> s = stretch(packs);
    Eigen::Matrix<T, 6, 6> full;
    StretchDerivatives<T>::hessian(s, state(s, packs).slopes(), packs.rest[0], full);
    h[0] = Batch::Hessian(full);
    project_hessian(h[0], projection);
  }

 private:
  static PrincipalStretch<T> stretch(const Batch& packs) {
    const T* rest = packs.rest[0];
    Batch::Vector e[2];
    packs.gather(0, e);
    return PrincipalStretch<T>(e[0] * rest[0], e[0] * rest[1] + e[1] * rest[2]);
  }
  Buckling<T> state(const PrincipalStretch<T>& s, const Batch& packs) const {
    const T* rest = packs.rest[0];
    return Buckling<T>(PrincipalProgram<T>{programs_.all, rest + 3}, s.largest, s.smallest, T(s_), rest[7]);
  }
  // Out of line: value and gradient must return the same bits.
  [[gnu::noinline]] T energy(const PrincipalStretch<T>& s, const Batch& packs) const {
    return infinite_if_not_finite(state(s, packs).value());
  }

  Programs programs_;
  double s_;
};

/// Strains of a triangle with these principal stretches, at an angle in the material's frame.
Eigen::Vector3d strains(double s1, double s2, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), e1 = 0.5 * (s1 * s1 - 1), e2 = 0.5 * (s2 * s2 - 1);
  return {c * c * e1 + s * s * e2, s * s * e1 + c * c * e2, c * s * (e1 - e2)};
}

/// The energy of one triangle at the origin.
double energy_at(const Programs& programs, const Eigen::Vector3d& g, double area = 1) {
  double registers[Program::slots] = {};
  using I = TriangleInput;
  const Program& p = programs.value;
  const double det = (1 + 2 * g[0]) * (1 + 2 * g[1]) - 4 * g[2] * g[2];
  for (const auto& [input, value] :
       {std::pair(I::g11, g[0]), std::pair(I::g22, g[1]), std::pair(I::g12, g[2]), std::pair(I::det, det),
        std::pair(I::area, area), std::pair(I::s1, 1 + g[0]), std::pair(I::s2, 1 + g[1])})
    registers[p.register_of(input)] = value;
  p.run<double, 1>(registers);
  return registers[p.output(0)];
}

}  // namespace

std::unique_ptr<BoundEnergy> bind_membrane(const Law& law, const Eigen::Vector3d& axis, const Level& level,
                                           const Material& material) {
  const Stencils& triangles = level.rest.triangles;
  if (uses_stretches(law) && !uses_strains(law)) {
    std::vector<StretchFormulaKernel::Rest> rest;
    for (int t = 0; t < level.triangle_count(); ++t) rest.push_back(stretch_rest(level, t));
    StretchFormulaKernel kernel(compile_triangle(law, material, TriangleVariables::stretches),
                                places_of(law, level));
    return std::make_unique<BatchedEnergy<StretchFormulaKernel>>(std::move(kernel), triangles, rest,
                                                                 level.triangle_order);
  }
  const bool both = uses_stretches(law);
  std::vector<StrainKernel::Rest> rest;
  for (int t = 0; t < level.triangle_count(); ++t) rest.push_back(strain_rest(axis, level, t));
  StrainKernel kernel(
      compile_triangle(law, material, both ? TriangleVariables::both : TriangleVariables::strains),
      places_of(law, level), both);
  return std::make_unique<BatchedEnergy<StrainKernel>>(std::move(kernel), triangles, rest,
                                                       level.triangle_order);
}

bool is_proportional_to_area(const Law& law) {
  if (law.per_area && !law.uses("area")) return true;
  const Programs programs = compile_triangle(
      law, Material(), uses_stretches(law) ? TriangleVariables::both : TriangleVariables::strains);
  for (const double stretch : {1.02, 1.3, 0.8}) {
    const Eigen::Vector3d g = strains(stretch, 1.01, 0.3);
    const double one = energy_at(programs, g, 1e-4), quarter = energy_at(programs, g, 0.25e-4);
    if (!(std::abs(4 * quarter - one) <= 1e-12 * std::abs(one))) return false;
  }
  return true;
}

bool is_isotropic(const Law& law, const Material& material) {
  if (!uses_strains(law)) return true;
  if (uses_stretches(law)) return false;
  const Programs programs = compile_triangle(law, material, TriangleVariables::strains);
  constexpr double stretches[][2] = {{1.02, 1.01}, {1.07, 0.94}, {1.21, 0.63}, {0.97, 0.91}, {1.5, 1.3}};
  constexpr double angles[] = {0.35, 0.8, 1.3, 2.1, 2.9};
  for (const auto& s : stretches) {
    const double along = energy_at(programs, strains(s[0], s[1], 0));
    for (const double angle : angles) {
      const double turned = energy_at(programs, strains(s[0], s[1], angle));
      const bool equal =
          std::isfinite(along) ? std::abs(turned - along) <= 1e-10 * std::abs(along) : !std::isfinite(turned);
      if (!equal) return false;
    }
  }
  return true;
}

std::unique_ptr<BoundEnergy> bind_buckling(const Law& law, const Level& level, const Material& material,
                                           double s) {
  BucklingFormulaKernel kernel(compile_triangle(law, material, TriangleVariables::stretches), s);
  std::vector<BucklingFormulaKernel::Rest> rest;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const StretchFormulaKernel::Rest plain = stretch_rest(level, t);
    Eigen::Vector4d area_and_centroid;
    area_and_centroid << plain[3], centroid(level, t);
    rest.emplace_back() << plain.head<3>(), area_and_centroid, kernel.both_wrinkled(area_and_centroid.data());
  }
  return std::make_unique<BatchedEnergy<BucklingFormulaKernel>>(std::move(kernel), level.rest.triangles, rest,
                                                                level.triangle_order);
}

}  // namespace drape::formula
