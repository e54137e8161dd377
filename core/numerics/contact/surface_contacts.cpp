#include "core/numerics/contact/surface_contacts.h"

#include "core/numerics/contact/projected_matrix.h"

namespace drape {
namespace {

using Eigen::Matrix3d;

Derivatives feature_barrier(const NearestFeature& f, double dhat) { return barrier(f.distance / dhat); }

double feature_stiffness(const NearestFeature& f, const BarrierParameters& p) {
  return p.stiffness * f.area * f.coefficient;
}

/// The Hessian of d̂ b(distance / d̂).
Matrix3d feature_curvature(const NearestFeature& f, double dhat) {
  const Derivatives b = feature_barrier(f, dhat);
  Matrix3d h = b.second / dhat * f.normal * f.normal.transpose();
  if (!f.is_face())
    h += b.first / f.distance *
         (Matrix3d::Identity() - f.normal * f.normal.transpose() - f.along * f.along.transpose());
  return h;
}

}  // namespace

void SurfaceContact::add_energy(const BarrierParameters& p, double& sum) const {
  for (const NearestFeature& f : features) sum += f.area * f.coefficient * feature_barrier(f, p.dhat).value;
}

void SurfaceContact::add_gradient(const BarrierParameters& p, Positions& g) const {
  for (const NearestFeature& f : features)
    g.row(vertex) += feature_stiffness(f, p) * feature_barrier(f, p.dhat).first * f.normal.transpose();
}

void SurfaceContact::hessians(std::span<const SurfaceContact> contacts, const BarrierParameters& p,
                              Projection projection, ContactBlocks<1>* blocks) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const std::vector<NearestFeature>& features = contacts[i].features;
    Matrix3d h = Matrix3d::Zero();
    for (const NearestFeature& f : features) h += feature_stiffness(f, p) * feature_curvature(f, p.dhat);
    // The Hessian b'' n nᵀ of a single plane is positive semidefinite.
    const NearestFeature& first = features.front();
    const bool is_one_plane = features.size() == 1 && first.is_face() && first.coefficient > 0;
    if (!projection.is_exact() && !is_one_plane) h = projected_matrix(h, projection);
    std::copy_n(h.data(), 9, blocks[i].block[0]);
  }
}

void SurfaceContact::add_normal_forces(const BarrierParameters& p, NormalForces& forces) const {
  for (const NearestFeature& f : features) {
    const double slope = feature_barrier(f, p.dhat).first;
    forces.add(-feature_stiffness(f, p) * slope, slope);
  }
}

void SurfaceContact::append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const {
  if (std::ranges::none_of(features, [](const NearestFeature& f) { return f.friction > 0; })) return;
  const std::vector<double> all_pressures = pressures(p.dhat);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const NearestFeature& f = features[i];
    const double force = f.friction * p.stiffness * all_pressures[i];
    if (force > 0)
      all.push_back({{vertex, -2, f.vertices[0], f.vertices[1], f.vertices[2]},
                     vertices(),
                     {1, 0, 0, 0},
                     f.normal,
                     force,
                     {f.body, f.vertices, f.weights}});
  }
}

std::vector<double> SurfaceContact::pressures(double dhat) const {
  const std::vector<NearestFeature>& f = features;
  const int size = count();
  std::vector<double> pressures(size);
  for (int i = 0; i < size; ++i)
    pressures[i] = -f[i].area * f[i].coefficient * feature_barrier(f[i], dhat).first;
  for (int i = 0; i < size; ++i) {
    while (pressures[i] < 0) {
      int most_similar = -1;
      for (int k = 0; k < size; ++k)
        if (pressures[k] > 0 &&
            (most_similar < 0 || f[k].normal.dot(f[i].normal) > f[most_similar].normal.dot(f[i].normal)))
          most_similar = k;
      const double amount =
          most_similar < 0 ? -pressures[i] : std::min(-pressures[i], pressures[most_similar]);
      if (most_similar >= 0) pressures[most_similar] -= amount;
      pressures[i] = amount == -pressures[i] ? 0 : pressures[i] + amount;
    }
  }
  return pressures;
}

}  // namespace drape
