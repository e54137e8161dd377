#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/app/scene/boundary_conditions.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/collision_detection/closest.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

/// The corners of a triangle, one a column.
Eigen::Matrix3d corners_of(const TriangleMesh& mesh, Eigen::Index t) {
  return mesh.vertices(mesh.triangles.row(t), Eigen::all).transpose();
}

/// The axes of a triangle's frame, one a column; not finite for a triangle without area.
Eigen::Matrix3d frame_of(const Eigen::Matrix3d& corners) {
  const Eigen::Vector3d edge = corners.col(1) - corners.col(0);
  const Eigen::Vector3d normal = edge.cross(corners.col(2) - corners.col(0));
  Eigen::Matrix3d axes;
  axes.col(0) = edge / edge.norm();
  axes.col(2) = normal / normal.norm();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

std::string name_of(const std::string& obstacle) { return "obstacle \"" + excerpt(obstacle) + "\""; }

/// An obstacle's triangles that may be followed, for searches of the nearest.
class FollowedSurface {
 public:
  /// Of all triangles, or of those with one of these vertices.
  FollowedSurface(const TriangleMesh& mesh, const std::vector<int>& vertices) : mesh_(mesh) {
    std::vector<char> named(mesh.vertices.rows(), vertices.empty());
    for (const int v : vertices) named[v] = 1;
    for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
      const auto v = mesh.triangles.row(t);
      if (!named[v[0]] && !named[v[1]] && !named[v[2]]) continue;
      const Eigen::Matrix3d corners = corners_of(mesh, t);
      const Eigen::Vector3d centre = corners.rowwise().mean();
      spheres_.push_back({t, centre, (corners.colwise() - centre).colwise().norm().maxCoeff()});
    }
  }

  /// Attaches a vertex with this target to the nearest triangle, the first of equally near ones. Returns its
  /// distance [m]; +∞ without triangles.
  double attach(const Eigen::Vector3d& target, FollowingVertex& vertex) const {
    double least = INFINITY;
    for (const Sphere& sphere : spheres_) {
      if ((target - sphere.centre).norm() - sphere.radius > least) continue;
      const Eigen::Matrix3d corners = corners_of(mesh_, sphere.triangle);
      const Closest closest = closest_point_triangle(target, corners.col(0), corners.col(1), corners.col(2));
      const Eigen::Vector3d weights = -closest.c.tail<3>(), offset = target - corners * weights;
      if (!(offset.norm() < least)) continue;
      least = offset.norm();
      vertex.corners = mesh_.triangles.row(sphere.triangle);
      vertex.first = corners;
      vertex.weights = weights;
      vertex.offset = frame_of(corners).transpose() * offset;
    }
    return least;
  }

 private:
  struct Sphere {
    Eigen::Index triangle;
    Eigen::Vector3d centre;
    double radius;
  };
  const TriangleMesh& mesh_;
  std::vector<Sphere> spheres_;
};

std::string unknown_obstacle(const Experiment& e, const std::string& obstacle) {
  std::vector<std::string> names = e.obstacle_names();
  std::erase(names, "");
  return "does not exist; " +
         did_you_mean(obstacle, names,
                      names.empty() ? "give an obstacle a \"name\", or follow it by its index from 0"
                                    : "the names are " + joined(names));
}

/// The index of the obstacle that a pin follows; none if it follows none, or one that is unknown.
std::optional<std::size_t> followed_by(const Experiment& e, std::size_t pin) {
  const ConfigNode* obstacles = e.resolved.find("obstacles");
  const std::string& named = e.parameters.pins[pin].follow.obstacle;
  return obstacles && !named.empty() ? obstacles->index_of(named) : std::nullopt;
}

/// For each pin that follows, another one that shares vertices with it on a level and does not follow as it
/// does; empty without one. Each is compared with the first that selects the vertex.
std::vector<std::string> conflicts(const Experiment& e, const Level& level, const Level& coarsest) {
  const std::vector<PinParameters>& pins = e.parameters.pins;
  std::vector<std::string> found(pins.size());
  std::vector<int> first(level.vertex_count(), -1);
  std::vector<std::optional<std::size_t>> followed;
  for (std::size_t k = 0; k < pins.size(); ++k) followed.push_back(followed_by(e, k));
  const auto add = [&](int pin, int other, int vertex) {
    if (pins[pin].follow.obstacle.empty() || !found[pin].empty()) return;
    const bool same = followed[pin] == followed[other];
    found[pin] = "pin " + std::to_string(other) + (same ? " follows by other vertices" : " does not follow") +
                 ", but both select vertex " + std::to_string(vertex) + " of level " +
                 std::to_string(level.index) + "; let their regions share no vertex";
  };
  for (int k = 0; k < std::ssize(pins); ++k)
    for (const int v : selected_vertices(pins[k], level, coarsest)) {
      const int j = first[v] < 0 ? first[v] = k : first[v];
      if (followed[j] == followed[k] && pins[j].follow.vertices == pins[k].follow.vertices) continue;
      add(k, j, v);
      add(j, k, v);
    }
  return found;
}

