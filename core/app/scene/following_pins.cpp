#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "core/app/scene/boundary_conditions.h"
#include "core/app/scene/vertex_search.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/collision_detection/surface_search.h"
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

/// An obstacle's mesh on a level, for searches of the nearest triangle.
struct FollowedSurface {
  explicit FollowedSurface(const TriangleMesh& mesh) : mesh(mesh), all(mesh) {
    around = AdjacencyList::of(static_cast<int>(mesh.vertices.rows()), [&](const auto& add) {
      for (int t = 0; t < mesh.triangles.rows(); ++t)
        for (int k = 0; k < 3; ++k) add(mesh.triangles(t, k), t);
    });
  }

  /// Attaches a vertex with this target to the nearest triangle of the search. Returns its distance [m].
  double attach(const SurfaceSearch& search, const Eigen::Vector3d& target, FollowingVertex& vertex) const {
    const NearestPoint near = search.nearest(target);
    if (near.triangle < 0) return INFINITY;
    vertex.corners = mesh.triangles.row(near.triangle);
    vertex.first = corners_of(mesh, near.triangle);
    vertex.weights = near.weights;
    vertex.offset = frame_of(vertex.first).transpose() * near.offset;
    return near.offset.norm();
  }

  /// The search among the triangles that have one of these vertices.
  SurfaceSearch part(const std::vector<int>& vertices) const {
    std::vector<int> triangles;
    for (const int v : vertices)
      for (const int t : around.row(v)) triangles.push_back(t);
    std::ranges::sort(triangles);
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return {mesh, std::move(triangles)};
  }

  const TriangleMesh& mesh;
  SurfaceSearch all;
  AdjacencyList around;  // of each vertex its triangles
};

std::string unknown_obstacle(const Experiment& e, const std::string& obstacle) {
  std::vector<std::string> names = e.obstacle_names();
  std::erase(names, "");
  return "does not exist; " +
         did_you_mean(obstacle, names,
                      names.empty() ? "give an obstacle a \"name\", or follow it by its index from 0"
                                    : "the names are " + listed(names));
}

/// For each pin the index of the obstacle that it follows; none if it follows none, or one that is unknown.
std::vector<std::optional<std::size_t>> followed_by_pins(const Experiment& e) {
  const ConfigNode* obstacles = e.resolved.find("obstacles");
  std::map<std::string, std::optional<std::size_t>> known;  // a list of many is searched once for each name
  std::vector<std::optional<std::size_t>> followed;
  for (const PinParameters& pin : e.parameters.pins) {
    const auto [name, is_new] = known.try_emplace(pin.follow.obstacle);
    if (is_new && obstacles && !name->first.empty()) name->second = obstacles->index_of(name->first);
    followed.push_back(name->second);
  }
  return followed;
}

/// For each pin that follows, another one that shares vertices with it on a level and does not follow as it
/// does; empty without one. Each is compared with the first that selects the vertex.
std::vector<std::string> conflicts(const Experiment& e,
                                   const std::vector<std::optional<std::size_t>>& followed,
                                   const Level& level, const Level& coarsest) {
  const std::vector<PinParameters>& pins = e.parameters.pins;
  std::vector<std::string> found(pins.size());
  std::vector<int> first(level.vertex_count(), -1);
  const auto add = [&](int pin, int other, int vertex) {
    if (pins[pin].follow.obstacle.empty() || !found[pin].empty()) return;
    const bool same = followed[pin] == followed[other];
    found[pin] = "pin " + std::to_string(other) + (same ? " follows by other vertices" : " does not follow") +
                 ", but both select vertex " + std::to_string(vertex) + " of level " +
                 std::to_string(level.index) + "; let their regions share no vertex";
  };
  const VertexSearch search(level, coarsest, pins.size());
  for (int k = 0; k < std::ssize(pins); ++k)
    for (const int v : search.selected(pins[k])) {
      const int j = first[v] < 0 ? first[v] = k : first[v];
      if (followed[j] == followed[k] && pins[j].follow.vertices == pins[k].follow.vertices) continue;
      add(k, j, v);
      add(j, k, v);
    }
  return found;
}

/// Attaches pins to the obstacles that they follow.
class Follower {
 public:
  Follower(const Experiment& e, const Scene& scene)
      : e_(e), scene_(scene), order_(e.obstacle_order()), followed_(followed_by_pins(e)) {
    for (const Level& level : scene.hierarchy.levels)
      conflicts_.push_back(conflicts(e, followed_, level, scene.hierarchy.levels[0]));
    for (const auto& model : scene.models) {
      meshes_.push_back(model->obstacles());
      std::vector<std::vector<DirichletVertex>>& own = held_.emplace_back(e.parameters.pins.size());
      for (const DirichletVertex& d : model->dirichlet()) own[d.pin].push_back(d);
    }
  }

  /// Attaches a pin's vertices on every level; returns the first fault, empty without one.
  std::string attach(int pin, std::vector<FollowingVertices>& levels) {
    const std::string& obstacle = e_.parameters.pins[pin].follow.obstacle;
    const std::optional<std::size_t> index = followed_[pin];
    if (!index) return unknown_obstacle(e_, obstacle);
    const Eigen::Index place = std::ranges::find(order_, *index) - order_.begin();
    for (std::size_t l = 0; l < levels.size(); ++l) {
      if (meshes_[l].size() != order_.size() || meshes_[l][place].triangles.rows() == 0)
        return "has no surface that a pin can follow: its contact model shows no mesh of it";
      std::string fault = attach(pin, l, place, levels[l]);
      if (!fault.empty()) return fault;
    }
    return "";
  }

