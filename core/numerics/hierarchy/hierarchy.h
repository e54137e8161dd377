#pragma once

#include <vector>

#include "core/kernel/interfaces/refiner.h"
#include "core/numerics/hierarchy/normal_offsets.h"

namespace drape {

/// Levels of one cloth from coarse to fine, and the operators between them. Immutable.
struct Hierarchy {
  std::vector<Level> levels;                      ///< at least one
  std::vector<ProlongationMatrix> prolongations;  ///< [l]: P_{l→l+1} of the chosen refiner
  /// [l]: U_{l→l+1}, which does not move the surface where level l + 1 splits the triangles of level l, and
  /// is linear interpolation where it does not.
  std::vector<ProlongationMatrix> midpoints;
  /// [l]: linear interpolation over the rest shape: each fine vertex follows the coarse triangle that
  /// contains its rest position. Equals the midpoint weights wherever the refiner does not move rest
  /// positions.
  std::vector<ProlongationMatrix> linear;
  /// [l]: how the vertices of level l + 1 rest above the triangles of level l, where that is coarsened from a
  /// curved level l + 1; `prolong` adds them.
  std::vector<NormalOffsets> offsets;
  /// Prolongations from coarser meshes to level 0, coarsest first, on which nothing is solved: for multigrid.
  std::vector<ProlongationMatrix> below;
  int cloth = 0;  ///< the level of the cloth's own mesh; levels below it are coarsened, levels above refined

  /// The levels of a cloth: its own mesh, level_count - 1 refinements of it and `coarser_count` coarser
  /// levels below it. Refined rest positions follow the same operator, X_{l+1} = P X_l, which keeps the rest
  /// shape stress-free on every level; texture coordinates are refined linearly. Throws std::runtime_error
  /// with the first fault of check_mesh on any level, if level_count < 1, and if the refiner makes no coarser
  /// levels.
  static Hierarchy of(TriangleMesh cloth, const Refiner& refiner, int level_count, int coarser_count = 0);
  /// Adds meshes below level 0 down to one with this number of vertices.
  void coarsen_below(const Refiner& refiner, int vertices);

  const std::vector<ProlongationMatrix>& weights(Interpolation interpolation) const {
    return interpolation == Interpolation::midpoint ? linear : prolongations;
  }
  /// The prolongations that lead to a level from all coarser meshes, coarsest first.
  std::vector<ProlongationMatrix> leading_to(int level) const;
  int level_count() const { return static_cast<int>(levels.size()); }
  /// Whether level l + 1 splits each triangle of level l into four.
  bool splits(int l) const { return l >= cloth; }

  /// W_{to-1} ⋯ W_{from} x, each with its offsets, for x (n_from × 3) and weights [l]: n_{l+1} × n_l;
  /// 0 ≤ from ≤ to < level_count().
  Positions prolong(const Positions& x, int from, int to,
                    const std::vector<ProlongationMatrix>& weights) const;

 private:
  void add_coarser(const Refiner& refiner, int count);
  void add_finer(const Refiner& refiner, int count);
};

}  // namespace drape
