#include "plugins/contact/ipc/obstacle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/mesh/message_text.h"
#include "core/mesh/rotation.h"
#include "core/plugin/bounds.h"

namespace drape {
namespace {

using Frames = std::vector<std::shared_ptr<const SoundMesh>>;

/// What differs between the triangles of two files; empty if nothing does.
std::string difference(const Triangles& first, const Triangles& other) {
  const auto in_each = [](Eigen::Index a, Eigen::Index b, const std::string& what) {
    return "has " + std::to_string(b) + what + " and not " + std::to_string(a);
  };
  if (first.rows() != other.rows()) return in_each(first.rows(), other.rows(), " triangles");
  for (Eigen::Index t = 0; t < first.rows(); ++t)
    if (first.row(t) != other.row(t)) return "has other vertices in triangle " + std::to_string(t);
  return "";
}

Frames read_animation(const ObstacleParameters& p) {
  if (!p.file.empty()) throw std::runtime_error("\"file\" and \"animation\" exclude each other");
  if (p.cages.count > 0)
    throw std::runtime_error("\"cages\" are made around a mesh that keeps its form: leave out \"animation\"");
  Frames frames;
  for (const std::string& file : p.animation) {
    frames.push_back(sound_mesh_of(file));
    if (const auto what = difference(frames[0]->mesh.triangles, frames.back()->mesh.triangles); !what.empty())
      throw std::runtime_error(file + " " + what + " as " + p.animation[0] +
                               " has; all files of an animation must have the same triangles");
  }
  const int last = static_cast<int>(frames.size()) - 1;
  if (p.frame > last)
    throw std::runtime_error("its animation ends with frame " + std::to_string(last) +
                             ", the number of files less 1");
  return frames;
}

Form form_of(const ObstacleParameters& p) {
  Form form;
  form.pose = {p.scale, p.rotate, p.translate};
  if (p.shape == "box") {
    form.frames = {unit_box()};
    form.stretch = p.size;
  } else if (p.shape == "sphere") {
    form.frames = {unit_sphere(p.subdivisions)};
    form.stretch.setConstant(p.radius);
  } else if (!p.animation.empty()) {
    form.frames = read_animation(p);
    form.frame = p.frame;
  } else if (p.file.empty()) {
    throw std::runtime_error("\"shape: file\" needs \"file\", the mesh to read, or \"animation\"");
  } else {
    form.frames = {sound_mesh_of(p.file)};
  }
  return form;
}

}  // namespace

void ObstacleParameters::declare(Declaration<ObstacleParameters>& d) {
  using P = ObstacleParameters;
  d.add("name", &P::name).description("what messages call it; by default its shape and number");
  d.add("shape", &P::shape)
      .choices({"file", "box", "sphere"})
      .description(
          "what it is: a mesh from a file, a box about the origin, or a sphere about it whose vertices lie "
          "on the sphere");
  d.add("file", &P::file)
      .path()
      .description("shape file: the mesh (.obj, .off or .ply), relative to this file");
  d.add("size", &P::size)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description("shape box: its edges");
  d.add("radius", &P::radius)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description("shape sphere: its radius");
  d.add("subdivisions", &P::subdivisions)
      .at_least(0)
      .at_most(8)
      .description(
          "shape sphere: how often an icosahedron's triangles are cut in four, 20 · 4^subdivisions in all");
  d.add("animation", &P::animation)
      .path()
      .description("in place of file: meshes with the same triangles, which it takes the form of in turn");
  d.add("frame", &P::frame)
      .unit("1")
      .at_least(0)
      .at_most(1e6)
      .description(
          "which mesh of the animation it is, from 0 and linear in between; for a schedule to change");
  d.add_section("cages", &P::cages)
      .description("closed surfaces around it that coarse levels of the cloth meet in its place");
  d.add("scale", &P::scale)
      .unit("1")
      .at_least(1 / bounds::largest_scale)
      .at_most(bounds::largest_scale)
      .description("factor on its coordinates, the first of its moves");
  d.add("rotate", &P::rotate)
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("then turned about the x, then the y, then the z axis by these angles");
  d.add("translate", &P::translate)
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("then moved by this");
  d.add("friction", &P::friction)
      .unit("1")
      .at_least(0)
      .at_most(bounds::largest_friction)
      .description("its μ against the cloth, in place of the model's");
}

Eigen::Matrix3d Pose::linear() const { return scale * rotation_matrix(rotate); }

Positions Form::own_places(double frame) const {
  const int last = static_cast<int>(frames.size()) - 1;
  const int k = std::clamp(static_cast<int>(std::floor(frame)), 0, std::max(0, last - 1));
  const double part = std::clamp(frame - k, 0.0, 1.0);
  const Positions& from = frames[k]->mesh.vertices;
  Positions places =
      part == 0 || last == 0 ? from : Positions((1 - part) * from + part * frames[k + 1]->mesh.vertices);
  for (int c = 0; c < 3; ++c) places.col(c) *= stretch[c];
  return places;
}

Obstacle Obstacle::of(const ObstacleParameters& p, int number, int level) {
  Obstacle body{p.name.empty() ? p.shape + " " + std::to_string(number) : p.name, {}, p.friction, {}};
  try {
    body.form = form_of(p);
    if (p.cages.count > 0) {
      const auto cages = cages_of(body.form.frames[0], p.cages);
      if (level < p.cages.count)
        body.form.frames = {std::shared_ptr<const SoundMesh>(cages, (*cages)[level].get())};
    }
  } catch (const std::exception& error) {
    throw std::runtime_error("obstacle \"" + body.name + "\": " + reason_of(error));
  }
  if (level < p.cages.count) body.name += " (cage " + std::to_string(level) + ")";
  const Form& form = body.form;
  body.mesh.triangles = form.frames[0]->mesh.triangles;
  body.mesh.vertices = (form.own_places(form.frame) * form.pose.linear().transpose()).rowwise() +
                       form.pose.translate.transpose();
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
    all.surface.append(Surface::of(body.mesh, body.form.frames.empty() ? Topology::of(body.mesh.triangles, m)
                                                                       : body.form.frames[0]->topology));
  }
  all.dihedrals = Dihedrals::of(all.surface, all.vertices);
  all.bodies = std::move(bodies);
  return all;
}

int Obstacles::body_of(int vertex) const {
  const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
  return static_cast<int>(next - first_vertex.begin()) - 1;
}

}  // namespace drape
