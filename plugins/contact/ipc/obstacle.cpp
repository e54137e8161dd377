#include "plugins/contact/ipc/obstacle.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/mesh/turn.h"

namespace drape {
namespace {

Form form_of(const ObstacleParameters& p) {
  Form form;
  form.pose = {p.scale, p.rotate, p.translate};
  if (p.shape == "box") {
    form.frames = {unit_box()};
    form.stretch = p.size;
  } else if (p.shape == "sphere") {
    form.frames = {unit_sphere(p.subdivisions)};
    form.stretch.setConstant(p.radius);
  } else if (p.file.empty()) {
    throw std::runtime_error("\"shape: file\" needs \"file\", the mesh to read");
  } else {
    form.frames = {sound_mesh_of(p.file)};
  }
  return form;
}

}  // namespace

void ObstacleParameters::declare(Declaration<ObstacleParameters>& d) {
  using P = ObstacleParameters;
  d.add("name", &P::name).meaning("what messages call it; by default its shape and number");
  d.add("shape", &P::shape)
      .choices({"file", "box", "sphere"})
      .meaning(
          "what it is: a mesh from a file, a box about the origin, or a sphere about it whose vertices lie "
          "on the sphere");
  d.add("file", &P::file).path().meaning("shape file: the mesh (.obj, .off or .ply), relative to this file");
  d.add("size", &P::size).unit("m").above(0).meaning("shape box: its edges");
  d.add("radius", &P::radius).unit("m").above(0).meaning("shape sphere: its radius");
  d.add("subdivisions", &P::subdivisions)
      .at_least(0)
      .at_most(8)
      .meaning(
          "shape sphere: how often an icosahedron's triangles are cut in four, 20 · 4^subdivisions in all");
  d.add("scale", &P::scale).unit("1").above(0).meaning("factor on its coordinates, the first of its moves");
  d.add("rotate", &P::rotate)
      .unit("degree")
      .meaning("then turned about the x, then the y, then the z axis by these angles");
  d.add("translate", &P::translate).unit("m").meaning("then moved by this");
  d.add("friction", &P::friction)
      .unit("1")
      .at_least(0)
      .meaning("its μ against the cloth, in place of the model's");
}

Eigen::Matrix3d Pose::linear() const { return scale * turned(rotate); }

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

Obstacle Obstacle::of(const ObstacleParameters& p, int number) {
  Obstacle body{p.name.empty() ? p.shape + " " + std::to_string(number) : p.name, {}, p.friction, {}};
  try {
    body.form = form_of(p);
  } catch (const std::exception& error) {
    throw std::runtime_error("obstacle \"" + body.name + "\": " + error.what());
  }
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
  all.bodies = std::move(bodies);
  return all;
}

int Obstacles::body_of(int vertex) const {
  const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
  return static_cast<int>(next - first_vertex.begin()) - 1;
}

}  // namespace drape
