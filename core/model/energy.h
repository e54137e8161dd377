#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

#include "core/hierarchy/level.h"
#include "core/model/material.h"
#include "core/numerics/block_matrix.h"

namespace drape {

/// What to do with negative eigenvalues of an element's Hessian (docs/method.md, section 5), and how much of
/// it: λ becomes (1 - share) λ + share max(λ, 0) for clamp, or |λ| in place of max(λ, 0) for absolute.
struct Projection {
  enum Kind { clamp, absolute, none };
  Kind kind = clamp;
  double share = 1;  ///< in [0, 1]; 0 leaves the Hessian as it is

  constexpr Projection(Kind kind_in, double share_in = 1)  // NOLINT: a kind is a whole projection
      : kind(kind_in), share(share_in) {}
  /// Whether the Hessian stays as it is.
  bool is_exact() const { return kind == none || share == 0; }
  /// What becomes of the eigenvalue, a double or a Pack.
  template <class T>
  T map(const T& eigenvalue) const {
    using std::max;
    const T lifted = max(eigenvalue, T(0.0)) - eigenvalue;
    return kind == none ? eigenvalue : eigenvalue + (kind == clamp ? share : 2 * share) * lifted;
  }
};

/// The part an energy plays: `external` ones define the load of the force residual; `position` ones pull
/// vertices to places; a `limit` belongs to the mesh it is on, as contact does, and is never evaluated on a
/// finer one in its place.
enum class EnergyRole { membrane, bending, external, position, limit };

/// A set of roles.
class Roles {
 public:
  constexpr Roles() = default;
  constexpr Roles(std::initializer_list<EnergyRole> roles) {
    for (EnergyRole role : roles) bits_ |= bit(role);
  }
  static constexpr Roles all() {
    return {EnergyRole::membrane, EnergyRole::bending, EnergyRole::external, EnergyRole::position,
            EnergyRole::limit};
  }

  constexpr bool has(EnergyRole role) const { return (bits_ & bit(role)) != 0; }
  constexpr void add(EnergyRole role) { bits_ |= bit(role); }

 private:
  static constexpr unsigned bit(EnergyRole role) { return 1U << static_cast<unsigned>(role); }
  unsigned bits_ = 0;
};

/// How far along a step a state stays allowed, and what ends it there.
struct StepLimit {
  double fraction = 1;  ///< in [0, 1]
  std::string by;       ///< the element or pair that ends it, in words; empty at 1
};

/// An energy bound to one level: E(x), ∂E/∂x, ∂²E/∂x². Immutable; evaluation is const, stateless and
/// gives the same bits with any number of threads.
class BoundEnergy {
 public:
  virtual ~BoundEnergy() = default;

  /// Energy at x (n×3) [J]; +∞ outside its domain.
  virtual double value(const Positions& x) const = 0;

  /// Adds the gradient [N] to g (n×3) and returns the energy [J].
  virtual double add_gradient(const Positions& x, Positions& g) const = 0;

  /// m×k vertices of each element whose Hessian is not zero; no rows where the energy is linear, and then
  /// finite everywhere: such an energy is evaluated once, where all x are 0, and its gradient kept.
  /// Fixed for the life of the object: the matrix pattern and every sink's slots follow from it.
  virtual Stencils stencils() const = 0;

  /// Adds ∂²E/∂x² [N/m], projected per element, to the sink: element e of stencils() adds its
  /// 3×3 blocks (a, b), a ≤ b, a and b being columns of stencils().
  virtual void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const = 0;
};

/// An optional ability of a BoundEnergy that has a domain.
class StepFilter {
 public:
  virtual ~StepFilter() = default;
  /// The part of the straight way from x0, which is inside, to x1 that stays inside.
  virtual StepLimit max_step(const Positions& x0, const Positions& x1) const = 0;
};

/// A kind of energy, made by name from its parameters. Out of it comes one BoundEnergy a level.
class Energy {
 public:
  virtual ~Energy() = default;
  virtual EnergyRole role() const = 0;
  /// By what factor the energy of a surface grows where every triangle, at rest and deformed, is split into
  /// four at its edges' midpoints: 1 for energies of the surface itself; 2 where folds sit at edges, for
  /// each half of an edge has a quarter of the area beside it. None where no factor holds for all states.
  virtual std::optional<double> midpoint_factor() const { return std::nullopt; }
  /// The level and the material must outlive nothing: whatever is needed is copied.
  virtual std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const = 0;
};

}  // namespace drape
