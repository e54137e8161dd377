#include "plugins/contact/ipc/obstacle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "core/numerics/dressing/implicit_smoothing.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/repair.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"

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

/// Reads the files of one mesh, or of the frames of an animation, converts their coordinates, and repairs
/// them together. A `strict` obstacle is not repaired. Throws RefusedParameters or std::runtime_error naming
/// the files and their faults.
ObstacleMeshes load_meshes(const std::vector<std::string>& files, const FileCoordinates& coordinates,
                           bool strict) {
  constexpr double most_vertices = 1e7;  // of all frames together
  std::vector<TriangleMesh> frames;
  for (const std::string& file : files) {
    frames.push_back(read_surface(file));
    if (const auto all = static_cast<double>(files.size() * frames[0].vertices.rows());
        files.size() > 1 && all > most_vertices)
      throw std::runtime_error("its " + std::to_string(files.size()) + " frames have " +
                               three_digits(all / 1e6) + " million vertices together, and at most " +
                               three_digits(most_vertices / 1e6) +
                               " million are taken; leave out frames, between which it moves linearly");
    frames.back().sewing.reset();  // an obstacle is as it lies, also where a run's rest/l0.ply is one
    coordinates.convert(frames.back().vertices);
    refuse(file, strict ? check_mesh(frames.back()) : check_coordinates(frames.back().vertices));
    if (const std::string what = difference(frames[0], frames.back()); !what.empty())
      throw std::runtime_error(
          file + " " + what + " as " + files[0] +
          " has; all files of an animation must have the same triangles: cut faces of more "
          "corners into triangles before they move, since each file's are cut by their shape");
  }
  ObstacleMeshes loaded;
  try {
    RepairedMesh repaired = repair_mesh(std::move(frames));
    if (strict && !repaired.remark.empty())
      throw std::runtime_error("\"strict\" refuses what would be repaired: " + repaired.remark);
    loaded.repair = std::move(repaired.remark);
    for (TriangleMesh& mesh : repaired.frames) loaded.frames.push_back(ValidatedMesh::of(std::move(mesh)));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(files[0] + ": " + error.what());
  }
  return loaded;
}

/// The meshes without cages.
ObstacleMeshes frames_of(const ObstacleParameters& p) {
  const int named = int(!p.mesh.empty()) + int(p.meshed_shape.has_value()) + int(!p.animation.empty());
  if (named != 1)
    throw std::runtime_error("needs exactly one of \"mesh\", \"meshed_shape\" and \"animation\"");
  if (p.meshed_shape && FileCoordinates(p) != FileCoordinates())
    throw std::runtime_error(
        "\"unit\" and \"up\" say how a mesh file is read; a meshed_shape is in metres: leave them out");
  if (p.meshed_shape == "box") return {{ValidatedMesh::of(unit_box())}, {}, ""};
  if (p.meshed_shape == "sphere") return {{ValidatedMesh::of(unit_sphere(p.subdivisions))}, {}, ""};
  if (p.animation.empty()) return load_meshes({p.mesh}, p, p.strict);
  if (p.contraction > 0)
    throw std::runtime_error(
        "\"contraction\", by which \"dress\" shrinks a body, needs a \"mesh\" without \"animation\"; dress "
        "the first frame as a mesh; what is dressed goes on in another run, by --resume with --set dress={}");
  if (p.cages.count > 0) throw std::runtime_error("\"cages\" need a mesh without \"animation\"");
  return load_meshes(p.animation, p, p.strict);
}

std::string name_of(const ObstacleParameters& p, int number) {
  return p.name.empty() ? p.meshed_shape.value_or("mesh") + " " + std::to_string(number) : p.name;
}

std::string fault_text(const std::string& name, const std::string& what) {
  return "obstacle \"" + name + "\": " + what;
}

}  // namespace

void ObstacleParameters::declare(Declaration<ObstacleParameters>& d) {
  using P = ObstacleParameters;
  declare_obstacle(d);
  d.add("mesh", &P::mesh, "a mesh file (.obj, .off, .ply or .stl), relative to this file")
      .path()
      .identifies_item();
  d.add("meshed_shape", &P::meshed_shape,
        "instead of mesh: a triangulated box or an icosphere, centred at the origin")
      .choices({"box", "sphere"})
      .identifies_item();
  d.add("size", &P::size, "edge lengths of a box")
      .unit("m")
      .between(bounds::smallest_length, bounds::largest_length)
      .only_with("meshed_shape", {"box"});
  d.add("radius", &P::radius, "radius of a sphere")
      .unit("m")
      .between(bounds::smallest_length, bounds::largest_length)
      .only_with("meshed_shape", {"sphere"});
  d.add("subdivisions", &P::subdivisions,
        "how often a sphere's icosahedron is subdivided; the sphere has 20 · 4^subdivisions triangles")
      .between(0, 8)
      .only_with("meshed_shape", {"sphere"});
  d.add("animation", &P::animation,
        "instead of mesh: the frames of an animation, files of meshes with the same triangles")
      .path()
      .identifies_item();
  d.add("frame", &P::frame, "frame of the animation, from 0, interpolated linearly; for a schedule to change")
      .between(0, 1e6);
  d.add("contraction", &P::contraction,
        "how far a mesh shrinks before it is grown, as the time of one implicit step of mean curvature flow "
        "over its area; `dress` finds it")
      .between(0, 1)
      .source("Desbrun et al. 1999");
  d.add("grown", &P::grown,
        "from the contracted mesh (0) to the whole one (1), linearly; for a schedule to change")
      .between(0, 1);
  d.add("strict", &P::strict,
        "whether a mesh that a cloth could not have is refused; otherwise it is repaired");
  d.add_section("cages", &P::cages, "closed surfaces around the obstacle that replace it on coarse levels");
  declare_file_coordinates(d);
  declare_scale(d);
}

