#include "core/numerics/sewing/panel_meshes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/numerics/patterns/delaunay.h"

namespace drape {

namespace {

/// The divided loops of a panel.
struct DividedLoops {
  std::vector<Polygon> loops;
  std::vector<int> edges;  ///< of each side
  PanelMesh mesh;          ///< without triangles

  DividedLoops(const Panel& panel, const std::vector<EdgeDivision>& divisions) {
    for (const std::vector<int>& own : panel.loops) {
      Polygon& loop = loops.emplace_back();
      const int first = mesh.border();
      int before = divisions[own.back()].stitches.back();
      for (const int e : own) {
        const EdgeDivision& division = divisions[e];
        for (std::size_t i = 0; i + 1 < division.lengths.size(); ++i) {
          loop.push_back(panel.edges[e].curve.at_length(division.lengths[i]));
          edges.push_back(e);
          mesh.stitches.push_back(division.stitches[i]);
          mesh.ends.push_back(i == 0 ? before : -1);
        }
        before = division.stitches.back();
      }
      const auto count = static_cast<int>(loop.size());
      for (int i = 0; i < count; ++i) {
        const std::pair<int, int> side = std::minmax(first + i, first + (i + 1) % count);
        mesh.sides[side] = edges[first + i];
        if (divisions[edges[first + i]].stitches[0] >= 0) mesh.sewn.insert(side);
      }
    }
  }
};

std::string edges_text(const Panel& panel, int one, int other) {
  if (one == other) return "edge " + panel.edges[one].name + " crosses or touches itself";
  return "edges " + panel.edges[one].name + " and " + panel.edges[other].name + " cross or touch";
}

/// Whether all points of the loop lie on one line, but for rounding.
bool is_on_line(const Polygon& loop) {
  constexpr double rounding = 1e-12;
  const Eigen::Vector2d& start = loop[0];
  const Eigen::Vector2d far =
      *std::ranges::max_element(loop, {}, [&](const auto& p) { return (p - start).squaredNorm(); }) - start;
  return std::ranges::all_of(loop, [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d along = p - start;
    return std::abs(far.x() * along.y() - far.y() * along.x()) <= rounding * far.squaredNorm();
  });
}

/// Why loops bound no panel; nothing if they do.
std::optional<ConfigError> fault_of(const Panel& panel, const DividedLoops& divided) {
  const std::string in = "panel " + panel.name + ": ";
  const auto& loops = divided.loops;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const std::string name = in + (k == 0 ? "the outline" : "hole " + std::to_string(k));
    if (is_on_line(loops[k]))
      return ConfigError{panel.where, name +
                                          " encloses no area: its points at this \"edge_length\" lie on "
                                          "one line; move a vertex, or curve an edge"};
    if (loops[k].size() < 3)
      return ConfigError{panel.where, name + " has " + std::to_string(loops[k].size()) +
                                          " points at this \"edge_length\"; choose a shorter one"};
  }
  const LoopSides all = sides_of(loops);
  for (const auto& [one, other] : crossing_segments(all.points, all.sides, 1))
    return ConfigError{panel.edges[divided.edges[other]].where,
                       in + edges_text(panel, divided.edges[one], divided.edges[other]) +
                           "; an outline must not meet itself: move its vertices, or choose "
                           "a shorter \"edge_length\""};
  for (std::size_t k = 1; k < loops.size(); ++k)
    if (!is_inside(loops[0], loops[k][0]))
      return ConfigError{panel.edges[panel.loops[k][0]].where,
                         in + "the hole that begins with edge " + panel.edges[panel.loops[k][0]].name +
                             " lies outside the outline; the first loop of edges is the outline"};
  return std::nullopt;
}

}  // namespace

std::vector<PanelMesh> mesh_panels(const Pattern& pattern, double edge_length,
                                   const std::vector<std::vector<EdgeDivision>>& divisions,
                                   ConfigErrors& errors) {
  std::vector<PanelMesh> meshes;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    DividedLoops divided(pattern.panels[p], divisions[p]);
    if (std::optional<ConfigError> fault = fault_of(pattern.panels[p], divided)) {
      errors.push_back(std::move(*fault));
      continue;
    }
    divided.mesh.flat = mesh_panel(divided.loops, edge_length);
    meshes.push_back(std::move(divided.mesh));
  }
  return meshes;
}

}  // namespace drape
