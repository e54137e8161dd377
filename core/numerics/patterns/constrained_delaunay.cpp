#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/spatial_sort.h>

#include <cstddef>
#include <map>
#include <numeric>
#include <stdexcept>

#include "core/numerics/mesh/cut_polygon.h"
#include "core/numerics/patterns/delaunay.h"

namespace drape {
namespace within {

using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices = CGAL::Triangulation_vertex_base_with_info_2<int, Exact>;
enum class Side : char { unknown, outside, inside };
using SidesOf = CGAL::Triangulation_face_base_with_info_2<Side, Exact>;
using Faces = CGAL::Constrained_triangulation_face_base_2<Exact, SidesOf>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Exact, CGAL::Triangulation_data_structure_2<Vertices, Faces>>;

/// The order in which points are inserted. Many along a curve, one after another, would take a time that
/// grows with the square; a random order that is sorted by place does not.
std::vector<std::ptrdiff_t> order_of(const std::vector<Eigen::Vector2d>& points) {
  constexpr std::size_t many =
      10'000;  // fewer keep their order: among points on a circle it chooses triangles
  std::vector<std::ptrdiff_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  if (points.size() < many) return order;
  std::vector<Exact::Point_2> at;
  for (const Eigen::Vector2d& p : points) at.emplace_back(p.x(), p.y());
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Exact, const Exact::Point_2*>;
  CGAL::spatial_sort(order.begin(), order.end(), Traits(at.data()));
  return order;
}

/// The triangulation of what segments enclose.
struct Enclosed {
  std::vector<std::array<int, 3>> triangles;
  int doubled = -1;  ///< a point at the place of another, which stands for all that are there; or -1
  int faulty = -1;   ///< the first segment that crosses another, has a point inside or no length; or -1

  /// A segment that is passed an even number of times has the same on both of its sides. Has no triangles if
  /// two cross, or if all points lie on one line.
  Enclosed(const std::vector<Eigen::Vector2d>& points, const std::vector<std::array<int, 2>>& segments) {
    Constrained all;
    std::vector<Constrained::Vertex_handle> at(points.size());
    Constrained::Face_handle near;
    for (const std::ptrdiff_t i : order_of(points)) {
      const auto before = all.number_of_vertices();
      at[i] = all.insert({points[i].x(), points[i].y()}, near);
      if (all.number_of_vertices() > before)
        at[i]->info() = static_cast<int>(i);
      else
        doubled = static_cast<int>(i);
      near = at[i]->face();
    }
    std::map<std::pair<int, int>, int> passes;
    for (int s = 0; s < std::ssize(segments); ++s) {
      const auto [a, b] = segments[s];
      bool crosses = false;
      if (at[a] != at[b] && ++passes[std::minmax(at[a]->info(), at[b]->info())] == 1) try {
          all.insert_constraint(at[a], at[b]);
        } catch (const Constrained::Intersection_of_constraints_exception&) {
          crosses = true;
        }
      if (at[a] != at[b] && !crosses && all.is_edge(at[a], at[b])) continue;
      if (faulty < 0) faulty = s;
      if (crosses) return;
    }
    if (all.dimension() < 2) return;  // CGAL has no faces then, and their neighbours are null
    const auto parts = [&](const Constrained::Face_handle& f, int k) {
      if (!f->is_constrained(k)) return false;
      const auto pass = passes.find(
          std::minmax({f->vertex(Constrained::cw(k))->info(), f->vertex(Constrained::ccw(k))->info()}));
      return pass == passes.end() || pass->second % 2 == 1;  // not found: a part of a segment
    };
    for (const auto f : all.all_face_handles()) f->info() = Side::unknown;
    std::vector<Constrained::Face_handle> open = {all.infinite_face()};
    open[0]->info() = Side::outside;
    while (!open.empty()) {
      const auto f = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto next = f->neighbor(k);
        if (next->info() != Side::unknown) continue;
        next->info() = parts(f, k) == (f->info() == Side::outside) ? Side::inside : Side::outside;
        open.push_back(next);
      }
    }
    for (const auto f : all.finite_face_handles())
      if (f->info() == Side::inside)
        triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  }
};

}  // namespace within

std::vector<std::array<int, 2>> crossing_segments(const std::vector<Eigen::Vector2d>& points,
                                                  const std::vector<std::array<int, 2>>& segments,
                                                  std::size_t most) {
  const within::Enclosed enclosed(points, segments);
  const auto count = static_cast<int>(segments.size());
  int faulty = enclosed.faulty;
  for (int s = 0; enclosed.doubled >= 0 && faulty < 0 && s < count; ++s)
    if (segments[s][0] == enclosed.doubled || segments[s][1] == enclosed.doubled) faulty = s;
  if (faulty < 0) return {};
  const auto segment_of = [&](int i) {
    const Eigen::Vector2d &a = points[segments[i][0]], &b = points[segments[i][1]];
    return within::Exact::Segment_2({a.x(), a.y()}, {b.x(), b.y()});
  };
  std::vector<std::array<int, 2>> pairs;
  const auto add = [&](int i, int j) {
    const within::Exact::Segment_2 one = segment_of(i), other = segment_of(j);
    const auto [a, b] = segments[i];
    const auto [c, d] = segments[j];
    const bool from = a == c || a == d, to = b == c || b == d;
    const bool meet = !CGAL::do_overlap(one.bbox(), other.bbox()) ? false
                      : !from && !to
                          ? CGAL::do_intersect(one, other)
                          : from != to && (one.has_on(other[a == c || b == c]) || other.has_on(one[from]));
    if (meet && i != j && pairs.size() < most) pairs.push_back({std::min(i, j), std::max(i, j)});
  };
  // All pairs take a time that grows with the square: where one is enough, that of the first faulty segment.
  for (int i = most == 1 ? faulty : 0; i < (most == 1 ? faulty + 1 : count); ++i)
    for (int j = most == 1 ? 0 : i + 1; j < count; ++j) add(i, j);
  return pairs;
}

Triangles triangles_within(const std::vector<Eigen::Vector2d>& points,
                           const std::vector<std::array<int, 2>>& segments) {
  within::Enclosed enclosed(points, segments);
  if (enclosed.doubled >= 0 || enclosed.triangles.empty())
    throw std::runtime_error("two vertices of a flat piece lie at one place, or sides of it cross");
  return in_order(std::move(enclosed.triangles));
}

std::vector<std::array<int, 3>> delaunay_cut(const std::vector<Eigen::Vector2d>& outline) {
  std::vector<std::array<int, 3>> triangles;
  const within::Enclosed enclosed(outline, sides_of({outline}).sides);
  if (enclosed.faulty >= 0 || enclosed.triangles.size() != outline.size() - 2) return {};
  const Triangles sorted = in_order(enclosed.triangles);
  for (const auto& t : sorted.rowwise()) triangles.push_back({t[0], t[1], t[2]});
  return triangles;
}

}  // namespace drape
