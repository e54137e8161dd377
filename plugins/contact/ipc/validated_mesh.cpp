#include "plugins/contact/ipc/validated_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "core/kernel/plugin/refused_parameters.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/primitives.h"

namespace drape::ipc {
namespace {

/// Throws RefusedParameters with a fault for each line, if there is any.
void refuse(const std::string& file, const std::vector<std::string>& lines) {
  std::vector<ParameterFault> faults;
  for (const std::string& line : lines) faults.push_back({"", file + ": " + line});
  if (!faults.empty()) throw RefusedParameters(std::move(faults));
}

/// How the triangles of another frame differ from those of the first; empty if they do not.
std::string difference(const TriangleMesh& first, const TriangleMesh& other) {
  if (first.triangles.rows() != other.triangles.rows())
    return "has " + std::to_string(other.triangles.rows()) + " triangles and not " +
           std::to_string(first.triangles.rows());
  if (first.vertices.rows() != other.vertices.rows())
    return "has " + std::to_string(other.vertices.rows()) + " vertices and not " +
           std::to_string(first.vertices.rows());
  for (Eigen::Index t = 0; t < first.triangles.rows(); ++t)
    if (first.triangles.row(t) != other.triangles.row(t))
      return "has other vertices in triangle " + std::to_string(t);
  return "";
}

bool same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.vertices == b.vertices &&
         same_entries(a.triangles, b.triangles);
}

}  // namespace

std::shared_ptr<const ValidatedMesh> ValidatedMesh::of(TriangleMesh mesh) {
  Topology topology = Topology::of_any(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  return std::make_shared<const ValidatedMesh>(ValidatedMesh{std::move(mesh), std::move(topology)});
}

bool are_equal(const ValidatedMeshes& a, const ValidatedMeshes& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    return one == other || same_mesh(one->mesh, other->mesh);
  });
}

LoadedMeshes load_validated_meshes(const std::vector<std::string>& files, const FileCoordinates& coordinates,
                                   bool strict) {
  std::vector<TriangleMesh> frames;
  for (const std::string& file : files) {
    frames.push_back(read_mesh(file));
    coordinates.convert(frames.back().vertices);
    refuse(file, strict ? check_mesh(frames.back()) : check_coordinates(frames.back().vertices));
    if (const std::string what = difference(frames[0], frames.back()); !what.empty())
      throw std::runtime_error(file + " " + what + " as " + files[0] +
                               " has; all files of an animation must have the same triangles");
  }
  LoadedMeshes loaded;
  try {
    RepairedMesh repaired = repair_mesh(std::move(frames));
    loaded.repair = repaired.done;
    for (TriangleMesh& mesh : repaired.frames) loaded.meshes.push_back(ValidatedMesh::of(std::move(mesh)));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(files[0] + ": " + error.what());
  }
  return loaded;
}

std::shared_ptr<const ValidatedMesh> validated_box() { return ValidatedMesh::of(unit_box()); }

std::shared_ptr<const ValidatedMesh> validated_sphere(int subdivisions) {
  return ValidatedMesh::of(unit_sphere(subdivisions));
}

}  // namespace drape::ipc
