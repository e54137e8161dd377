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
  bool distinct =
      true;           ///< no two points are at one place; otherwise the first stands for all that are there
  bool whole = true;  ///< no point lies inside a segment

  /// A segment that is passed an even number of times has the same on both of its sides. Throws CGAL's
  /// Intersection_of_constraints_exception if two cross.
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
        distinct = false;
      near = at[i]->face();
    }
    std::map<std::pair<int, int>, int> passes;
    for (const auto& [a, b] : segments)
      if (++passes[std::minmax(at[a]->info(), at[b]->info())] == 1) all.insert_constraint(at[a], at[b]);
    for (const auto& [a, b] : segments) whole = whole && all.is_edge(at[a], at[b]);
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
  struct Side {
    int number;
    within::Exact::Segment_2 segment;
    CGAL::Bbox_2 box;
  };
  std::vector<Side> sides;
  for (int i = 0; i < std::ssize(segments); ++i) {
    const Eigen::Vector2d &a = points[segments[i][0]], &b = points[segments[i][1]];
    const within::Exact::Segment_2 segment({a.x(), a.y()}, {b.x(), b.y()});
    sides.push_back({i, segment, segment.bbox()});
  }
  std::ranges::stable_sort(sides, {}, [](const Side& side) { return side.box.xmin(); });
  const auto meet = [&](const Side& one, const Side& other) {
    const auto [a, b] = segments[one.number];
    const auto [c, d] = segments[other.number];
    const bool from = a == c || a == d, to = b == c || b == d;
    if (!from && !to) return CGAL::do_intersect(one.segment, other.segment);
    return from != to && (one.segment.has_on(other.segment[a == c || b == c]) ||
                          other.segment.has_on(one.segment[from]));  // one runs back along the other
  };
  std::vector<std::array<int, 2>> pairs;
  for (auto one = sides.begin(); one != sides.end(); ++one)
    for (auto other = one + 1; other != sides.end() && other->box.xmin() <= one->box.xmax(); ++other) {
      if (!CGAL::do_overlap(one->box, other->box) || !meet(*one, *other)) continue;
      pairs.push_back({std::min(one->number, other->number), std::max(one->number, other->number)});
      if (pairs.size() == most) return pairs;
    }
  return pairs;
}

Triangles triangles_within(const std::vector<Eigen::Vector2d>& points,
                           const std::vector<std::array<int, 2>>& segments) {
  within::Enclosed enclosed(points, segments);
  if (!enclosed.distinct) throw std::runtime_error("two vertices of a flat piece lie at one place");
  return in_order(std::move(enclosed.triangles));
}

std::vector<std::array<int, 3>> delaunay_cut(const std::vector<Eigen::Vector2d>& outline) {
  std::vector<std::array<int, 3>> triangles;
  try {
    const within::Enclosed enclosed(outline, sides_of({outline}).sides);
    if (!enclosed.whole || enclosed.triangles.size() != outline.size() - 2) return {};
    const Triangles sorted = in_order(enclosed.triangles);
    for (const auto& t : sorted.rowwise()) triangles.push_back({t[0], t[1], t[2]});
  } catch (const within::Constrained::Intersection_of_constraints_exception&) {
  }
  return triangles;
}

}  // namespace drape
