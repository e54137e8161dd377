#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/interfaces/block_sink.h"
#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/material.h"

namespace drape {

/// Treatment of negative eigenvalues λ of an element's Hessian (docs/theory/method.md, section 2): λ becomes
/// (1 - blend) λ + blend max(λ, 0) for clamp, with |λ| in place of max(λ, 0) for absolute.
struct Projection {
  enum Kind { clamp, absolute, none };
  Kind kind = clamp;
  double blend = 1;  ///< in [0, 1]; 0 leaves the Hessian unprojected

  /// Not explicit: a kind alone stands for its full projection.
  constexpr Projection(Kind kind_in, double blend_in = 1) : kind(kind_in), blend(blend_in) {}
  /// Whether the Hessian stays unprojected.
  bool is_exact() const { return kind == none || blend == 0; }
  /// The projected eigenvalue. T is double or a Pack.
  template <class T>
  T map(const T& eigenvalue) const {
    using std::max;
    const T lifted = max(eigenvalue, T(0.0)) - eigenvalue;
    return kind == none ? eigenvalue : eigenvalue + (kind == clamp ? blend : 2 * blend) * lifted;
  }
};

/// Role of an energy. `external` energies are the load that scales the force residual; `position` energies
/// pull vertices to targets; a `limit` belongs to its own mesh, like contact, and is never part of a proxy.
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
  bool operator==(const Roles&) const = default;

 private:
  static constexpr unsigned bit(EnergyRole role) { return 1U << static_cast<unsigned>(role); }
  unsigned bits_ = 0;
};

/// Largest feasible fraction of a step, and what limits it.
struct StepLimit {
  double fraction = 1;  ///< in [0, 1]
  std::string by;       ///< name of the limiting element or pair; empty at 1
};

class StretchLimited;

/// An energy bound to one level: E(x), ∂E/∂x, ∂²E/∂x². Immutable; evaluation is const, stateless and bitwise
/// reproducible with any number of threads.
class BoundEnergy {
 public:
  virtual ~BoundEnergy() = default;

  /// Energy at x (n×3) [J]; +∞ outside its domain.
  virtual double value(const Positions& x) const = 0;

  /// Adds the gradient [N] to g (n×3) and returns the energy [J].
  virtual double add_gradient(const Positions& x, Positions& g) const = 0;

  /// m×k vertices of each element with a non-zero Hessian. No rows mean that the energy is linear and finite
  /// everywhere: it is evaluated only once, at x = 0. Fixed for the life of the object, since the matrix
  /// pattern depends on it.
  virtual Stencils stencils() const = 0;

  /// Adds ∂²E/∂x² [N/m], projected per element, to the sink: element e of stencils() adds its
  /// 3×3 blocks (a, b), a ≤ b, a and b being columns of stencils().
  virtual void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const = 0;

  /// For a bounded domain: the largest step from x0, which is in it, straight towards x1 that stays in it.
  virtual StepLimit max_step([[maybe_unused]] const Positions& x0,
                             [[maybe_unused]] const Positions& x1) const {
    return {};
  }
  /// Itself as a limit of stretches; null for other energies.
  virtual const StretchLimited* stretch_limit() const { return nullptr; }
};

/// A kind of energy, made by name from its parameters. It makes one BoundEnergy for each level.
class Energy {
 public:
  static constexpr const char* kind = "energy";  ///< in the registry
  virtual ~Energy() = default;
  virtual EnergyRole role() const = 0;
  /// Factor on the energy if every triangle, at rest and deformed, is split into four at its edge midpoints:
  /// 1 for energies of the surface itself; 2 for folds at edges, because each half edge has a quarter of the
  /// adjacent area. None if no factor holds for all states: PCS then evaluates all energies of this role on
  /// the finest mesh while it solves a coarse level, unless they have a bind_sharp().
  virtual std::optional<double> midpoint_factor() const { return std::nullopt; }
  /// Binds a bending energy without a midpoint factor to a coarse level as if its mesh were finer: folds at
  /// its edges, one for each of its hinges, are `sharpness` times as sharp, 2^k where every triangle is split
  /// into four k times. With the stencils of bind(). None by default.
  virtual std::unique_ptr<BoundEnergy> bind_sharp([[maybe_unused]] const Level& level,
                                                  [[maybe_unused]] const Material& material,
                                                  [[maybe_unused]] const Eigen::VectorXd& sharpness) const {
    return nullptr;
  }
  /// Stiffness D [J] of a bending energy as a plate's: a sheet rolled to a curvature κ has ½ D κ² for each
  /// unit of rest area. By default 0: it does not keep the cloth from wrinkling below a coarse mesh.
  virtual double plate_stiffness([[maybe_unused]] const Material& material) const { return 0; }
  /// Copies what it needs: level and material need not outlive the result.
  virtual std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const = 0;
  /// Binds a membrane to a coarse level below whose mesh the cloth buckles: no compressive stress exceeds s /
  /// V by much, V rest area × thickness of the triangle and s [J] times the level's bound_factors
  /// (docs/theory/locking.md; bind_buckling_membrane makes it of an isotropic law). A triangle's law, but not
  /// s, is multiplied by the level's softening: areas of RestTriangle::of and material_triangles have that
  /// factor. None by default: a coarse triangle resists compression with all its stiffness, as by bind(), and
  /// the level's result says so.
  virtual std::unique_ptr<BoundEnergy> bind_buckling([[maybe_unused]] const Level& level,
                                                     [[maybe_unused]] const Material& material,
                                                     [[maybe_unused]] double s) const {
    return nullptr;
  }
  /// Lines about the energy that `drape check` prints, such as a check of its derivatives. By default none.
  virtual std::vector<std::string> remarks([[maybe_unused]] const Material& material) const { return {}; }
};

}  // namespace drape
