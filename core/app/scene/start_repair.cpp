#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "core/app/files/yaml_file.h"
#include "core/app/scene/crossed_parts.h"
#include "core/app/scene/scene.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/model/required.h"

namespace drape {

namespace {

using Eigen::Vector3d;

/// A start with a smaller gap is moved too, although nothing intersects [m].
constexpr double tiny_gap = 1e-6;
/// Trial distances, relative to the cloth's diagonal, in a geometric series.
constexpr double shortest_part = 1e-3, growth = 1.5;
/// The farthest that a start is moved, over its depth in an obstacle and its longest edge.
constexpr double reach = 2;
/// Bisections of the first free translation, to move no further than necessary.
constexpr int halvings = 5;

/// Intersections and gaps of the translated start.
struct Clearance {
  std::vector<Intersection> intersections;  ///< of the first level with any; the rest is then unknown
  int level = 0;                            ///< that level
  int contacts = 0;                         ///< pairs within d̂, on all levels
  double smallest_gap = std::numeric_limits<double>::infinity();
};

/// The gaps of a level's obstacles, in their order.
std::vector<double> gaps_at(const LevelModel& model, const Positions& x) {
  std::vector<double> gaps;
  for (const auto& contact : model.contacts())
    for (const ObstacleGap& obstacle : contact->obstacle_gaps(x)) gaps.push_back(obstacle.gap);
  return gaps;
}

/// Searches for a translation of the start without intersections.
class TranslationSearch {
 public:
  explicit TranslationSearch(const Scene& scene)
      : scene_(scene),
        diagonal_(bounding_box_diagonal(scene.starts[0])),
        points_(scene.starts[0](components(scene.hierarchy.levels[0].topology), Eigen::all)),
        obstacles_(scene.model(0)->obstacles()),
        crossed_(scene.hierarchy.levels[0], scene.starts[0], obstacles_,
                 gaps_at(*scene.model(0), scene.starts[0])) {
    const Level& level = scene.hierarchy.levels[0];
    for (const auto& edge : level.topology.edges.rowwise())
      longest_edge_ =
          std::max(longest_edge_, (scene.starts[0].row(edge[0]) - scene.starts[0].row(edge[1])).norm());
    limit_ = std::min(diagonal_, reach * (crossed_.depth() + longest_edge_));
    start = persistent_ = clearance_at(Vector3d::Zero());
    found = start.intersections.empty();
    best_contacts_ = start.contacts;
  }

  Clearance start;
  bool found = false;
  Vector3d translation = Vector3d::Zero();

  void run() {
    for (const Vector3d& direction :
         {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)})
      search(direction);
    for (const Vector3d& direction : {Vector3d(0, 0, -1), crossed_.way_out()})
      if (translation.isZero(0)) search(direction);
  }

  /// Why run() has found none.
  std::string failure() const {
    const std::string attempt = "moving the whole start by up to " + three_digits(limit_) + " m";
    const std::string level = " on level " + std::to_string(start.level);
    const std::string remedy = "; change the start's shape or place, or the obstacle";
    if (const auto& pairs = persistent_.intersections; !pairs.empty() && !is_across_)
      return attempt + " does not part " + to_string(pairs[0]) + level + remedy;
    return attempt +
           (is_across_ ? " frees it only across an obstacle, to another side of that"
                       : " finds no position without intersections") +
           "; at the start these intersect: " + to_string(start.intersections[0]) + level + remedy;
  }

 private:
  void search(const Vector3d& direction) {
    double before = 0;
    for (double part = shortest_part; before < limit_; part *= growth) {
      const double distance = std::min(part * diagonal_, limit_);
      // No shorter way with fewer contacts can follow.
      if (best_contacts_ == 0 && found && distance >= translation.norm() && !translation.isZero(0)) return;
      if (is_better(distance * direction)) shorten(direction, before, distance);
      before = distance;
    }
  }

  Clearance clearance_at(const Vector3d& translation) const {
    Clearance clearance;
    for (std::size_t l = 0; l < scene_.starts.size(); ++l) {
      const Positions x = scene_.starts[l].rowwise() + translation.transpose();
      clearance.level = static_cast<int>(l);
      for (const auto& contact : scene_.model(static_cast<int>(l))->contacts()) {
        clearance.intersections = contact->intersections(x);
        if (!clearance.intersections.empty()) return clearance;
        const auto near = collisions_at(*contact, x);
        clearance.contacts += near->contact_count();
        clearance.smallest_gap = std::min(clearance.smallest_gap, near->smallest_gap());
      }
    }
    return clearance;
  }

  /// Whether a component of the cloth lies inside an obstacle without intersecting it. What faces inwards may
  /// be a room, if the cloth starts in it.
  bool enclosed(const Vector3d& trial) const {
    const Positions points = points_.rowwise() + trial.transpose();
    return std::ranges::any_of(obstacles_, [&](const TriangleMesh& mesh) {
      return is_inside(points, mesh) || (is_inside(points, mesh, true) && !is_inside(points_, mesh, true));
    });
  }

