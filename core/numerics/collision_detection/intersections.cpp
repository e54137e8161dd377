#include "core/numerics/collision_detection/intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <array>
#include <stdexcept>
#include <string>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/broad_phase.h"

namespace drape {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Eigen::Vector3d;

constexpr int triangles_per_task = 256;

/// The corners of a triangle, those that it shares with another one first.
using Corners = std::array<Vector, 3>;

Point point(const Vector& p) { return {p.x(), p.y(), p.z()}; }
Kernel::Triangle_3 triangle(const Corners& c) { return {point(c[0]), point(c[1]), point(c[2])}; }

/// The pair shares corners 0 and 1.
bool overlap_beside_edge(const Corners& a, const Corners& b) {
  const Vector edge = (a[1] - a[0]).normalized();
  const Vector u = a[2] - a[0], v = b[2] - b[0];
  const Vector across_u = u - edge.dot(u) * edge, across_v = v - edge.dot(v) * edge;
  // Unfolded by more than a right angle, beyond round-off: most pairs of a mesh. Without this shortcut the
  // coplanar pairs of a flat but tilted mesh need exact arithmetic.
  if (across_u.dot(across_v) < -1e-6 * u.norm() * v.norm()) return false;
  const Point p = point(a[0]), q = point(a[1]), r = point(a[2]), s = point(b[2]);
  return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
}

/// The pair shares corner 0.
bool meet_beside_vertex(const Corners& a, const Corners& b) {
  const Vector a1 = (a[1] - a[0]).normalized(), a2 = (a[2] - a[0]).normalized();
  const Vector b1 = (b[1] - b[0]).normalized(), b2 = (b[2] - b[0]).normalized();
  // On opposite sides of a plane through the corner, beyond round-off.
  const Vector n = a1 + a2 - b1 - b2;
  if (std::min(n.dot(a1), n.dot(a2)) > 1e-6 && std::max(n.dot(b1), n.dot(b2)) < -1e-6) return false;
  return CGAL::do_intersect(triangle(a), Kernel::Segment_3(point(b[1]), point(b[2]))) ||
         CGAL::do_intersect(triangle(b), Kernel::Segment_3(point(a[1]), point(a[2])));
}

bool has_no_area(const Corners& c) { return CGAL::collinear(point(c[0]), point(c[1]), point(c[2])); }

/// A degenerate triangle touches a neighbour's corner or edge; CGAL's predicates exclude it.
bool meet(const Corners& a, const Corners& b, int shared) {
  if (has_no_area(a) || has_no_area(b)) return true;
  if (shared == 3) return true;
  if (shared == 2) return overlap_beside_edge(a, b);
  if (shared == 1) return meet_beside_vertex(a, b);
  return CGAL::do_intersect(triangle(a), triangle(b));
}

Corners corners(const Positions& x, const std::array<int, 3>& v) {
  return {x.row(v[0]), x.row(v[1]), x.row(v[2])};
}
std::array<int, 3> vertices(const TriangleMesh& mesh, int t) {
  return {mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)};
}

/// Moves shared vertices to the front, in the same order, and returns their number.
int share_first(std::array<int, 3>& a, std::array<int, 3>& b) {
  int shared = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = shared; j < 3; ++j)
      if (a[i] == b[j]) {
        std::swap(a[i], a[shared]);
        std::swap(b[j], b[shared]);
        ++shared;
        break;
      }
  return shared;
}

/// Relative to `origin`: a box has floats, which are fine near it alone.
Box box_of(const TriangleMesh& mesh, int t, const Vector& origin) {
  Box box;
  for (const int v : vertices(mesh, t)) {
    const Vector at = mesh.vertices.row(v).transpose() - origin;
    box.include(Box::around(at, at, 0));
  }
  return box;
}

Vector middle_of_both(const Box& a, const Box& b) {
  Vector p;
  for (int k = 0; k < 3; ++k)
    p[k] = 0.5 * (std::max(a.lower[k], b.lower[k]) + std::min(a.upper[k], b.upper[k]));
  return p;
}

std::vector<TrianglePair> meeting(const TriangleMesh& mesh, const TriangleMesh& other, bool same,
                                  const AdjacencyList& candidates) {
  const int count = static_cast<int>(mesh.triangles.rows());
  const auto test = [&](int begin, int end, std::vector<TrianglePair>& found) {
    for (int s = begin; s < end; ++s)
      for (const int t : candidates.row(s)) {
        std::array<int, 3> a = vertices(mesh, s), b = vertices(other, t);
        const int shared = same ? share_first(a, b) : 0;
        if (!meet(corners(mesh.vertices, a), corners(other.vertices, b), shared)) continue;
        const Vector near = mesh.vertices.row(a[0]);
        found.push_back({s, t, near + middle_of_both(box_of(mesh, s, near), box_of(other, t, near))});
      }
  };
  return parallel_collect<TrianglePair>(count, triangles_per_task, test);
}

/// Its boxes are relative to the first vertex of `from`.
std::unique_ptr<BroadPhase> broad_phase_of(const TriangleMesh& mesh, const TriangleMesh& from) {
  const Vector origin = from.vertices.rows() > 0 ? Vector(from.vertices.row(0)) : Vector(Vector::Zero());
  std::vector<Box> boxes(mesh.triangles.rows());
  parallel_for(static_cast<int>(boxes.size()), triangles_per_task, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) boxes[t] = box_of(mesh, t, origin);
  });
  auto phase = make_broad_phase(BroadPhaseKind::bvh);
  phase->update(boxes);
  return phase;
}

/// The pairs of triangles whose boxes overlap. A mesh without crossings has some tens for each triangle.
AdjacencyList near_pairs(const TriangleMesh& mesh, const TriangleMesh& other, bool same) {
  const long most = 2'000'000 + 100 * (mesh.triangles.rows() + (same ? 0 : other.triangles.rows()));
  AdjacencyList candidates;
  const auto own = broad_phase_of(mesh, mesh);
  if (own->overlaps(same ? *own : *broad_phase_of(other, mesh), most, candidates)) return candidates;
  throw std::runtime_error("more than " + std::to_string(most) +
                           " pairs of triangles lie across or beside one another: too many to look for "
                           "crossings; take a mesh whose triangles do not crowd or cross");
}

}  // namespace

std::vector<TrianglePair> self_intersections(const TriangleMesh& mesh) {
  return meeting(mesh, mesh, true, near_pairs(mesh, mesh, true));
}

std::vector<TrianglePair> intersections(const TriangleMesh& mesh, const TriangleMesh& other) {
  return meeting(mesh, other, false, near_pairs(mesh, other, false));
}

std::optional<Eigen::Index> first_outside(const TriangleMesh& closed, const Positions& points) {
  using Surface = CGAL::Surface_mesh<Point>;
  Surface surface;
  for (const auto& x : closed.vertices.rowwise()) surface.add_vertex(point(x));
  for (const auto& t : closed.triangles.rowwise())
    surface.add_face(Surface::Vertex_index(t[0]), Surface::Vertex_index(t[1]), Surface::Vertex_index(t[2]));
  const CGAL::Side_of_triangle_mesh<Surface, Kernel> side_of(surface);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    if (side_of(point(points.row(i))) != CGAL::ON_BOUNDED_SIDE) return i;
  return {};
}

}  // namespace drape
