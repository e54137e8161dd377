#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <deque>
#include <stdexcept>

#include "core/numerics/patterns/delaunay.h"

namespace drape {
namespace within {

using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices = CGAL::Triangulation_vertex_base_with_info_2<int, Exact>;
/// The number of segments to be crossed from outside, -1 while it is not known.
using FacesOf = CGAL::Triangulation_face_base_with_info_2<int, Exact>;
using Faces = CGAL::Constrained_triangulation_face_base_2<Exact, FacesOf>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Exact, CGAL::Triangulation_data_structure_2<Vertices, Faces>>;

/// Sets each face's number of segments between it and the outside.
void count_segments_to_outside(Constrained& triangulation) {
  for (const auto f : triangulation.all_face_handles()) f->info() = -1;
  std::deque<Constrained::Face_handle> queue = {triangulation.infinite_face()};
  queue.front()->info() = 0;
  while (!queue.empty()) {
    const Constrained::Face_handle f = queue.front();
    queue.pop_front();
    for (int k = 0; k < 3; ++k) {
      const Constrained::Face_handle g = f->neighbor(k);
      if (g->info() != -1) continue;
      const bool behind = f->is_constrained(k);
      g->info() = f->info() + (behind ? 1 : 0);
      behind ? queue.push_back(g) : queue.push_front(g);
    }
  }
}

}  // namespace within

std::vector<std::array<int, 2>> crossing_segments(const std::vector<Eigen::Vector2d>& points,
                                                  const std::vector<std::array<int, 2>>& segments) {
  const auto segment = [&](const std::array<int, 2>& ends) {
    const Eigen::Vector2d &a = points[ends[0]], &b = points[ends[1]];
    return within::Exact::Segment_2({a.x(), a.y()}, {b.x(), b.y()});
  };
  std::vector<std::array<int, 2>> pairs;
  for (int i = 0; i < std::ssize(segments); ++i) {
    const auto [a, b] = segments[i];
    const within::Exact::Segment_2 own = segment(segments[i]);
    const CGAL::Bbox_2 box = own.bbox();
    for (int j = 0; j < i; ++j) {
      const auto [c, d] = segments[j];
      if (a == c || a == d || b == c || b == d) continue;
      const within::Exact::Segment_2 other = segment(segments[j]);
      if (CGAL::do_overlap(box, other.bbox()) && CGAL::do_intersect(own, other)) pairs.push_back({j, i});
    }
  }
  return pairs;
}

Triangles triangles_within(const std::vector<Eigen::Vector2d>& points,
                           const std::vector<std::array<int, 2>>& segments) {
  within::Constrained triangulation;
  std::vector<within::Constrained::Vertex_handle> handles;
  within::Constrained::Face_handle near;
  for (int i = 0; i < std::ssize(points); ++i) {
    const std::size_t before = triangulation.number_of_vertices();
    const auto v = handles.emplace_back(triangulation.insert({points[i].x(), points[i].y()}, near));
    if (triangulation.number_of_vertices() == before)
      throw std::runtime_error("two vertices of a flat piece lie at one place");
    v->info() = i;
    near = v->face();
  }
  for (const auto& [a, b] : segments) triangulation.insert_constraint(handles[a], handles[b]);
  within::count_segments_to_outside(triangulation);
  std::vector<std::array<int, 3>> inside;
  for (const auto f : triangulation.finite_face_handles()) {
    if (f->info() % 2 == 0) continue;
    std::array<int, 3>& t = inside.emplace_back();
    for (int k = 0; k < 3; ++k) t[k] = f->vertex(k)->info();
  }
  return in_order(std::move(inside));
}

}  // namespace drape
