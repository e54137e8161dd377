#pragma once

#include <string>
#include <vector>

#include "core/model/level_model.h"
#include "core/model/position_penalty.h"

namespace drape {

/// Brings held vertices of a level to places where they are not (supplement, section 4): those that a
/// filtered move does not bring there are let go and pulled by a penalty κ_B/2 m_k ‖x_k − x̃_k‖², κ_B doubled
/// while that helps; once all have arrived they are fixed and the penalty is dropped.
class HardPositions {
 public:
  explicit HardPositions(const LevelModel& model) : model_(model) { fixed_ = model.fixed(); }

  /// All that does not follow from the model.
  struct Memory {
    std::vector<int> missing;
    double stiffness = 0, best = 0;
    int idle = 0;
    bool given_up = false, pulled = false;
    std::string held_by;
  };
  Memory memory() const {
    return {missing_, stiffness_, best_, idle_, given_up_, penalty_ != nullptr, held_by_};
  }
  void restore(const Memory& memory);

  /// The model has other places, or a new level begins at x.
  void begin(const Positions& x);
  /// n×3: from x to the places, of the vertices that are not there; zero elsewhere.
  Positions way(const Positions& x) const;
  /// Whether all are there, or were given up where they are.
  bool settled() const { return missing_.empty() || given_up_; }
  bool pulling() const { return !missing_.empty() && !given_up_; }
  bool given_up() const { return given_up_; }

  /// All have arrived: x has been put on their places.
  void arrive();
  /// Lets those that are missing go, and pulls them; `held_by` kept them from being moved there, and may be
  /// empty.
  void pull(const std::string& held_by);
  /// Pulls twice as hard; false, with them fixed where they are, once that has long ceased to help.
  bool pull_harder(const Positions& x, const std::string& held_by);

  /// One flag a vertex: 1 where it is fixed now.
  const std::vector<char>& fixed() const { return fixed_; }
  /// What pulls; null where nothing does.
  const BoundEnergy* penalty() const { return penalty_.get(); }
  /// Largest distance from x to a place [m].
  double farthest(const Positions& x) const;
  /// "pin 0 stopped 0.012 m short of its place (vertex 7)", the farthest of each pin, and what held them.
  std::string message(const Positions& x) const;

 private:
  void let_go();
  double distance(const Positions& x, int missing) const;
  void make_penalty();
  double membrane() const;    // stiffness in its plane [N/m]
  double least_mass() const;  // of the vertices that are missing [kg]
  double width() const;       // of the cloth that goes with it [m]

  const LevelModel& model_;
  std::vector<char> fixed_;
  std::vector<int> missing_;  // indices into model_.held()
  std::unique_ptr<PositionPenalty> penalty_;
  double stiffness_ = 0;  // κ_B [1/s²]
  double best_ = 0;       // distance when pulling harder last helped
  int idle_ = 0;          // doublings since
  bool given_up_ = false;
  std::string held_by_;
};

}  // namespace drape