Positions ObstacleGeometry::local_positions(double frame) const {
  const int last = static_cast<int>(frames.size()) - 1;
  const int k = std::clamp(static_cast<int>(std::floor(frame)), 0, std::max(0, last - 1));
  const double part = std::clamp(frame - k, 0.0, 1.0);
  const Positions& from = frames[k]->mesh.vertices;
  Positions positions =
      part == 0 || last == 0 ? from : Positions((1 - part) * from + part * frames[k + 1]->mesh.vertices);
  for (int c = 0; c < 3; ++c) positions.col(c) *= local_scale[c];
  return positions;
}

ObstacleMeshes ObstacleMeshes::of(const ObstacleParameters& p, int number) {
  try {
    ObstacleMeshes meshes = frames_of(p);
    if (!meshes.repair.empty()) meshes.repair = "obstacle " + name_of(p, number) + ": " + meshes.repair;
    if (p.cages.count > 0) meshes.cages = make_cages(*meshes.frames[0], p.cages);
    if (p.contraction > 0) {
      if (p.cages.count > 0) throw std::runtime_error("\"cages\" need a mesh without \"contraction\"");
      TriangleMesh small = meshes.frames[0]->mesh;
      small.vertices = contracted(small, p.contraction * surface_area(small));
      meshes.frames.insert(meshes.frames.begin(), ValidatedMesh::of(std::move(small)));
    }
    return meshes;
  } catch (const RefusedParameters& refused) {
    std::vector<ParameterFault> faults = refused.faults;
    for (ParameterFault& fault : faults) fault.message = fault_text(name_of(p, number), fault.message);
    throw RefusedParameters(std::move(faults));
  } catch (const std::exception& error) {
    throw std::runtime_error(fault_text(name_of(p, number), reason_of(error)));
  }
}

bool ObstacleMeshes::are_same(const ObstacleParameters& a, const ObstacleParameters& b) {
  return a.mesh == b.mesh && a.meshed_shape == b.meshed_shape && a.subdivisions == b.subdivisions &&
         a.animation == b.animation && a.contraction == b.contraction && a.strict == b.strict &&
         FileCoordinates(a) == FileCoordinates(b) && a.cages == b.cages;
}

Obstacle Obstacle::of(const ObstacleParameters& p, int number, const ObstacleMeshes& meshes, int level) {
  Obstacle body{name_of(p, number), p.friction, {}};
  ObstacleGeometry& geometry = body.geometry;
  geometry.frames = meshes.frames;
  geometry.pose = {p.scale, p.rotate, p.translate};
  if (p.frame != 0 && p.animation.empty())
    throw std::runtime_error(
        fault_text(body.name, "\"frame\" is of an \"animation\", which it does not have; leave it out"));
  if (p.contraction > 0) geometry.frame = p.grown;
  if (p.meshed_shape == "box") {
    geometry.local_scale = p.size;
  } else if (p.meshed_shape == "sphere") {
    geometry.local_scale.setConstant(p.radius);
  } else if (!p.animation.empty()) {
    const std::size_t last = meshes.frames.size() - 1;
    if (p.frame > static_cast<double>(last))
      throw std::runtime_error(fault_text(
          body.name,
          "the last frame of its animation is " + std::to_string(last) + "; choose a \"frame\" up to that"));
    geometry.frame = p.frame;
  }
  if (level < p.cages.count) {
    geometry.frames = {meshes.cages[level]};
    body.name += " (cage " + std::to_string(level) + ")";
  }
  return body;
}

TriangleMesh Obstacle::mesh() const {
  return {geometry.pose.applied_to(geometry.local_positions(geometry.frame)), triangles()};
}

ObstacleTopology topology_of(const std::vector<Obstacle>& bodies) {
  SurfaceTopology all;
  for (const Obstacle& body : bodies) all.append({body.triangles(), body.geometry.frames[0]->topology});
  return ObstacleTopology(std::move(all));
}

Obstacles Obstacles::of(std::vector<Obstacle> bodies, std::shared_ptr<const ObstacleTopology> topology) {
  Obstacles all;
  all.topology = std::move(topology);
  all.first_vertex = {0};
  for (const Obstacle& body : bodies)
    all.first_vertex.push_back(all.first_vertex.back() +
                               static_cast<int>(body.geometry.frames[0]->mesh.vertices.rows()));
  all.vertices.resize(all.first_vertex.back(), 3);
  all.local.resize(all.first_vertex.back(), 3);
  for (const Obstacle& body : bodies) {
    const Positions local = body.geometry.local_positions(body.geometry.frame);
    const int first = all.first_vertex[&body - bodies.data()];
    all.local.middleRows(first, local.rows()) = local;
    all.vertices.middleRows(first, local.rows()) = body.geometry.pose.applied_to(local);
    all.body_friction.push_back(body.friction);
  }
  all.bodies = std::move(bodies);
  return all;
}

}  // namespace drape::ipc
