#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/box_tree.h"
#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh/unjoined_borders.h"

namespace drape {
namespace {

using Eigen::Vector3d;

/// Distances from a line below this part of an edge's length are the rounding of a file's numbers.
constexpr double on_line = 1e-4;

/// A border edge with its triangle's corner opposite.
struct BorderEdge : HalfEdge {
  int opposite;
};

/// The search within a connected part of a mesh, by its border edges.
class JunctionSearch {
 public:
  JunctionSearch(const Positions& x, const std::vector<BorderEdge>& edges) : x_(x) {
    for (const BorderEdge& e : edges)
      for (const int v : {e.from, e.to}) edges_at_[v].push_back(&e);
    std::vector<Box> boxes;
    for (const auto& [v, own] : edges_at_) {
      vertices_.push_back(v);
      boxes.push_back(Box::around(at(v), at(v), 0));
    }
    tree_.build(boxes);
  }

  void find(const BorderEdge& e, std::vector<TJunction>& found) const {
    const Vector3d along = at(e.to) - at(e.from);
    const double reach = 2 * on_line * along.norm();
    const auto distance = [&](const Box& box) {
      const Vector3d to = box.centre() - at(e.from);
      return (to - std::clamp(to.dot(along) / along.squaredNorm(), 0.0, 1.0) * along).norm() - box.radius();
    };
    tree_.visit_near(reach, distance, [&](int i) {
      const int v = vertices_[i];
      if (is_inside(v, e) && has_neighbour_across(v, e)) found.push_back({v, {e.from, e.to}});
      return reach;
    });
  }

 private:
  Vector3d at(int v) const { return x_.row(v); }
  Vector3d off_line(const BorderEdge& e, int v) const {
    const Vector3d along = (at(e.to) - at(e.from)).normalized(), to = at(v) - at(e.from);
    return to - to.dot(along) * along;
  }
  bool is_inside(int v, const BorderEdge& e) const {
    if (v == e.from || v == e.to) return false;
    const Vector3d along = at(e.to) - at(e.from);
    const double length = along.norm(), part = along.dot(at(v) - at(e.from)) / length;
    return part > on_line * length && part < (1 - on_line) * length &&
           off_line(e, v).norm() <= on_line * length;
  }
  /// Whether one of v's border edges runs along e, with its triangle on the other side. On the same side two
  /// layers lie on one another.
  bool has_neighbour_across(int v, const BorderEdge& e) const {
    return std::ranges::any_of(edges_at_.at(v), [&](const BorderEdge* own) {
      const int end = own->from == v ? own->to : own->from;
      const double length = (at(end) - at(v)).norm();
      return off_line(e, end).norm() <= on_line * length &&
             off_line(e, own->opposite).dot(off_line(e, e.opposite)) < 0;
    });
  }

  const Positions& x_;
  std::map<int, std::vector<const BorderEdge*>> edges_at_;  // of each border vertex
  std::vector<int> vertices_;
  BoxTree tree_;  // of these
};

}  // namespace

std::vector<TJunction> t_junctions(const TriangleMesh& mesh) {
  const std::vector<int> part_of = connected_parts(mesh);
  std::map<int, std::vector<BorderEdge>> parts;
  for (const int h : border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows())))
    parts[part_of[h / 3]].push_back({HalfEdge::of(mesh.triangles, h), mesh.triangles(h / 3, h % 3)});
  std::vector<TJunction> found;
  for (const auto& [part, edges] : parts) {
    const JunctionSearch search(mesh.vertices, edges);
    for (const BorderEdge& e : edges) search.find(e, found);
  }
  std::ranges::sort(found, {}, [](const TJunction& j) { return std::pair(j.vertex, j.edge); });
  return found;
}

}  // namespace drape
