#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/numerics/model/level_model.h"
#include "core/numerics/model/position_penalty.h"
#include "core/numerics/step/newton_step.h"

namespace drape {

/// Moves the Dirichlet vertices of the iterate to their targets (supplement, section 4), and the whole cloth
/// with them by a Newton predictor.
///
/// Vertices that a filtered move does not bring to their targets are, under a schedule (`in_parts`), held
/// where they are and moved again after further steps. Where moves gain nothing, or without a schedule, they
/// are released, and a penalty κ_B/2 m_k ‖x_k − x̃_k‖² pulls them. κ_B doubles while that reduces the
/// distance. Once all targets are reached the vertices are fixed and the penalty is dropped.
///
/// Every move needs a factorisation. If it fails, nothing moves, and the step's factor().fault() says why.
class DirichletEnforcer {
 public:
  /// Refers to the iterate, whose Dirichlet vertices it fixes, and to the step.
  DirichletEnforcer(Iterate& iterate, NewtonStep& step, bool in_parts);

  /// Everything that does not follow from the model.
  struct State {
    std::vector<int> unsatisfied;  ///< indices into the model's dirichlet()
    double stiffness = 0;          ///< κ_B [1/s²]
    double best = 0;               ///< violation when a doubling last helped [m]
    int idle = 0;                  ///< doublings, or without a penalty moves, since one last helped
    bool infeasible = false, released = false;
    std::string blocked_by;
  };
  State state() const {
    State s = s_;
    s.released = has_penalty();
    return s;
  }
  void restore(const State& state);

  /// Moves to the targets of the iterate's model, which are new, or which begin a level.
  void enforce();
  /// Continues a move that limits or contact stopped.
  void move_on();
  /// Near equilibrium under the penalty: moves Dirichlet vertices to their targets if nothing blocks them,
  /// else increases the penalty or declares them infeasible. Begins the penalty if there is none.
  void increase_penalty();

  bool active() const { return !s_.unsatisfied.empty() && !s_.infeasible; }
  /// Whether some targets were found to be out of reach. Their vertices stay fixed where they are.
  bool infeasible() const { return s_.infeasible; }
  /// Whether vertices are held on the way to their targets.
  bool is_moving() const { return active() && !penalty_; }
  bool has_penalty() const { return penalty_ != nullptr; }
  /// Largest distance of a Dirichlet vertex from its target [m].
  double max_violation() const;
  /// "pin 0 stopped 0.012 m short of its target (vertex 7), blocked by …": each pin's farthest vertex.
  std::string message() const;

 private:
  void set_satisfied();
  void update_constraints() { iterate_.set_constraints(fixed_, penalty_.get()); }
  double predict(bool whole, bool with_inertia);
  double move(bool whole);
  Positions displacement_to_targets() const;
  void begin_penalty_unless_moving(double fraction);
  bool note_move(double fraction);
  void begin_penalty();
  void double_penalty();
  void release();
  double violation(int unsatisfied) const;
  double membrane_stiffness() const;  // [N/m]
  double smallest_mass() const;       // of the unsatisfied vertices [kg]
  double patch_width() const;         // of the cloth that one such vertex stands for [m]
  const LevelModel& model() const { return iterate_.model(); }

  Iterate& iterate_;
  NewtonStep& step_;
  bool in_parts_;
  std::vector<char> fixed_;                   // one flag a vertex
  State s_;                                   // all but `released`
  std::unique_ptr<PositionPenalty> penalty_;  // of released vertices, or null
};

}  // namespace drape
