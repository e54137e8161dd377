#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/material.h"
#include "core/numerics/hierarchy/fineness.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// An energy and its type, as the experiment names it.
struct NamedEnergy {
  std::string name;
  std::shared_ptr<const Energy> energy;
};

/// A vertex with a prescribed position.
struct DirichletVertex {
  int vertex = 0;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< [m]
  int pin = 0;                                       ///< index of its pin in the experiment
};

/// The plain model of one level at one point of the pseudo-time: the sum E_l of its energies, its contacts,
/// its lumped masses and its Dirichlet vertices (docs/theory/method.md, section 1). Immutable: load stepping
/// makes another one. Refers to `level`, which must outlive it.
class LevelModel {
 public:
  /// `dirichlet` must not list a vertex twice. Shares with `before`, a model of the same level at another
  /// pseudo-time, all that is equal; its energies may be followed by more. Throws std::runtime_error if an
  /// energy's stencils differ from those in `before`: the sparsity pattern must not change over time.
  /// Membranes rest as in `membranes`, the same level with another rest shape, as while a garment is sewn;
  /// without it as in `level`.
  LevelModel(const Level& level, const Material& material, const std::vector<NamedEnergy>& energies,
             std::vector<DirichletVertex> dirichlet,
             const std::vector<std::shared_ptr<ContactModel>>& contacts = {},
             const LevelModel* before = nullptr, std::shared_ptr<const Level> membranes = nullptr);

  const Level& level() const { return *level_; }
  const Material& material() const { return material_; }
  const std::vector<DirichletVertex>& dirichlet() const { return dirichlet_; }
  /// Moves the Dirichlet vertices of x (n×3) [m] to their targets.
  void set_dirichlet(Positions& x) const {
    for (const DirichletVertex& d : dirichlet_) x.row(d.vertex) = d.target.transpose();
  }
  /// One flag a vertex: 1 where it has a Dirichlet condition.
  const std::vector<char>& fixed() const { return fixed_; }
  /// Whether Dirichlet conditions or energies of role `position` keep the cloth somewhere.
  bool is_held() const;
  const Eigen::VectorXd& masses() const { return masses_; }  ///< n, M_l [kg]

  /// Ψ_l and the external energies, or those of the given roles; never the limits [J].
  double value(const Positions& x, Roles roles = Roles::all()) const;
  /// Overwrites g (n×3) with its gradient [N], fixed vertices included, and returns the value.
  double gradient(const Positions& x, Positions& g, Roles roles = Roles::all()) const;
  /// Overwrites `matrix`, which must be over pattern(), with its projected Hessian [N/m].
  void hessian(const Positions& x, Projection projection, BlockMatrix& matrix,
               Roles roles = Roles::all()) const;
  /// Adds `factor` times that to the matrix.
  void add_hessian(const Positions& x, Projection projection, BlockMatrix& matrix, Roles roles,
                   double factor) const;
  /// The common Energy::midpoint_factor of all energies of a role, 1 for those bound by bind_sharp and for a
  /// role without energies. None if the factors differ or one is missing.
  std::optional<double> midpoint_factor(EnergyRole role) const;
  const std::shared_ptr<const BlockPattern>& pattern() const { return pattern_; }

  /// This model with at least this barrier stiffness [Pa], empty or of each contact.
  LevelModel with_stiffness(const ContactStiffness& stiffness) const;
  /// Root mean square of the external forces per area over the free vertices at x [Pa].
  double load_pressure(const Positions& x) const;

  /// The model with membranes that buckle below the mesh (Energy::bind_buckling) and give way at lone pins
  /// (softening_at_pins), for a level below the finest. Its contacts and other energies are shared with this
  /// model.
  LevelModel with_effective_membranes(const Fineness& finest, const std::vector<int>& lone_pins = {}) const;
  /// The names of its membranes that do not buckle below the mesh: of a model with_effective_membranes those
  /// without Energy::bind_buckling, or all where there are several, each of which would buckle alone.
  std::vector<std::string> unbuckling_membranes() const;
  /// The model whose hinges resist bending in each direction as the finest level's do (Fineness::folds). With
  /// `sharp` each is also as much stiffer as that level's edges are shorter around it, over their mean, which
  /// midpoint_factor gives, and energies without that factor are bound by bind_sharp: so stiff is a fold of
  /// this level's mesh on the finest one.
  LevelModel with_local_folds(const Fineness& finest, bool sharp) const;

