#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/kernel/files/number_text.h"
#include "core/numerics/patterns/delaunay.h"

namespace drape {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
using Ring = std::vector<Point2>;

std::string loop_name(std::size_t i) {
  return "polygon: loop " + std::to_string(i) + (i == 0 ? " (the outer border)" : " (a hole)");
}

Kernel::Segment_2 side(const Ring& ring, std::size_t i) { return {ring[i], ring[(i + 1) % ring.size()]}; }

double area(const Ring& ring) { return std::abs(CGAL::polygon_area_2(ring.begin(), ring.end(), Kernel())); }

bool contains(const Ring& ring, const Point2& p) {
  return CGAL::bounded_side_2(ring.begin(), ring.end(), p, Kernel()) == CGAL::ON_BOUNDED_SIDE;
}

/// Validates the loops: simple polygons, holes inside the first and outside one another.
std::vector<Ring> checked_rings(const std::vector<Polygon>& loops) {
  constexpr std::size_t most_points = 10'000;  // each is compared with every loop that may enclose it
  if (loops.empty()) throw std::runtime_error("polygon: there is no loop");
  std::size_t points = 0;
  for (const Polygon& loop : loops) points += loop.size();
  if (points > most_points)
    throw std::runtime_error("polygon: the loops have " + std::to_string(points) + " points, of at most " +
                             std::to_string(most_points) + "; leave out those that shape nothing");
  std::vector<Ring> rings;
  std::vector<CGAL::Bbox_2> boxes;
  const auto refuse = [](std::size_t i, const std::string& why) {
    throw std::runtime_error(loop_name(i) + ' ' + why);
  };
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].size() < 3) refuse(i, "has fewer than three points");
    Ring& ring = rings.emplace_back();
    for (const Eigen::Vector2d& p : loops[i]) {
      if (!p.allFinite()) refuse(i, "has a coordinate that is not finite");
      ring.emplace_back(p.x(), p.y());
    }
    if (loops[i].front() == loops[i].back())
      refuse(i, "ends with its first point again; leave the last one out");
    if (area(ring) == 0) refuse(i, "crosses or touches itself: its sides enclose no area");
    boxes.push_back(CGAL::bbox_2(ring.begin(), ring.end()));
  }
  const LoopSides all = sides_of(loops);
  const auto side_text = [&](int side) {
    const auto point = [&](int end) {
      const Eigen::Vector2d& p = all.points[all.sides[side][end]];
      return '(' + general_text(p.x(), 6) + ", " + general_text(p.y(), 6) + ')';
    };
    return "side from " + point(0) + " to " + point(1);
  };
  for (const auto& [one, other] : crossing_segments(all.points, all.sides, 1))
    refuse(all.loop[other],
           "crosses or touches " +
               (all.loop[one] == all.loop[other] ? "itself" : "loop " + std::to_string(all.loop[one])) +
               ": its " + side_text(other) + " meets the " + side_text(one) + "; move their points apart");
  for (std::size_t i = 1; i < rings.size(); ++i) {
    if (!contains(rings[0], rings[i][0])) refuse(i, "lies outside loop 0");
    for (std::size_t j = 1; j < i; ++j)
      if (CGAL::do_overlap(boxes[i], boxes[j]) &&
          (contains(rings[j], rings[i][0]) || contains(rings[i], rings[j][0])))
        refuse(i, "and loop " + std::to_string(j) + " lie one inside the other");
  }
  return rings;
}

/// Whether p lies in the region to be meshed; not for points on a loop.
bool encloses(const std::vector<Ring>& rings, const Point2& p) {
  return contains(rings[0], p) &&
         std::none_of(rings.begin() + 1, rings.end(), [&](const Ring& hole) { return contains(hole, p); });
}