  /// Accepts a translation without intersections if it has fewer contacts than any before, or as few and is
  /// shorter. It must not lead across an obstacle.
  bool is_better(const Vector3d& trial) {
    Clearance clearance = clearance_at(trial);
    if (!clearance.intersections.empty()) {
      intersect_persistent(std::move(clearance));
      return false;
    }
    if (found && (clearance.contacts > best_contacts_ ||
                  (clearance.contacts == best_contacts_ && trial.norm() >= translation.norm())))
      return false;
    if (enclosed(trial)) return false;
    if (crossed_.lead_across(trial, longest_edge_)) {
      is_across_ = true;
      return false;
    }
    found = true;
    best_contacts_ = clearance.contacts;
    translation = trial;
    return true;
  }

  void shorten(const Vector3d& direction, double low, double high) {
    for (int k = 0; k < halvings; ++k) {
      const double middle = 0.5 * (low + high);
      (is_better(middle * direction) ? high : low) = middle;
    }
  }

  void intersect_persistent(Clearance other) {
    if (other.level != persistent_.level) return;  // the triangles of another level are not comparable
    const auto names = [](const Intersection& pair) { return std::tie(pair.first, pair.second); };
    std::ranges::sort(other.intersections, {}, names);
    std::erase_if(persistent_.intersections, [&](const Intersection& pair) {
      return !std::ranges::binary_search(other.intersections, names(pair), {}, names);
    });
  }

  const Scene& scene_;
  const double diagonal_;   // of the coarsest level's start [m]
  const Positions points_;  // at the start, a vertex of each component
  const std::vector<TriangleMesh> obstacles_;
  const CrossedParts crossed_;
  double longest_edge_ = 0;  // of the coarsest level's start [m]
  double limit_ = 0;         // of translations [m]
  bool is_across_ = false;   // a translation failed by CrossedParts::lead_across only
  Clearance persistent_;     // with the pairs that intersected initially and after every trial
  int best_contacts_ = 0;
};

}  // namespace

double winding_number(const TriangleMesh& mesh, const Vector3d& p) {
  double angle = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    Vector3d c[3];
    for (int k = 0; k < 3; ++k) c[k] = mesh.vertices.row(mesh.triangles(t, k)).transpose() - p;
    const double l0 = c[0].norm(), l1 = c[1].norm(), l2 = c[2].norm();
    angle += 2 * std::atan2(c[0].dot(c[1].cross(c[2])),
                            l0 * l1 * l2 + c[0].dot(c[1]) * l2 + c[1].dot(c[2]) * l0 + c[2].dot(c[0]) * l1);
  }
  return angle / (4 * M_PI);
}

std::vector<char> are_inside(const Positions& points, const TriangleMesh& mesh, bool facing_inwards) {
  std::vector<char> inside;
  const Eigen::RowVector3d lower = mesh.vertices.colwise().minCoeff(),
                           upper = mesh.vertices.colwise().maxCoeff();
  for (const auto& p : points.rowwise())
    inside.push_back((p.array() >= lower.array()).all() && (p.array() <= upper.array()).all());
  if (std::ranges::count(inside, 1) == 0) return inside;
  // What is open encloses what it surrounds almost wholly, as a scan with holes does: a cloth may lie in a
  // bowl.
  const bool open = !border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows())).empty();
  const double enclosed = open ? 0.9 : 0.5;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (inside[i])
      inside[i] = (facing_inwards ? -1 : 1) * winding_number(mesh, points.row(i).transpose()) > enclosed;
  return inside;
}

bool is_inside(const Positions& points, const TriangleMesh& mesh, bool facing_inwards) {
  return std::ranges::any_of(are_inside(points, mesh, facing_inwards), std::identity());
}

Vector3d repair_start(Experiment& experiment, const Scene& scene, ConfigErrors& errors) {
  TranslationSearch search(scene);
  const Clearance& start = search.start;
  const Location& where = experiment.location_of("start");
  const bool intersects = !start.intersections.empty();
  if (!intersects && !(start.smallest_gap < tiny_gap)) return Vector3d::Zero();
  const int level = start.level;
  if (touches_itself(start.intersections)) {  // which no translation mends
    refuse_intersecting_start(experiment, *scene.model(level), scene.starts[level], errors);
    return Vector3d::Zero();
  }
  if (!experiment.parameters.pins.empty()) {
    if (intersects)
      errors.push_back({where, "the start of level " + std::to_string(start.level) +
                                   " touches: " + to_string(start.intersections[0]) +
                                   "; a cloth with pins is not moved: move the pins or the obstacle"});
    return Vector3d::Zero();
  }
  search.run();
  if (!search.found) errors.push_back({where, search.failure()});
  if (!search.found || search.translation.isZero(0)) return Vector3d::Zero();
  experiment.parameters.start.translate += search.translation;
  set_path(experiment.resolved, "start", *node_of(experiment.parameters).find("start"));
  return search.translation;
}

}  // namespace drape