/// Attaches a pin's vertices on one level to the mesh of the obstacle at this place; returns the first fault,
/// empty without one.
std::string attach(const Experiment& e, int pin, const Scene& scene, const LevelModel& model,
                   const TriangleMesh& mesh, Eigen::Index place, const std::string& conflict,
                   FollowingVertices& attached) {
  const FollowParameters& follow = e.parameters.pins[pin].follow;
  const std::vector<TriangleMesh> finest = obstacles_of(scene.models.back()->contacts());
  if (!follow.vertices.empty() && mesh.vertices.rows() != finest[place].vertices.rows())
    return "has cages, which replace it on coarse levels, so \"vertices\" name none of theirs; remove them";
  const ConfigNode& obstacle = e.resolved.find("obstacles")->items[*followed_by(e, pin)];
  const ConfigNode *file = obstacle.find("mesh"), *frames = obstacle.find("animation");
  if (frames && !frames->items.empty()) file = &frames->items[0];
  if (!follow.vertices.empty() && file && !file->scalar.empty() &&
      read_surface(file->scalar).vertices.rows() != mesh.vertices.rows())
    return "loses vertices of its file that are in no triangle, or at the place of others, so \"vertices\" "
           "would name others; remove the former from the file, and join the latter";
  for (const int v : follow.vertices)
    if (v >= mesh.vertices.rows())
      return "has no vertex " + std::to_string(v) + "; they go from 0 to " +
             std::to_string(mesh.vertices.rows() - 1);
  if (!conflict.empty()) return conflict;
  const FollowedSurface surface(mesh, follow.vertices);
  const double size = bounding_box_diagonal(model.level().rest.vertices);
  for (const DirichletVertex& d : model.dirichlet()) {
    if (d.pin != pin) continue;
    FollowingVertex vertex{pin, d.vertex, place, follow.obstacle};
    const double distance = surface.attach(d.target, vertex);
    if (distance > size)
      return "is " + three_digits(distance) + " m away from vertex " + std::to_string(d.vertex) +
             " of level " + std::to_string(model.level().index) +
             ", farther than the cloth is large; place the obstacle or the start so that it is near";
    attached.push_back(std::move(vertex));
  }
  return "";
}

/// The same on every level.
std::string attach(const Experiment& e, const Scene& scene, int pin,
                   const std::vector<std::vector<std::string>>& conflicts,
                   std::vector<FollowingVertices>& levels) {
  const std::string& obstacle = e.parameters.pins[pin].follow.obstacle;
  const std::optional<std::size_t> index = followed_by(e, pin);
  if (!index) return unknown_obstacle(e, obstacle);
  const std::vector<std::size_t> order = e.obstacle_order();
  const Eigen::Index place = std::find(order.begin(), order.end(), *index) - order.begin();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const LevelModel& model = *scene.models[l];
    const std::vector<TriangleMesh> meshes = obstacles_of(model.contacts());
    if (meshes.size() != order.size() || meshes[place].triangles.rows() == 0)
      return "has no surface that a pin can follow: its contact model shows no mesh of it";
    std::string fault = attach(e, pin, scene, model, meshes[place], place, conflicts[l][pin], levels[l]);
    if (!fault.empty()) return fault;
  }
  return "";
}

}  // namespace

std::vector<FollowingVertices> following_vertices(const Experiment& e, const Scene& scene,
                                                  ConfigErrors& errors) {
  std::vector<FollowingVertices> levels(scene.models.size());
  const bool any = std::ranges::any_of(e.parameters.pins,
                                       [](const PinParameters& pin) { return !pin.follow.obstacle.empty(); });
  if (!any) return levels;
  std::vector<std::vector<std::string>> others;  // on each level, for each pin
  for (const Level& level : scene.hierarchy.levels)
    others.push_back(conflicts(e, level, scene.hierarchy.levels[0]));
  for (std::size_t k = 0; k < e.parameters.pins.size(); ++k) {
    const FollowParameters& follow = e.parameters.pins[k].follow;
    if (follow.obstacle.empty()) continue;
    const std::string fault = attach(e, scene, static_cast<int>(k), others, levels);
    if (fault.empty()) continue;
    errors.push_back(
        {e.source.find("pins")->items[k].where_of("follow"),
         "pin " + std::to_string(k) + " follows " + name_of(follow.obstacle) + ", which " + fault});
  }
  return levels;
}

void move_targets(const FollowingVertices& following, const BoundContacts& contacts,
                  std::vector<DirichletVertex>& dirichlet) {
  const std::vector<TriangleMesh> meshes = obstacles_of(contacts);
  for (const FollowingVertex& f : following) {
    const auto d = std::lower_bound(dirichlet.begin(), dirichlet.end(), f.vertex,
                                    [](const DirichletVertex& a, int vertex) { return a.vertex < vertex; });
    if (d == dirichlet.end() || d->vertex != f.vertex || d->pin != f.pin) continue;  // another pin has it now
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error("pin " + std::to_string(f.pin) + " cannot follow " + name_of(f.name) + ": " +
                               what);
    };
    const TriangleMesh& mesh = meshes.at(f.obstacle);
    if (f.corners.maxCoeff() >= mesh.vertices.rows()) fail("it has other triangles than at the start");
    const Eigen::Matrix3d corners = mesh.vertices(f.corners, Eigen::all).transpose();
    if (corners == f.first) continue;
    d->target = corners * f.weights + frame_of(corners) * f.offset;
    if (!d->target.allFinite()) fail("the triangle that its vertex is attached to has no area now");
  }
}

}  // namespace drape
