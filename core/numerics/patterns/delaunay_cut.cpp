#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/numerics/mesh/cut_polygon.h"

namespace drape {
namespace {

enum class Side : char { unknown, outside, inside };

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Side, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using SidedStructure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using SidedTriangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, SidedStructure, CGAL::No_constraint_intersection_tag>;

}  // namespace

std::vector<std::array<int, 3>> delaunay_cut(const std::vector<Eigen::Vector2d>& outline) {
  SidedTriangulation triangulation;
  std::vector<SidedTriangulation::Vertex_handle> at;
  for (const Eigen::Vector2d& p : outline) {
    const auto before = triangulation.number_of_vertices();
    const auto hint = at.empty() ? SidedTriangulation::Face_handle() : at.back()->face();
    at.push_back(triangulation.insert({p.x(), p.y()}, hint));
    if (triangulation.number_of_vertices() > before) at.back()->info() = static_cast<int>(at.size()) - 1;
  }
  std::map<std::pair<int, int>, int> sides;  // how often each is passed
  const std::size_t n = outline.size();
  try {
    for (std::size_t k = 0; k < n; ++k)
      if (++sides[std::minmax(at[k]->info(), at[(k + 1) % n]->info())] == 1)
        triangulation.insert_constraint(at[k], at[(k + 1) % n]);
  } catch (const SidedTriangulation::Intersection_of_constraints_exception&) {
    return {};
  }
  for (std::size_t k = 0; k < n; ++k)  // no corner lies inside a side
    if (!triangulation.is_edge(at[k], at[(k + 1) % n])) return {};
  for (const auto face : triangulation.all_face_handles()) face->info() = Side::unknown;
  std::vector<SidedTriangulation::Face_handle> open = {triangulation.infinite_face()};
  open[0]->info() = Side::outside;
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto next = face->neighbor(i);
      const auto a = face->vertex((i + 1) % 3), b = face->vertex((i + 2) % 3);
      if (next->info() != Side::unknown) continue;
      const bool finite = !triangulation.is_infinite(a) && !triangulation.is_infinite(b);
      const auto side = finite ? sides.find(std::minmax(a->info(), b->info())) : sides.end();
      const bool across = side != sides.end() && side->second % 2 == 1;
      next->info() = across == (face->info() == Side::outside) ? Side::inside : Side::outside;
      open.push_back(next);
    }
  }
  std::vector<std::array<int, 3>> triangles;
  for (const auto face : triangulation.finite_face_handles())
    if (face->info() == Side::inside)
      triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::ranges::sort(triangles);
  return triangles.size() == n - 2 ? triangles : std::vector<std::array<int, 3>>();
}

}  // namespace drape
