#include "core/numerics/mesh/repair.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh/unjoined_borders.h"

namespace drape {
namespace {

/// The elements of one kind, for a text.
struct Kind {
  std::size_t count;
  const char *one, *many;
};

/// "dropped 3 loose vertices and 1 doubled triangle"; empty if all numbers are 0.
std::string counted(const std::string& verb, const std::vector<Kind>& kinds) {
  std::vector<std::string> parts;
  for (const auto& [count, one, many] : kinds)
    if (count > 0) parts.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
  return parts.empty() ? "" : verb + " " + joined(parts, ", ", " and ");
}

/// Marks the triangles without area, and returns their number. They must have none in every frame, or some in
/// every one.
std::size_t mark_empty(const std::vector<TriangleMesh>& frames, std::vector<char>& dropped) {
  std::size_t count = 0;
  std::vector<std::size_t> frames_without(dropped.size(), 0);
  for (const TriangleMesh& frame : frames)
    for (const int t : MeshFaults::of_elements(frame).empty_triangles) ++frames_without[t];
  for (std::size_t t = 0; t < dropped.size(); ++t) {
    if (dropped[t] || frames_without[t] == 0) continue;
    if (frames_without[t] < frames.size())
      throw std::runtime_error("triangle " + std::to_string(t) + " (counted from 0) has no area in " +
                               std::to_string(frames_without[t]) + " of " + std::to_string(frames.size()) +
                               " frames; give it one in all of them, or remove it from all");
    dropped[t] = 1;
    ++count;
  }
  return count;
}

/// The frames without these triangles and the vertices of no other.
std::vector<TriangleMesh> reduced(const std::vector<TriangleMesh>& frames,
                                  const std::vector<char>& dropped_triangles) {
  std::vector<int> kept_triangles, kept_vertices, numbers(frames[0].vertices.rows(), -1);
  for (int t = 0; t < std::ssize(dropped_triangles); ++t)
    if (!dropped_triangles[t]) kept_triangles.push_back(t);
  Triangles triangles = frames[0].triangles(kept_triangles, Eigen::all);
  for (const int v : triangles.reshaped()) numbers[v] = 0;
  for (int v = 0; v < std::ssize(numbers); ++v) {
    if (numbers[v] < 0) continue;
    numbers[v] = static_cast<int>(kept_vertices.size());
    kept_vertices.push_back(v);
  }
  for (int& v : triangles.reshaped()) v = numbers[v];
  std::vector<TriangleMesh> result;
  for (const TriangleMesh& frame : frames)
    result.push_back({frame.vertices(kept_vertices, Eigen::all), triangles});
  return result;
}

/// Has triangles name the first of the vertices that are at one place in every frame; returns how many others
/// are named no more.
std::size_t weld(std::vector<TriangleMesh>& frames) {
  const std::vector<int> first = first_at_place(frames);
  std::vector<char> welded(first.size(), 0);
  Triangles triangles = frames[0].triangles;
  for (int& v : triangles.reshaped()) {
    if (first[v] != v) welded[v] = 1;
    v = first[v];
  }
  for (TriangleMesh& frame : frames) frame.triangles = triangles;
  return static_cast<std::size_t>(std::ranges::count(welded, 1));
}

}  // namespace

RepairedMesh repair_mesh(std::vector<TriangleMesh> frames) {
  const std::size_t welded = weld(frames);
  const int count = static_cast<int>(frames[0].vertices.rows());
  if (const std::string fault = crowded_vertex(frames[0].triangles, count); !fault.empty())
    throw std::runtime_error(fault);
  const MeshFaults elements = MeshFaults::of_elements(frames[0]);
  std::vector<char> dropped(frames[0].triangles.rows(), 0);
  std::size_t doubled = 0;
  for (const int t : elements.repeating_triangles) dropped[t] = 1;
  for (const MeshFaults::Pair& pair : elements.doubled_triangles)
    if (!dropped[pair.element]) dropped[pair.element] = 1, ++doubled;
  const std::size_t empty = elements.repeating_triangles.size() + mark_empty(frames, dropped);
  if (!elements.loose_vertices.empty() || std::ranges::count(dropped, 0) < std::ssize(dropped))
    frames = reduced(frames, dropped);
  if (frames[0].triangles.rows() == 0) throw std::runtime_error("no triangle has an area");

  MeshFaults left;
  left.find_connectivity(frames[0].triangles, static_cast<int>(frames[0].vertices.rows()), {});
  const std::string lost =
      counted("dropped", {{elements.loose_vertices.size() - welded, "loose vertex", "loose vertices"},
                          {doubled, "doubled triangle", "doubled triangles"},
                          {empty, "triangle without area", "triangles without area"}});
  const std::string kept = counted(
      "kept",
      {{left.crowded_edges.size(), "edge with more than two triangles", "edges with more than two triangles"},
       {left.inverted_edges.size(), "edge between triangles that face opposite ways",
        "edges between triangles that face opposite ways"},
       {left.shared_vertices.size(), "vertex with separate fans of triangles",
        "vertices with separate fans of triangles"}});
  std::vector<std::string> parts = {
      counted("joined", {{welded, "vertex at the place of another", "vertices at the places of others"}}),
      lost, kept};
  std::erase(parts, "");
  return {std::move(frames), joined(parts, "; ", "; ")};
}

}  // namespace drape
