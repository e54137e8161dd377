#pragma once

#include <memory>
#include <vector>

#include "core/numerics/contact/surface_contacts.h"
#include "tests/support/evaluate.h"
#include "tests/support/ipc_obstacles.h"

/// One vertex of weight 1 near a mesh, all of whose triangles are candidates; E = Σ coefficient b.
struct NearSurface {
  using Vector = Eigen::Vector3d;
  static constexpr double dhat = 0.01;
  drape::ipc::Obstacles obstacles;
  drape::Dihedrals dihedrals{obstacles};
  std::vector<drape::VertexTriangleCandidate> candidates;
  Eigen::VectorXd area = Eigen::VectorXd::Ones(1);
  drape::BarrierParameters parameters;

  explicit NearSurface(const drape::TriangleMesh& mesh)
      : obstacles(drape::ipc::obstacles_of({{"mesh", 0.5, {{drape::ipc::ValidatedMesh::of(mesh)}}}})) {
    parameters.dhat = dhat;
    parameters.stiffness = 1 / dhat;
    for (int t = 0; t < mesh.triangles.rows(); ++t) candidates.push_back({0, t});
  }
  std::vector<drape::SurfaceContact> contacts(const Vector& p) const {
    return drape::find_surface_contacts(p.transpose(), obstacles, dihedrals, candidates, area, 0, dhat);
  }
  /// Its only contact, without features if it has none.
  drape::SurfaceContact contact(const Vector& p) const {
    const std::vector<drape::SurfaceContact> all = contacts(p);
    return all.empty() ? drape::SurfaceContact{} : all.front();
  }
  std::vector<drape::NearestFeature> features(const Vector& p) const { return contact(p).features; }
  std::unique_ptr<drape::Collisions> set(const Vector& p) const {
    return make_collisions(parameters, contacts(p));
  }
  double value(const Vector& p) const { return set(p)->value(p.transpose()); }
};
