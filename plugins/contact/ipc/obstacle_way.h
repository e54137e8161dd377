#pragma once

#include <string>
#include <vector>

#include "core/contact/broad_phase.h"
#include "plugins/contact/ipc/candidates.h"

namespace drape {

/// A piece of the way of obstacles: each vertex's own coordinates change linearly, and so do the numbers of
/// its pose. Times within it are from 0 to 1.
struct Leg {
  struct Body {
    bool moves = false;
    Pose from, to;
    Eigen::Matrix3d turn;  ///< of `from`
  };
  std::vector<Body> bodies;
  Positions own_from, own_to;  ///< of all bodies
  Positions from, to;          ///< in the world
  double off_chord = 0;        ///< how far a vertex may be from the straight line between those [m]

  Eigen::Matrix3d linear(int body, double time) const;
  Eigen::Vector3d translate(int body, double time) const;
  /// Bounds |p''| of a vertex (acceleration by time within the leg) [m].
  double bend(int body, int vertex) const;
};

/// How obstacles come from one place to another: their parameters change linearly.
class ObstacleWay {
 public:
  /// Throws std::runtime_error naming an obstacle whose mesh is another one.
  ObstacleWay(const Obstacles& before, const Obstacles& after);

  bool is_still() const;
  /// From time `begin` towards `end`: as far as everything is linear and turns by a tenth of a radian at
  /// most.
  double leg_end(double begin, double end) const;
  Leg leg(double begin, double end) const;

  /// How far along the way the cloth at x stays apart from the obstacles (core/contact/bent_advance.h says by
  /// what). In the answer's words the name of what is in the way.
  StepLimit max_move(const Surface& cloth, const Positions& x, double range,
                     BroadPhaseKind broad_phase) const;

 private:
  struct Search;
  bool find(const Leg& leg, Search& search, long limit) const;
  double smallest_gap(Search& search) const;
  StepLimit advance(Search& search, double kept, int rounds) const;

  const Obstacles &before_, &after_;
  std::vector<char> moves_;
};

/// "cloth vertex 3 and ball triangle 4–5–6".
std::string name_of(const ContactPair& pair, const Obstacles& obstacles, int cloth_vertices);

}  // namespace drape
