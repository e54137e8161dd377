#pragma once

#include <limits>
#include <memory>
#include <utility>

#include "core/kernel/elements/batched_energy.h"
#include "core/kernel/elements/stretch_kernel.h"
#include "plugins/energy/formula/compile.h"

namespace drape::formula {

/// Packs that programs compute with at once.
inline constexpr int batch_packs = 8;

/// +∞ for an energy of -∞ too: outside the domain of a formula there is no lower one.
template <class T>
T infinite_if_not_finite(const T& energy) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return select(energy == -infinity, infinity, energy);
}

/// The energies of a batch: output 0 of a program that has run.
template <class T>
void read_energies(const Program& program, const T* registers, T* energies) {
  const T* own = registers + program.output(0) * batch_packs;
  for (int i = 0; i < batch_packs; ++i) energies[i] = infinite_if_not_finite(own[i]);
}

/// Rest positions of elements, the mean of their first `corners` vertices, for formulas that depend on them.
template <int k, int corners>
class Places {
 public:
  using T = Pack<native_pack_width>;

  Places() = default;
  /// Of a level, which needs not outlive this.
  explicit Places(const Level& level) : rest_(std::make_shared<const Positions>(level.rest.vertices)) {}

  /// Fills the registers of u, v and w for pack i of a batch, if the formula has them.
  template <class Input>
  void fill(const Program& program, T* registers, int i, const ElementPack<k, native_pack_width>& elements,
            Input u) const {
    if (!rest_) return;
    T sum[3] = {0.0, 0.0, 0.0};
    for (int v = 0; v < corners; ++v) {
      T x[3];
      gather_rows(rest_->data(), elements.vertices[v], x[0], x[1], x[2]);
      for (int c = 0; c < 3; ++c) sum[c] += x[c];
    }
    for (int c = 0; c < 3; ++c)
      registers[program.register_of(static_cast<int>(u) + c) * batch_packs + i] = sum[c] * (1.0 / corners);
  }

 private:
  std::shared_ptr<const Positions> rest_;
};

/// Columns of the deformation gradient F of a pack of triangles.
struct Deformation {
  Eigen::Matrix<Pack<native_pack_width>, 3, 1> f1, f2;
};

/// A triangle's energy as a function of its Green strains, for BatchedEnergy, and also of its principal
/// stretches where a formula uses both. With W_a = ∂W/∂g_a and the columns f₁, f₂ of F, the stress by them is
///     p₁ = W₁₁ f₁ + ½ W₁₂ f₂,   p₂ = W₂₂ f₂ + ½ W₁₂ f₁.
class StrainKernel {
 public:
  static constexpr int vertices = 3, batch = batch_packs;
  /// F = [m₀ e₁ + m₁ e₂, m₂ e₁ + m₃ e₂]: m, then the area.
  using Rest = Eigen::Matrix<double, 5, 1>;
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<3, native_pack_width, batch>;
  using Vector = Batch::Vector;

  StrainKernel(Programs programs, Places<3, 3> places, bool with_stretches)
      : programs_(std::move(programs)), places_(std::move(places)), with_stretches_(with_stretches) {}

  void value(const Batch& packs, T* energies) const;
  void gradient(const Batch& packs, T* energies, Vector (*g)[2]) const;
  void hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const;

 private:
  /// Derivatives by the strains g11, g22, g12, the second as the upper triangle of Jet<3>.
  struct ByStrains {
    T first[3], second[6];
  };

  /// Fills the registers of the program, and `kept`, unless it is null, with the packs' deformations.
  void read(const Batch& packs, const Program& program, T* registers, Deformation* kept) const;
  ByStrains first_by_strains(const Deformation& f, const T* registers, const Program& program, int i,
                             int first) const;
  ByStrains by_strains(const Deformation& f, const T* registers, int i) const;
  void exact_hessian(const Deformation& f, const T* rest, const T* registers, int i, Batch::Hessian& h) const;

  Programs programs_;
  Places<3, 3> places_;
  bool with_stretches_;
};

/// A triangle's energy as a function of its principal stretches alone.
class StretchFormulaKernel {
 public:
  static constexpr int vertices = 3, batch = batch_packs;
  /// RestTriangle's a, b, c, then the area.
  using Rest = Eigen::Matrix<double, 4, 1>;
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<3, native_pack_width, batch>;
  using Vector = Batch::Vector;

  StretchFormulaKernel(Programs programs, Places<3, 3> places)
      : programs_(std::move(programs)), places_(std::move(places)) {}

  void value(const Batch& packs, T* energies) const;
  void gradient(const Batch& packs, T* energies, Vector (*g)[2]) const;
  void hessian(const Batch& packs, Projection projection, Batch::Hessian* h) const;

 private:
  /// As StrainKernel's.
  void read(const Batch& packs, const Program& program, T* registers, Deformation* kept) const;

  Programs programs_;
  Places<3, 3> places_;
};

}  // namespace drape::formula
