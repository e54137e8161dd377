#include "core/numerics/mesh/cut_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;
using Outline = std::vector<Vector2d>;

/// Largest distance of a corner from the polygon's mean plane, over its diameter. A square folded along its
/// diagonal reaches it at 37°.
constexpr double largest_bend = 0.08;
/// Areas below this part of the diameter's square are round-off.
constexpr double area_rounding = 1e-13;
/// Corners off a line by less than this part of the diameter lie on it.
constexpr double line_rounding = 1e-6;
/// Corners of an outline whose sides are compared: the time grows with the square.
constexpr std::size_t most_compared = 10'000;
/// Corners of the largest fan: corner 0 is in all its triangles, and a mesh limits the triangles around a
/// vertex.
constexpr std::size_t most_of_fan = 5000;

/// The polygon in its mean plane, anticlockwise, at the scale of its diameter.
struct Flattened {
  Outline outline;
  double bend = 0;       // the largest distance from the plane
  bool has_area = true;  // otherwise it has no plane
  bool on_line = false;  // without area: all corners are on a line

  explicit Flattened(const std::vector<Vector3d>& corners) {
    Vector3d centre = Vector3d::Zero(), normal = Vector3d::Zero();
    for (const Vector3d& p : corners) centre += p / static_cast<double>(corners.size());
    double diameter = 0;
    for (const Vector3d& p : corners) diameter = std::max(diameter, 2 * (p - centre).norm());
    for (std::size_t k = 0; k < corners.size(); ++k)  // Newell's sum
      normal += (corners[k] - centre).cross(corners[(k + 1) % corners.size()] - centre);
    has_area = normal.norm() > area_rounding * diameter * diameter;
    if (!has_area) {
      const Vector3d far =
          *std::ranges::max_element(corners, {}, [&](const Vector3d& p) { return (p - centre).norm(); });
      on_line = std::ranges::all_of(corners, [&](const Vector3d& p) {
        return (p - centre).cross(far - centre).norm() <= line_rounding * diameter * diameter;
      });
      return;
    }
    normal.normalize();
    const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
    for (const Vector3d& p : corners) {
      const Vector3d q = (p - centre) / diameter;
      outline.emplace_back(x.dot(q), y.dot(q));
      bend = std::max(bend, std::abs(normal.dot(q)));
    }
  }
};

/// Which side of the line from a to b the point p is on: 1 left, -1 right, 0 on it.
int side_of(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const Vector2d u = b - a, v = p - a;
  const double area = u.x() * v.y() - u.y() * v.x();
  return area > area_rounding ? 1 : area < -area_rounding ? -1 : 0;
}

/// Whether all triangles of the fan around corner 0 face up and together fill less than a full turn.
bool is_fan(const Outline& outline) {
  double turn = 0;
  for (std::size_t k = 2; k < outline.size(); ++k) {
    if (side_of(outline[0], outline[k - 1], outline[k]) <= 0) return false;
    const Vector2d u = outline[k - 1] - outline[0], v = outline[k] - outline[0];
    turn += std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v));
  }
  return turn < 2 * std::numbers::pi;
}

bool is_between(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return side_of(a, b, p) == 0 && (p - a).dot(p - b) <= 0;
}

bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  if ((a.cwiseMax(b).array() < c.cwiseMin(d).array()).any() ||
      (c.cwiseMax(d).array() < a.cwiseMin(b).array()).any())
    return false;
  if (side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0) return true;
  return is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b);
}

/// The first two sides that meet other than at their common corner; (-1, -1) without any.
std::array<int, 2> meeting_sides(const Outline& outline) {
  const int n = static_cast<int>(outline.size());
  for (int i = 0; i < n; ++i) {
    const Vector2d &a = outline[i], &b = outline[(i + 1) % n];
    if (is_between(a, b, outline[(i + 2) % n]) || is_between(b, outline[(i + 2) % n], a))
      return {i, (i + 1) % n};
    for (int j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(a, b, outline[j], outline[(j + 1) % n])) return {i, j};
  }
  return {-1, -1};
}

/// Corners that do not coincide with the one before; the last not with the first either.
std::vector<int> different_corners(const Outline& outline) {
  constexpr double same = 1e-12;
  std::vector<int> kept;
  for (int k = 0; k < static_cast<int>(outline.size()); ++k)
    if (kept.empty() || (outline[k] - outline[kept.back()]).norm() > same) kept.push_back(k);
  while (kept.size() > 1 && (outline[kept.back()] - outline[kept[0]]).norm() <= same) kept.pop_back();
  return kept;
}

/// The triangles of the corners `kept`, and for each other corner k one without area that joins it to k + 1.
std::vector<std::array<int, 3>> with_all_corners(std::vector<std::array<int, 3>> triangles,
                                                 const std::vector<int>& kept, int corner_count) {
  for (auto& t : triangles)
    for (int& k : t) k = kept[k];
  for (int k = 0, at = -1; k < corner_count; ++k) {
    if (at + 1 < static_cast<int>(kept.size()) && kept[at + 1] == k)
      ++at;
    else
      triangles.push_back({kept[at], k, (k + 1) % corner_count});
  }
  return triangles;
}

CutPolygon refused(const std::string& why) { return {{}, why}; }

}  // namespace

CutPolygon cut_polygon(const std::vector<Vector3d>& corners) {
  CutPolygon fan;
  for (int k = 2; k < static_cast<int>(corners.size()); ++k) fan.triangles.push_back({0, k - 1, k});
  if (corners.size() == 3) return fan;
  const Flattened flat(corners);
  if (!flat.has_area && !flat.on_line)
    return refused("crosses itself, so that its two sides have the same area; cut it into faces that do not");
  if (!flat.has_area) return fan;
  if (flat.bend > largest_bend)
    return refused("is not planar: its corners lie off their mean plane by " +
                   std::to_string(static_cast<int>(std::round(100 * flat.bend))) +
                   " % of its diameter; cut it into triangles");
  const std::vector<int> kept = different_corners(flat.outline);
  if (kept.size() < 3) return fan;  // has no area but by round-off
  Outline outline;
  for (const int k : kept) outline.push_back(flat.outline[k]);
  if (kept.size() == corners.size() && outline.size() <= most_of_fan && is_fan(outline)) return fan;
  const auto triangles = delaunay_cut(outline);
  if (triangles.empty() && outline.size() <= most_compared)
    if (const auto [one, other] = meeting_sides(outline); one >= 0)
      return refused("crosses or touches itself: its sides " + std::to_string(kept[one]) + " and " +
                     std::to_string(kept[other]) + " (counted from 0) meet; cut it into faces that do not");
  CutPolygon cut{with_all_corners(triangles, kept, static_cast<int>(corners.size())), {}};
  if (cut.triangles.size() != corners.size() - 2)
    return refused("cannot be cut: some of its corners lie on one line to round-off; cut it into triangles");
  return cut;
}

}  // namespace drape