  /// The energies of role `limit`, S_l.
  const std::vector<const BoundEnergy*>& limits() const { return limits_; }
  /// Empty without contact.
  const BoundContacts& contacts() const { return contacts_; }
  /// The obstacles of all contacts, as meshes for drawing and for pins to follow.
  std::vector<TriangleMesh> obstacles() const;

  /// E_l with its limits and without contact [J].
  double energy_without_contact(const Positions& x) const;
  /// All of E_l: energies, limits and the contacts' barrier, without friction [J].
  double energy(const Positions& x) const { return energy_without_contact(x) + barrier(x); }
  /// Overwrites g (n×3) with the gradient of energy(x) [N], fixed vertices included, and returns energy(x).
  double energy_gradient(const Positions& x, Positions& g) const;
  /// Norm of the contacts' forces on each vertex at x, without friction, over a third of its triangles' area
  /// at x (n) [Pa]: on a cylinder of radius R under tension T [N/m] it is T / R. Empty for a model without
  /// contact.
  Eigen::VectorXd contact_pressure(const Positions& x) const;
  /// The Hessian of energy(x) [N/m], projected per element. Its pattern has the contacts at x, so every call
  /// builds it again: solvers take an Objective.
  BlockMatrix energy_hessian(const Positions& x, Projection projection) const;
  /// The parts of energy(x): each term in the order given, and the contacts, `contact`, if there are any [J].
  /// No two have one name: the second energy of a type is `gravity 2`.
  std::vector<std::pair<std::string, double>> energy_parts(const Positions& x) const;
  /// Sum over the external energies of the norm of their forces on free vertices at x [N]. Loads that balance
  /// each other still set the scale of the residual.
  double load_norm(const Positions& x) const;
  /// ‖∇E_l(x)‖ over the load, on free vertices [1], without friction (docs/theory/method.md, section 2); see
  /// residual_scale.
  double force_residual(const Positions& x) const;

  /// Scale of the force residual [N]: the external load, but at least a millionth of the cloth's weight;
  /// without a load the reaction forces at fixed vertices, but at least a thousandth of that weight.
  double residual_scale(const Positions& x, const Positions& gradient) const;

 private:
  struct Term {
    std::string name;
    EnergyRole role;
    std::shared_ptr<const Energy> kind;  // the energy that was bound
    const Level* level = nullptr;        // to this one
    std::shared_ptr<const BoundEnergy> energy;
    std::shared_ptr<const BlockSlots> slots;  // null for linear energies and limits
    bool is_sharp = false;                    // bound by bind_sharp
    bool buckles = false;                     // bound by bind_buckling

    bool is_linear() const { return role != EnergyRole::limit && !slots; }
  };
  /// Sum of the linear energies of one role, so that one pass evaluates all of them.
  struct LinearSum {
    EnergyRole role;
    Positions gradient;
    double at_origin = 0;  // value at x = 0
  };

  void bind_energies(const std::vector<NamedEnergy>& energies, const LevelModel* before);
  void bind_contacts(const std::vector<std::shared_ptr<ContactModel>>& contacts, const LevelModel* before);
  double external_force_norm(const Positions& x) const;
  double barrier(const Positions& x) const;  // of the contacts [J]
  double add_barrier_gradient(const Positions& x, Positions& g) const;
  void add_up_linear_energies();
  /// The value of the linear energies of these roles [J]. Overwrites g, unless it is null, with their
  /// gradient.
  double linear_value(const Positions& x, Positions* g, Roles roles) const;

  /// The level with the rest shape of an energy of this role.
  const Level& level_of(EnergyRole role) const {
    return role == EnergyRole::membrane && membranes_ ? *membranes_ : *level_;
  }

  const Level* level_;
  std::shared_ptr<const Level> membranes_;  // may be null
  Material material_;
  std::vector<DirichletVertex> dirichlet_;
  std::vector<char> fixed_;
  Eigen::VectorXd masses_;
  std::vector<Term> terms_;
  std::vector<const BoundEnergy*> limits_;
  std::vector<std::shared_ptr<ContactModel>> contact_kinds_;  // those that contacts_ come from
  std::vector<std::shared_ptr<const BoundContact>> bound_;    // one for each kind; may be null
  BoundContacts contacts_;                                    // the non-null ones
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<LinearSum> linear_;
  std::optional<double> constant_load_norm_;  // of the external energies' forces [N], if all are linear
};

/// Norm of the rows of g whose vertex is free (fixed[i] == 0).
double free_norm(const Positions& g, const std::vector<char>& fixed);

}  // namespace drape