/// The loops as constraints, every side divided evenly into segments of about `spacing`.
void insert_loops(const std::vector<Polygon>& loops, double spacing, Triangulation& triangulation) {
  for (const Polygon& loop : loops) {
    std::vector<Point2> points;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Eigen::Vector2d& a = loop[i];
      const Eigen::Vector2d along = loop[(i + 1) % loop.size()] - a;
      const auto pieces = std::max(1L, std::lround(along.norm() / spacing));
      for (long k = 0; k < pieces; ++k) {
        const Eigen::Vector2d p = a + along * (static_cast<double>(k) / static_cast<double>(pieces));
        points.emplace_back(p.x(), p.y());
      }
    }
    triangulation.insert_constraint(points.begin(), points.end(), true);
  }
}

/// A random point at least `spacing` from the boundary, if one is found.
std::optional<Point2> first_inner(const std::vector<Ring>& rings, double spacing, unsigned seed) {
  Random random(seed);
  const auto box = CGAL::bbox_2(rings[0].begin(), rings[0].end());
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const double u = random.unit(), v = random.unit();
    const Point2 p(box.xmin() + u * (box.xmax() - box.xmin()), box.ymin() + v * (box.ymax() - box.ymin()));
    const bool far = std::all_of(rings.begin(), rings.end(), [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (CGAL::squared_distance(p, side(ring, i)) <= spacing * spacing) return false;
      return true;
    });
    if (far && encloses(rings, p)) return p;
  }
  return {};
}

/// A point well inside each hole: the centroid of the largest triangle that its sides allow. CGAL finds what
/// is outside the outer border itself.
std::vector<Point2> points_in_holes(const std::vector<Ring>& rings) {
  std::vector<Point2> inside;
  for (auto ring = rings.begin() + 1; ring != rings.end(); ++ring) {
    Triangulation triangulation;
    triangulation.insert_constraint(ring->begin(), ring->end(), true);
    double largest = 0;
    for (auto f : triangulation.finite_face_handles()) {
      const auto triangle = triangulation.triangle(f);
      const double area = std::abs(triangle.area());
      if (area <= largest || !contains(*ring, CGAL::centroid(triangle))) continue;
      if (largest == 0) inside.emplace_back();
      inside.back() = CGAL::centroid(triangle);
      largest = area;
    }
  }
  return inside;
}

TriangleMesh inside(Triangulation& triangulation) {
  std::vector<double> coordinates;
  std::vector<std::array<int, 3>> triangles;
  for (auto v : triangulation.finite_vertex_handles()) {
    v->info() = static_cast<int>(coordinates.size() / 3);
    coordinates.insert(coordinates.end(), {v->point().x(), v->point().y(), 0.0});
  }
  for (auto f : triangulation.finite_face_handles())
    if (f->is_in_domain())
      triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return {
      Eigen::Map<const Positions>(coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3),
      in_order(std::move(triangles))};
}

/// Empty if the corners and angles require more than `most` vertices.
std::optional<TriangleMesh> refined(const std::vector<Polygon>& loops, const std::optional<Point2>& inner,
                                    const std::vector<Point2>& hole_points, double spacing,
                                    double longest_edge, double most) {
  Triangulation triangulation;
  insert_loops(loops, spacing, triangulation);
  if (inner) triangulation.insert(*inner);
  // sin² of the smallest angle, 20.7°: refinement terminates for certain.
  constexpr double shape_bound = 0.125;
  CGAL::Delaunay_mesher_2<Triangulation, Criteria> mesher(triangulation, Criteria(shape_bound, longest_edge));
  mesher.set_seeds(hole_points.begin(), hole_points.end(), false);
  mesher.init();
  // A step adds a vertex or prepares one. If round-off makes it add an existing one, it never terminates.
  constexpr double steps_each = 20;
  double steps = 0;
  while (mesher.try_one_step_refine_mesh())
    if (++steps > steps_each * most || static_cast<double>(triangulation.number_of_vertices()) > most)
      return std::nullopt;
  return inside(triangulation);
}

}  // namespace

Triangles in_order(std::vector<std::array<int, 3>> triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return Eigen::Map<const Triangles>(triangles.data()->data(), static_cast<Eigen::Index>(triangles.size()),
                                     3);
}