 private:
  std::string attach(int pin, std::size_t l, Eigen::Index place, FollowingVertices& attached) {
    const FollowParameters& follow = e_.parameters.pins[pin].follow;
    const TriangleMesh& mesh = meshes_[l][place];
    if (!follow.vertices.empty() && mesh.vertices.rows() != meshes_.back()[place].vertices.rows())
      return "has cages, which replace it on coarse levels, so \"vertices\" name none of theirs; remove them";
    if (!follow.vertices.empty() && vertices_of_file(pin, mesh) != mesh.vertices.rows())
      return "loses vertices of its file that are in no triangle, or at the place of others, so \"vertices\" "
             "would name others; remove the former from the file, and join the latter";
    for (const int v : follow.vertices)
      if (v >= mesh.vertices.rows())
        return "has no vertex " + std::to_string(v) + "; they go from 0 to " +
               std::to_string(mesh.vertices.rows() - 1);
    if (!conflicts_[l][pin].empty()) return conflicts_[l][pin];
    const FollowedSurface& surface = surfaces_.try_emplace({l, place}, mesh).first->second;
    const SurfaceSearch part = surface.part(follow.vertices),
                        &search = follow.vertices.empty() ? surface.all : part;
    const LevelModel& model = *scene_.models[l];
    const double size = bounding_box_diagonal(model.level().rest.vertices);
    for (const DirichletVertex& d : held_[l][pin]) {
      FollowingVertex vertex{pin, d.vertex, place, follow.obstacle};
      const double distance = surface.attach(search, d.target, vertex);
      if (distance > size)
        return "is " + three_digits(distance) + " m away from vertex " + std::to_string(d.vertex) +
               " of level " + std::to_string(model.level().index) +
               ", farther than the cloth is large; place the obstacle or the start so that it is near";
      attached.push_back(std::move(vertex));
    }
    return "";
  }

  /// The number of vertices in the file of the obstacle that the pin follows; without one, that of its mesh.
  Eigen::Index vertices_of_file(int pin, const TriangleMesh& mesh) {
    const ConfigNode& obstacle = e_.resolved.find("obstacles")->items[*followed_[pin]];
    const ConfigNode *file = obstacle.find("mesh"), *frames = obstacle.find("animation");
    if (frames && !frames->items.empty()) file = &frames->items[0];
    if (!file || file->scalar.empty()) return mesh.vertices.rows();
    const auto [known, is_new] = in_files_.try_emplace(file->scalar, 0);
    if (is_new) known->second = read_surface(file->scalar).vertices.rows();
    return known->second;
  }

  const Experiment& e_;
  const Scene& scene_;
  const std::vector<std::size_t> order_;
  const std::vector<std::optional<std::size_t>> followed_;
  // On each level: for each pin another one that wants its vertices elsewhere, the obstacles' meshes, and the
  // vertices that each pin holds.
  std::vector<std::vector<std::string>> conflicts_;
  std::vector<std::vector<TriangleMesh>> meshes_;
  std::vector<std::vector<std::vector<DirichletVertex>>> held_;
  std::map<std::pair<std::size_t, Eigen::Index>, FollowedSurface> surfaces_;  // of a level and an obstacle
  std::map<std::string, Eigen::Index> in_files_;
};

}  // namespace

std::vector<FollowingVertices> following_vertices(const Experiment& e, const Scene& scene,
                                                  ConfigErrors& errors) {
  std::vector<FollowingVertices> levels(scene.models.size());
  const bool any = std::ranges::any_of(e.parameters.pins,
                                       [](const PinParameters& pin) { return !pin.follow.obstacle.empty(); });
  if (!any) return levels;
  Follower follower(e, scene);
  for (std::size_t k = 0; k < e.parameters.pins.size(); ++k) {
    const FollowParameters& follow = e.parameters.pins[k].follow;
    if (follow.obstacle.empty()) continue;
    const std::string fault = follower.attach(static_cast<int>(k), levels);
    if (fault.empty()) continue;
    errors.push_back(
        {e.source.find("pins")->items[k].where_of("follow"),
         "pin " + std::to_string(k) + " follows " + name_of(follow.obstacle) + ", which " + fault});
  }
  return levels;
}

void move_targets(const FollowingVertices& following, const std::vector<TriangleMesh>& obstacles,
                  std::vector<DirichletVertex>& dirichlet) {
  for (const FollowingVertex& f : following) {
    const auto d = std::lower_bound(dirichlet.begin(), dirichlet.end(), f.vertex,
                                    [](const DirichletVertex& a, int vertex) { return a.vertex < vertex; });
    if (d == dirichlet.end() || d->vertex != f.vertex || d->pin != f.pin) continue;  // another pin has it now
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error("pin " + std::to_string(f.pin) + " cannot follow " + name_of(f.name) + ": " +
                               what);
    };
    const TriangleMesh& mesh = obstacles.at(f.obstacle);
    if (f.corners.maxCoeff() >= mesh.vertices.rows()) fail("it has other triangles than at the start");
    const Eigen::Matrix3d corners = mesh.vertices(f.corners, Eigen::all).transpose();
    if (corners == f.first) continue;
    d->target = corners * f.weights + frame_of(corners) * f.offset;
    if (!d->target.allFinite()) fail("the triangle that its vertex is attached to has no area now");
  }
}

}  // namespace drape
