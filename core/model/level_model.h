#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/hierarchy/level.h"
#include "core/model/contact_model.h"
#include "core/model/energy.h"
#include "core/model/material.h"
#include "core/numerics/block_matrix.h"

namespace drape {

/// An energy under the name it was chosen by.
struct NamedEnergy {
  std::string name;
  std::shared_ptr<const Energy> energy;
};

/// The plain model of one level: the sum E_l of its energies, what keeps it apart from itself and others, its
/// lumped masses and its fixed vertices (docs/method.md, section 1). Immutable; refers to `level`, which must
/// outlive it.
class LevelModel {
 public:
  /// `fixed` has one flag a vertex: 1 where it is held at its place.
  LevelModel(const Level& level, const Material& material, const std::vector<NamedEnergy>& energies,
             std::vector<char> fixed, const std::vector<std::shared_ptr<ContactModel>>& contacts = {});

  const Level& level() const { return level_; }
  const Material& material() const { return material_; }
  const std::vector<char>& fixed() const { return fixed_; }
  const Eigen::VectorXd& masses() const { return masses_; }  ///< n, M_l [kg]

  /// The energies that a finer level may stand in for, Ψ_l and the external ones: all but the limits [J].
  double value(const Positions& x) const;
  /// Overwrites g (n×3) with its gradient [N], fixed vertices included, and returns the value.
  double gradient(const Positions& x, Positions& g) const;
  /// Overwrites `matrix`, which must be over pattern(), with its projected Hessian [N/m].
  void hessian(const Positions& x, Projection projection, BlockMatrix& matrix) const;
  const std::shared_ptr<const BlockPattern>& pattern() const { return pattern_; }

  /// The energies of role `limit`, S_l.
  const std::vector<const BoundEnergy*>& limits() const { return limits_; }
  /// Empty where nothing is to be kept apart.
  const std::vector<std::unique_ptr<BoundContact>>& contacts() const { return contacts_; }

  /// Energy of each term, limits included, in the order given, and of the contacts if there are any [J].
  std::vector<std::pair<std::string, double>> energy_parts(const Positions& x) const;
  /// Norm over free vertices of the external forces at x [N], summed over the external energies: loads
  /// that balance each other are still the scale of what is to be balanced.
  double load_norm(const Positions& x) const;
  /// ‖∇E_l(x)‖ over the load, on free vertices [1], without friction (docs/method.md, section 2); see
  /// residual_scale.
  double force_residual(const Positions& x) const;

  /// What a gradient's norm is divided by: the external load, or without one the forces that hold the
  /// fixed vertices, or without those 1 N.
  double residual_scale(const Positions& x, const Positions& gradient) const;

 private:
  struct Term {
    std::string name;
    EnergyRole role;
    std::unique_ptr<BoundEnergy> energy;
    std::unique_ptr<BlockSlots> slots;  // null where the energy is linear
  };

  double external_force_norm(const Positions& x) const;

  const Level& level_;
  Material material_;
  std::vector<char> fixed_;
  Eigen::VectorXd masses_;
  std::vector<Term> terms_;
  std::vector<const BoundEnergy*> limits_;
  std::vector<std::unique_ptr<BoundContact>> contacts_;
  std::shared_ptr<const BlockPattern> pattern_;
  bool load_is_constant_ = true;   // whether every external energy is linear
  double constant_load_norm_ = 0;  // then the norm of its forces
};

/// Norm of the rows of g whose vertex is free (fixed[i] == 0).
double free_norm(const Positions& g, const std::vector<char>& fixed);

}  // namespace drape
