#pragma once

#include <algorithm>
#include <utility>

#include "core/numerics/elements/batched_energy.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/elements/stretch_kernel.h"
#include "plugins/energy/formula/compile.h"

namespace drape::formula {

/// Packs that programs compute with at once.
inline constexpr int batch_packs = 8;

/// The energies of a batch: output 0 of a program that has run.
template <class T>
void read_energies(const Program& program, const T* registers, T* energies) {
  const T* own = registers + program.output(0) * batch_packs;
  std::copy_n(own, batch_packs, energies);
}

/// Columns of the deformation gradient F of a pack of triangles.
struct Deformation {
  Eigen::Matrix<Pack<native_pack_width>, 3, 1> f1, f2;
};

/// A triangle's energy as a function of its Green strains, for BatchedEnergy, and also of its principal
/// stretches where a formula uses them.
class StrainKernel {
 public:
  static constexpr int vertices = 3, batch = batch_packs;
  using Rest = MaterialTriangle;
  using T = Pack<native_pack_width>;
  using Batch = ElementBatch<3, native_pack_width, batch>;
  using Vector = Batch::Vector;

  StrainKernel(Programs programs, bool with_stretches)
      : programs_(std::move(programs)), with_stretches_(with_stretches) {}

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
  bool with_stretches_;
};

}  // namespace drape::formula
