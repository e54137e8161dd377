#pragma once

#include <memory>
#include <optional>
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

/// A vertex held at a place.
struct HeldVertex {
  int vertex = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< [m]
  int pin = 0;                                      ///< which of the experiment's pins holds it
};

/// The plain model of one level: the sum E_l of its energies, what keeps it apart from itself and others, its
/// lumped masses and its held vertices (docs/method.md, section 1), under the conditions of one moment. Under
/// others it is another one, assigned to it. Refers to `level`, which must outlive it.
class LevelModel {
 public:
  /// No vertex may be held twice. What `before`, a model of the same level under other conditions, has in
  /// common is shared with it. Throws std::runtime_error where an energy's stencils are others there: a
  /// pattern is for all conditions.
  LevelModel(const Level& level, const Material& material, const std::vector<NamedEnergy>& energies,
             std::vector<HeldVertex> held, const std::vector<std::shared_ptr<ContactModel>>& contacts = {},
             const LevelModel* before = nullptr);

  /// Has the contacts of another model of the level.
  void take_contacts(const LevelModel& other);

  const Level& level() const { return *level_; }
  const Material& material() const { return material_; }
  const std::vector<HeldVertex>& held() const { return held_; }
  /// One flag a vertex: 1 where it is held.
  const std::vector<char>& fixed() const { return fixed_; }
  const Eigen::VectorXd& masses() const { return masses_; }  ///< n, M_l [kg]

  /// Ψ_l and the external energies, or those of them that play one of the `roles`; never the limits [J].
  double value(const Positions& x, Roles roles = Roles::all()) const;
  /// Overwrites g (n×3) with its gradient [N], fixed vertices included, and returns the value.
  double gradient(const Positions& x, Positions& g, Roles roles = Roles::all()) const;
  /// Overwrites `matrix`, which must be over pattern(), with its projected Hessian [N/m].
  void hessian(const Positions& x, Projection projection, BlockMatrix& matrix,
               Roles roles = Roles::all()) const;
  /// Adds `factor` times that to the matrix.
  void add_hessian(const Positions& x, Projection projection, BlockMatrix& matrix, Roles roles,
                   double factor) const;
  /// The Energy::midpoint_factor that all energies of a role have; none where they differ or have none.
  std::optional<double> midpoint_factor(EnergyRole role) const;
  const std::shared_ptr<const BlockPattern>& pattern() const { return pattern_; }

  /// The energies of role `limit`, S_l.
  const std::vector<const BoundEnergy*>& limits() const { return limits_; }
  /// Empty where nothing is to be kept apart.
  const BoundContacts& contacts() const { return contacts_; }

  /// Energy of each term, limits included, in the order given, and of the contacts if there are any [J].
  std::vector<std::pair<std::string, double>> energy_parts(const Positions& x) const;
  /// Norm over free vertices of the external forces at x [N], summed over the external energies: loads
  /// that balance each other are still the scale of what is to be balanced.
  double load_norm(const Positions& x) const;
  /// ‖∇E_l(x)‖ over the load, on free vertices [1], without friction (docs/method.md, section 2); see
  /// residual_scale.
  double force_residual(const Positions& x) const;

  /// What a gradient's norm is divided by: the external load, or without one the forces that hold the
  /// fixed vertices, which are none where the cloth comes to lie without a force: then a thousandth of its
  /// weight.
  double residual_scale(const Positions& x, const Positions& gradient) const;

 private:
  struct Term {
    std::string name;
    EnergyRole role;
    std::shared_ptr<const Energy> kind;  // that it was bound from
    std::shared_ptr<const BoundEnergy> energy;
    std::shared_ptr<const BlockSlots> slots;  // null where the energy is linear, and of a limit

    bool is_linear() const { return role != EnergyRole::limit && !slots; }
  };
  /// The sum of the linear energies of one role: one pass over their forces does for all of them.
  struct LinearSum {
    EnergyRole role;
    Positions gradient;
    double at_origin = 0;  // where all x are 0
  };

  void bind_energies(const std::vector<NamedEnergy>& energies, const LevelModel* before);
  void bind_contacts(const std::vector<std::shared_ptr<ContactModel>>& contacts, const LevelModel* before);
  double external_force_norm(const Positions& x) const;
  void add_up_linear_energies();
  /// The linear energies' sum; `g`, if given, is overwritten with their gradient.
  double linear_value(const Positions& x, Positions* g, Roles roles) const;

  const Level* level_;
  Material material_;
  std::vector<HeldVertex> held_;
  std::vector<char> fixed_;
  Eigen::VectorXd masses_;
  std::vector<Term> terms_;
  std::vector<const BoundEnergy*> limits_;
  std::vector<std::shared_ptr<ContactModel>> contact_kinds_;  // that contacts_ were bound from
  std::vector<std::shared_ptr<const BoundContact>> bound_;    // of each of them; null where it binds nothing
  BoundContacts contacts_;                                    // those that are not null
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<LinearSum> linear_;
  bool load_is_constant_ = true;   // whether every external energy is linear
  double constant_load_norm_ = 0;  // then the norm of its forces
};

/// Norm of the rows of g whose vertex is free (fixed[i] == 0).
double free_norm(const Positions& g, const std::vector<char>& fixed);

}  // namespace drape