double even_spacing(double area, double border_length, int vertices) {
  // 2 n h² − border h − 4 area/√3 = 0
  const double root = std::sqrt(border_length * border_length + 32 * vertices * area / std::numbers::sqrt3);
  return (border_length + root) / (4 * vertices);
}

Triangles delaunay_triangulation(const std::vector<Eigen::Vector2d>& points) {
  Triangulation triangulation;
  for (std::size_t i = 0; i < points.size(); ++i)
    triangulation.insert(Point2(points[i].x(), points[i].y()))->info() = static_cast<int>(i);
  std::vector<std::array<int, 3>> triangles;
  for (auto f : triangulation.finite_face_handles())
    triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return in_order(std::move(triangles));
}

LoopSides sides_of(const std::vector<Polygon>& loops) {
  LoopSides all;
  for (int k = 0; k < std::ssize(loops); ++k) {
    const auto first = static_cast<int>(all.points.size()), count = static_cast<int>(loops[k].size());
    for (int i = 0; i < count; ++i) all.sides.push_back({first + i, first + (i + 1) % count});
    all.points.insert(all.points.end(), loops[k].begin(), loops[k].end());
    all.loop.insert(all.loop.end(), count, k);
  }
  return all;
}

double area_of(const Polygon& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

TriangleMesh delaunay_polygon(const std::vector<Polygon>& loops, int vertices_about, unsigned seed,
                              VertexCount count) {
  const std::vector<Ring> rings = checked_rings(loops);
  if (vertices_about < 3) throw std::runtime_error("polygon: at least three vertices are needed");
  double inner_area = 0, border = 0, corners = 0;
  for (const Ring& ring : rings) {
    corners += static_cast<double>(ring.size());
    inner_area += &ring == &rings[0] ? area(ring) : -area(ring);
    for (std::size_t i = 0; i < ring.size(); ++i) border += std::sqrt(side(ring, i).squared_length());
  }

  const auto refuse = [&](const std::string& nearest) {
    throw ImpossibleCount("polygon: about " + std::to_string(vertices_about) +
                          " vertices are not possible; the nearest number is " + nearest +
                          " (corners, angles and narrow places ask for that many)");
  };
  // Well above the overshoot of a first attempt, and above what ordinary corners need.
  const double most = 5.0 * vertices_about + (count == VertexCount::about ? 1e4 : 100 + 10 * corners);
  const double spacing = even_spacing(inner_area, border, vertices_about);
  const std::optional<Point2> inner = first_inner(rings, spacing, seed);
  const std::vector<Point2> hole_points = points_in_holes(rings);
  double longest_edge = 1.4 * spacing;
  TriangleMesh best;
  const auto miss = [&](const TriangleMesh& mesh) {
    return std::abs(static_cast<double>(mesh.vertices.rows()) / vertices_about - 1);
  };
  constexpr double far_off = 0.5;
  for (int attempt = 0; attempt < 12; ++attempt) {
    std::optional<TriangleMesh> mesh = refined(loops, inner, hole_points, spacing, longest_edge, most);
    if (!mesh) refuse("above " + std::to_string(std::llround(most)));
    longest_edge *= std::sqrt(static_cast<double>(mesh->vertices.rows()) / vertices_about);
    // The loops alone ask for this many.
    if (attempt > 0 && miss(*mesh) > far_off && mesh->vertices.rows() == best.vertices.rows()) break;
    if (attempt == 0 || miss(*mesh) < miss(best)) best = std::move(*mesh);
    if (miss(best) < 0.02) break;
  }
  if (miss(best) > 0.15 && count == VertexCount::about) refuse(std::to_string(best.vertices.rows()));
  return best;
}

TriangleMesh delaunay_polygon(const std::vector<Polygon>& loops, int vertices_about, unsigned seed) {
  return delaunay_polygon(loops, vertices_about, seed, VertexCount::about);
}

}  // namespace drape
