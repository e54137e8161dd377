#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/numerics/model/level_model.h"
#include "core/numerics/model/position_penalty.h"
#include "core/numerics/step/iterate.h"

namespace drape {

/// Moves the Dirichlet vertices of a level to their targets (supplement, section 4).
///
/// Vertices that a filtered move does not bring to their targets are, under a schedule, held where they are
/// and moved again after further steps. Where moves gain nothing, or without a schedule, they are released,
/// and a penalty κ_B/2 m_k ‖x_k − x̃_k‖² pulls them. κ_B doubles while that reduces the distance. Once all
/// targets are reached the vertices are fixed and the penalty is dropped.
class DirichletEnforcer {
 public:
  /// Refers to the iterate. Once that has the model of another load, call begin(), which finds the targets
  /// that x has not reached.
  explicit DirichletEnforcer(const Iterate& iterate) : iterate_(iterate), fixed_(model().fixed()) {}

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
    s.released = penalty_ != nullptr;
    return s;
  }
  void restore(const State& state);

  /// Starts over at x: the model has new targets, or a new level begins.
  void begin();
  /// n×3 [m]: from x to the targets for vertices that are not there, zero elsewhere.
  Positions displacement_to_targets() const;
  bool active() const { return !s_.unsatisfied.empty() && !s_.infeasible; }
  /// Whether some targets were found to be out of reach. Their vertices stay fixed where they are.
  bool infeasible() const { return s_.infeasible; }

  /// Whether vertices are held on the way to their targets.
  bool is_moving() const { return active() && !penalty_; }
  /// Records a move by this fraction of the way that remained. Returns false once moves have long gained
  /// nothing.
  bool note_move(double fraction);

  /// Records that x has been set to all targets: fixes all Dirichlet vertices and drops the penalty.
  void set_satisfied();
  /// Releases the unsatisfied vertices and adds the penalty.
  void begin_penalty();
  /// Doubles the penalty. Once doublings have long stopped reducing the distance, fixes the vertices where
  /// they are instead: the targets are infeasible.
  void increase_penalty();

  /// One flag a vertex: 1 where it is fixed now.
  const std::vector<char>& fixed() const { return fixed_; }
  /// The penalty; null where there is none.
  const BoundEnergy* penalty() const { return penalty_.get(); }
  /// Largest distance of a Dirichlet vertex from its target [m].
  double max_violation() const;
  /// "pin 0 stopped 0.012 m short of its target (vertex 7), blocked by …": each pin's farthest vertex.
  std::string message() const;

 private:
  /// Releases the unsatisfied vertices to a penalty of the present stiffness.
  void release();
  double violation(int unsatisfied) const;
  double membrane_stiffness() const;  // [N/m]
  double smallest_mass() const;       // of the unsatisfied vertices [kg]
  double patch_width() const;         // of the cloth that one such vertex stands for [m]

  const LevelModel& model() const { return iterate_.model(); }

  const Iterate& iterate_;
  std::vector<char> fixed_;
  State s_;                                   // all but `released`
  std::unique_ptr<PositionPenalty> penalty_;  // of released vertices
};

}  // namespace drape
