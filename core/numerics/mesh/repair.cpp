#include "core/numerics/mesh/repair.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/mesh_faults.h"

namespace drape {
namespace {

std::string counted(int count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Marks the triangles without area. They must have none in every frame, or some in every one.
void mark_empty(const std::vector<TriangleMesh>& frames, std::vector<char>& dropped, int& count) {
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
}

/// The number of each element among those that are kept; -1 for others.
std::vector<int> numbers_of(const std::vector<char>& dropped, int& count) {
  std::vector<int> numbers(dropped.size(), -1);
  count = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i)
    if (!dropped[i]) numbers[i] = count++;
  return numbers;
}

/// The frames without these triangles and the vertices of no other.
std::vector<TriangleMesh> reduced(const std::vector<TriangleMesh>& frames,
                                  const std::vector<char>& dropped_triangles) {
  const Triangles& old = frames[0].triangles;
  std::vector<char> dropped_vertices(frames[0].vertices.rows(), 1);
  for (Eigen::Index t = 0; t < old.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      if (!dropped_triangles[t]) dropped_vertices[old(t, k)] = 0;
  int vertex_count = 0, triangle_count = 0;
  const std::vector<int> vertices = numbers_of(dropped_vertices, vertex_count),
                         kept = numbers_of(dropped_triangles, triangle_count);
  Triangles triangles(triangle_count, 3);
  for (Eigen::Index t = 0; t < old.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      if (kept[t] >= 0) triangles(kept[t], k) = vertices[old(t, k)];
  std::vector<TriangleMesh> result;
  for (const TriangleMesh& frame : frames) {
    TriangleMesh& mesh = result.emplace_back(TriangleMesh{Positions(vertex_count, 3), triangles});
    for (std::size_t v = 0; v < vertices.size(); ++v)
      if (vertices[v] >= 0) mesh.vertices.row(vertices[v]) = frame.vertices.row(static_cast<Eigen::Index>(v));
  }
  return result;
}

void require_indices_in_range(const TriangleMesh& mesh) {
  const auto n = static_cast<int>(mesh.vertices.rows());
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    if (mesh.triangles.row(t).minCoeff() < 0 || mesh.triangles.row(t).maxCoeff() >= n)
      throw std::runtime_error("triangle " + std::to_string(t) +
                               " (counted from 0) names a vertex that is not there");
}

}  // namespace

std::string MeshRepair::text() const {
  std::vector<std::string> dropped, kept;
  if (loose_vertices > 0) dropped.push_back(counted(loose_vertices, "loose vertex", "loose vertices"));
  if (doubled_triangles > 0)
    dropped.push_back(counted(doubled_triangles, "doubled triangle", "doubled triangles"));
  if (empty_triangles > 0)
    dropped.push_back(counted(empty_triangles, "triangle without area", "triangles without area"));
  if (crowded_edges > 0)
    kept.push_back(counted(crowded_edges, "edge", "edges") + " with more than two triangles");
  if (inverted_edges > 0)
    kept.push_back(counted(inverted_edges, "edge", "edges") + " between triangles that face opposite ways");
  if (shared_vertices > 0)
    kept.push_back(counted(shared_vertices, "vertex", "vertices") + " with separate fans of triangles");
  return (dropped.empty() ? "" : "dropped " + joined(dropped, ", ", " and ")) +
         (dropped.empty() || kept.empty() ? "" : "; ") +
         (kept.empty() ? "" : "kept " + joined(kept, ", ", " and "));
}

RepairedMesh repair_mesh(std::vector<TriangleMesh> frames) {
  require_indices_in_range(frames[0]);
  RepairedMesh repaired;
  MeshRepair& done = repaired.done;
  const MeshFaults elements = MeshFaults::of_elements(frames[0]);
  done.loose_vertices = static_cast<int>(elements.loose_vertices.size());
  std::vector<char> dropped(frames[0].triangles.rows(), 0);
  for (const int t : elements.repeating_triangles) dropped[t] = 1, ++done.empty_triangles;
  for (const MeshFaults::Pair& pair : elements.doubled_triangles)
    if (!dropped[pair.element]) dropped[pair.element] = 1, ++done.doubled_triangles;
  mark_empty(frames, dropped, done.empty_triangles);
  const bool is_whole =
      elements.loose_vertices.empty() && std::ranges::count(dropped, 0) == std::ssize(dropped);
  repaired.frames = is_whole ? std::move(frames) : reduced(frames, dropped);
  if (repaired.frames[0].triangles.rows() == 0) throw std::runtime_error("no triangle has an area");

  MeshFaults left;
  left.find_connectivity(repaired.frames[0].triangles, static_cast<int>(repaired.frames[0].vertices.rows()),
                         {});
  done.crowded_edges = static_cast<int>(left.crowded_edges.size());
  done.inverted_edges = static_cast<int>(left.inverted_edges.size());
  done.shared_vertices = static_cast<int>(left.shared_vertices.size());
  return repaired;
}

}  // namespace drape
