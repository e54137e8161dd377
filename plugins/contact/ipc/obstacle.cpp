#include "plugins/contact/ipc/obstacle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "core/numerics/mesh/rotation.h"

namespace drape::ipc {
namespace {

LoadedMeshes frames_of(const ObstacleParameters& p) {
  const int named = int(!p.mesh.empty()) + int(p.meshed_shape.has_value()) + int(!p.animation.empty());
  if (named != 1)
    throw std::runtime_error("needs exactly one of \"mesh\", \"meshed_shape\" and \"animation\"");
  if (p.meshed_shape && FileCoordinates(p) != FileCoordinates())
    throw std::runtime_error(
        "\"unit\" and \"up\" say how a mesh file is read; a meshed_shape is in metres: leave them out");
  if (p.meshed_shape == "box") return {{validated_box()}, {}};
  if (p.meshed_shape == "sphere") return {{validated_sphere(p.subdivisions)}, {}};
  if (p.animation.empty()) return load_validated_meshes({p.mesh}, p, p.strict);
  if (p.cages.count > 0) throw std::runtime_error("\"cages\" need a mesh without \"animation\"");
  return load_validated_meshes(p.animation, p, p.strict);
}

std::string name_of(const ObstacleParameters& p, int number) {
  return p.name.empty() ? p.meshed_shape.value_or("mesh") + " " + std::to_string(number) : p.name;
}

std::string fault_text(const std::string& name, const std::string& what) {
  return "obstacle \"" + name + "\": " + what;
}

std::runtime_error fault_of(const std::string& name, const std::string& what) {
  return std::runtime_error(fault_text(name, what));
}

}  // namespace

void ObstacleParameters::declare(Declaration<ObstacleParameters>& d) {
  using P = ObstacleParameters;
  declare_obstacle(d);
  d.add("mesh", &P::mesh)
      .path()
      .identifies_item()
      .description("a mesh file (.obj, .off, .ply or .stl), relative to this file");
  d.add("meshed_shape", &P::meshed_shape)
      .choices({"box", "sphere"})
      .identifies_item()
      .description("instead of mesh: a triangulated box or an icosphere, centred at the origin");
  d.add("size", &P::size)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .only_with("meshed_shape", {"box"})
      .description("edge lengths of a box");
  d.add("radius", &P::radius)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .only_with("meshed_shape", {"sphere"})
      .description("radius of a sphere");
  d.add("subdivisions", &P::subdivisions)
      .at_least(0)
      .at_most(8)
      .only_with("meshed_shape", {"sphere"})
      .description(
          "how often a sphere's icosahedron is subdivided; the sphere has 20 · 4^subdivisions triangles");
  d.add("animation", &P::animation)
      .path()
      .identifies_item()
      .description("instead of mesh: the frames of an animation, files of meshes with the same triangles");
  d.add("frame", &P::frame)
      .unit("1")
      .at_least(0)
      .at_most(1e6)
      .description("frame of the animation, from 0, interpolated linearly; for a schedule to change");
  d.add("strict", &P::strict)
      .description("whether a mesh that a cloth could not have is refused; otherwise it is repaired");
  d.add_section("cages", &P::cages)
      .description("closed surfaces around the obstacle that replace it on coarse levels");
  declare_file_coordinates(d);
  declare_scale(d);
}

Eigen::Matrix3d Pose::linear() const { return scale * rotation_matrix(rotate); }

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
    LoadedMeshes loaded = frames_of(p);
    ObstacleMeshes meshes{std::move(loaded.meshes), {}, loaded.repair.text()};
    if (!meshes.repair.empty()) meshes.repair = "obstacle " + name_of(p, number) + ": " + meshes.repair;
    if (p.cages.count > 0) meshes.cages = make_cages(*meshes.frames[0], p.cages);
    return meshes;
  } catch (const RefusedParameters& refused) {
    std::vector<ParameterFault> faults = refused.faults;
    for (ParameterFault& fault : faults) fault.message = fault_text(name_of(p, number), fault.message);
    throw RefusedParameters(std::move(faults));
  } catch (const std::exception& error) {
    throw fault_of(name_of(p, number), reason_of(error));
  }
}

bool ObstacleMeshes::are_same(const ObstacleParameters& a, const ObstacleParameters& b) {
  return a.mesh == b.mesh && a.meshed_shape == b.meshed_shape && a.subdivisions == b.subdivisions &&
         a.animation == b.animation && a.strict == b.strict && FileCoordinates(a) == FileCoordinates(b) &&
         a.cages == b.cages;
}

Obstacle Obstacle::of(const ObstacleParameters& p, int number, const ObstacleMeshes& meshes, int level) {
  Obstacle body{name_of(p, number), {}, p.friction, {}};
  ObstacleGeometry& geometry = body.geometry;
  geometry.frames = meshes.frames;
  geometry.pose = {p.scale, p.rotate, p.translate};
  if (p.meshed_shape == "box") {
    geometry.local_scale = p.size;
  } else if (p.meshed_shape == "sphere") {
    geometry.local_scale.setConstant(p.radius);
  } else if (!p.animation.empty()) {
    const std::size_t last = meshes.frames.size() - 1;
    if (p.frame > static_cast<double>(last))
      throw fault_of(body.name, "the last frame of its animation is " + std::to_string(last) +
                                    "; choose a \"frame\" up to that");
    geometry.frame = p.frame;
  }
  if (level < p.cages.count) {
    geometry.frames = {meshes.cages[level]};
    body.name += " (cage " + std::to_string(level) + ")";
  }
  body.mesh.triangles = geometry.frames[0]->mesh.triangles;
  body.mesh.vertices =
      (geometry.local_positions(geometry.frame) * geometry.pose.linear().transpose()).rowwise() +
      geometry.pose.translate.transpose();
  return body;
}

Obstacles Obstacles::of(std::vector<Obstacle> bodies) {
  Obstacles all;
  all.first_vertex = {0};
  for (const Obstacle& body : bodies) {
    const int n = all.first_vertex.back(), m = static_cast<int>(body.mesh.vertices.rows());
    all.vertices.conservativeResize(n + m, 3);
    all.vertices.bottomRows(m) = body.mesh.vertices;
    all.first_vertex.push_back(n + m);
    all.body_friction.push_back(body.friction);
    all.surface.append(Surface::of(body.mesh, body.geometry.frames.empty()
                                                  ? Topology::of_any(body.mesh.triangles, m)
                                                  : body.geometry.frames[0]->topology));
  }
  all.dihedrals = Dihedrals::of(all.surface, all.vertices);
  all.bodies = std::move(bodies);
  return all;
}

}  // namespace drape::ipc
