#include "plugins/contact/ipc/obstacle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "core/mesh/check.h"
#include "core/mesh/io.h"

namespace drape {
namespace {

TriangleMesh box(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  mesh.vertices.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    for (int k = 0; k < 3; ++k) mesh.vertices(v, k) = ((v >> k & 1) - 0.5) * size[k];
  mesh.triangles.resize(12, 3);
  mesh.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,  // z
      0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,                // y
      0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5;                // x
  return mesh;
}

TriangleMesh icosahedron() {
  const double a = 1, b = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.vertices.resize(12, 3);
  mesh.vertices << -a, b, 0, a, b, 0, -a, -b, 0, a, -b, 0, 0, -a, b, 0, a, b, 0, -a, -b, 0, a, -b, b, 0, -a,
      b, 0, a, -b, 0, -a, -b, 0, a;
  mesh.triangles.resize(20, 3);
  mesh.triangles << 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6,
      7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1;
  mesh.vertices.rowwise().normalize();
  return mesh;
}

/// Every triangle in four, new vertices on the unit sphere.
TriangleMesh split_on_sphere(const TriangleMesh& coarse) {
  const int n = static_cast<int>(coarse.vertices.rows());
  const Topology topology = Topology::of(coarse.triangles, n);
  TriangleMesh fine;
  fine.vertices.resize(n + topology.edges.rows(), 3);
  fine.vertices.topRows(n) = coarse.vertices;
  for (int e = 0; e < topology.edges.rows(); ++e)
    fine.vertices.row(n + e) =
        (coarse.vertices.row(topology.edges(e, 0)) + coarse.vertices.row(topology.edges(e, 1))).normalized();
  fine.triangles.resize(4 * coarse.triangles.rows(), 3);
  for (int t = 0; t < coarse.triangles.rows(); ++t) {
    const auto v = coarse.triangles.row(t);
    const Eigen::RowVector3i e = topology.triangle_edges.row(t).array() + n;
    fine.triangles.middleRows<4>(4 * t) << v[0], e[2], e[1], v[1], e[0], e[2], v[2], e[1], e[0], e[0], e[1],
        e[2];
  }
  return fine;
}

TriangleMesh sphere(double radius, int subdivisions) {
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = split_on_sphere(mesh);
  mesh.vertices *= radius;
  return mesh;
}

TriangleMesh mesh_of(const ObstacleParameters& p) {
  if (p.shape == "box") return box(p.size);
  if (p.shape == "sphere") return sphere(p.radius, p.subdivisions);
  if (p.file.empty()) throw std::runtime_error("\"shape: file\" needs \"file\", the mesh to read");
  return read_mesh(p.file);
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
  d.add("size", &P::size).unit("m").meaning("shape box: its edges");
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

Obstacle Obstacle::of(const ObstacleParameters& p, int number) {
  Obstacle body{p.name.empty() ? p.shape + " " + std::to_string(number) : p.name, {}, p.friction};
  std::vector<std::string> faults;
  try {
    body.mesh = mesh_of(p);
    faults = check_mesh(body.mesh);
  } catch (const std::exception& error) {
    faults = {error.what()};
  }
  if (!faults.empty()) throw std::runtime_error("obstacle \"" + body.name + "\": " + faults[0]);
  const double degree = M_PI / 180;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(p.rotate.z() * degree, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(p.rotate.y() * degree, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(p.rotate.x() * degree, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  body.mesh.vertices = (p.scale * body.mesh.vertices * turn.transpose()).rowwise() + p.translate.transpose();
  return body;
}

Obstacles Obstacles::of(std::vector<Obstacle> bodies) {
  Obstacles all;
  all.first_vertex = {0};
  TriangleMesh joined;
  for (const Obstacle& body : bodies) {
    const int n = all.first_vertex.back(), m = static_cast<int>(joined.triangles.rows());
    joined.vertices.conservativeResize(n + body.mesh.vertices.rows(), 3);
    joined.vertices.bottomRows(body.mesh.vertices.rows()) = body.mesh.vertices;
    joined.triangles.conservativeResize(m + body.mesh.triangles.rows(), 3);
    joined.triangles.bottomRows(body.mesh.triangles.rows()) = body.mesh.triangles.array() + n;
    all.first_vertex.push_back(static_cast<int>(joined.vertices.rows()));
  }
  all.surface = Surface::of(joined, Topology::of(joined.triangles, static_cast<int>(joined.vertices.rows())));
  all.vertices = std::move(joined.vertices);
  all.bodies = std::move(bodies);
  return all;
}

int Obstacles::body_of(int vertex) const {
  const auto next = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
  return static_cast<int>(next - first_vertex.begin()) - 1;
}

}  // namespace drape
