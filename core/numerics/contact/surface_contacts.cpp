#include "core/numerics/contact/surface_contacts.h"

#include <algorithm>
#include <limits>
#include <span>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/projected_matrix.h"
#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr int features_per_task = 1024;

class SurfaceCollisions final : public Collisions {
 public:
  SurfaceCollisions(SurfaceContacts contacts, const BarrierParameters& parameters)
      : contacts_(std::move(contacts)), p_(parameters), barriers_(contacts_.items.size()) {
    parallel_for(feature_count(), features_per_task, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) barriers_[i] = barrier(feature(i).distance / p_.dhat);
    });
    double sum = 0;
    for (int i = 0; i < feature_count(); ++i) {
      smallest_gap_ = std::min(smallest_gap_, feature(i).distance);
      sum += feature(i).area * feature(i).coefficient * barriers_[i].value;
    }
    // For a gap of 0 the sum would be ∞ - ∞.
    value_ = smallest_gap_ > 0 ? p_.stiffness * p_.dhat * sum : std::numeric_limits<double>::infinity();
  }

  int contact_count() const override { return feature_count(); }
  double smallest_gap() const override { return smallest_gap_; }
  void append_gaps(std::vector<double>& gaps) const override {
    for (int k = 0; k < vertex_count(); ++k)
      gaps.push_back(std::ranges::min(contacts_.row(k), {}, &NearestFeature::distance).distance);
  }
  /// A negative coefficient takes a force away that other features of the surface count twice.
  NormalForces normal_forces() const override {
    NormalForces forces;
    for (int i = 0; i < feature_count(); ++i)
      forces.add(-stiffness(i) * barriers_[i].first, barriers_[i].first);
    return forces;
  }
  double value(const Positions&) const override { return value_; }

  double add_gradient(const Positions&, Positions& g) const override {
    for (int i = 0; i < feature_count(); ++i)
      g.row(feature(i).cloth_vertex) += stiffness(i) * barriers_[i].first * feature(i).normal.transpose();
    return value_;
  }

  Stencils stencils() const override {
    Stencils result = Stencils::Constant(vertex_count(), 4, -1);
    for (int k = 0; k < vertex_count(); ++k) result(k, 0) = feature(contacts_.start[k]).cloth_vertex;
    return result;
  }

  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    for (int k = 0; k < vertex_count(); ++k) {
      Matrix3d h = Matrix3d::Zero();
      for (int i = contacts_.start[k]; i < contacts_.start[k + 1]; ++i) h += stiffness(i) * curvature(i);
      // The Hessian b'' n nᵀ of a single plane is positive semidefinite.
      const NearestFeature& first = feature(contacts_.start[k]);
      const bool is_one_plane = contacts_.size(k) == 1 && first.is_face() && first.coefficient > 0;
      if (!projection.is_exact() && !is_one_plane) h = projected_matrix(h, projection);
      sink.add(k, 0, 0, h.data());
    }
  }

  void append_friction_contacts(FrictionContacts& groups) const override {
    std::vector<FrictionContact>& frictions = groups.emplace_back();
    for (int k = 0; k < vertex_count(); ++k) {
      const std::span<const NearestFeature> features = contacts_.row(k);
      if (std::ranges::none_of(features, [](const NearestFeature& f) { return f.friction > 0; })) continue;
      const std::vector<double> pressures = pressures_of(features, p_.dhat);
      for (std::size_t i = 0; i < features.size(); ++i) {
        const NearestFeature& f = features[i];
        const double force = f.friction * p_.stiffness * pressures[i];
        if (force > 0)
          frictions.push_back({{f.cloth_vertex, -2, f.vertices[0], f.vertices[1], f.vertices[2]},
                               {f.cloth_vertex, -1, -1, -1},
                               {1, 0, 0, 0},
                               f.normal,
                               force,
                               {f.body, f.vertices, f.weights}});
      }
    }
  }
  double friction_smoothing_distance() const override { return p_.friction_smoothing_distance; }

 private:
  int vertex_count() const { return static_cast<int>(contacts_.start.size()) - 1; }
  int feature_count() const { return static_cast<int>(contacts_.items.size()); }
  const NearestFeature& feature(int i) const { return contacts_.items[i]; }
  double stiffness(int i) const { return p_.stiffness * feature(i).area * feature(i).coefficient; }

  /// The Hessian of d̂ b(distance / d̂).
  Matrix3d curvature(int i) const {
    const NearestFeature& f = feature(i);
    Matrix3d h = barriers_[i].second / p_.dhat * f.normal * f.normal.transpose();
    if (!f.is_face())
      h += barriers_[i].first / f.distance *
           (Matrix3d::Identity() - f.normal * f.normal.transpose() - f.along * f.along.transpose());
    return h;
  }

  SurfaceContacts contacts_;
  BarrierParameters p_;
  std::vector<Derivatives> barriers_;  // of each feature, by distance / d̂
  double value_ = 0, smallest_gap_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<double> pressures_of(std::span<const NearestFeature> f, double dhat) {
  const int count = static_cast<int>(f.size());
  std::vector<double> pressures(count);
  for (int i = 0; i < count; ++i)
    pressures[i] = -f[i].area * f[i].coefficient * barrier(f[i].distance / dhat).first;
  for (int i = 0; i < count; ++i) {
    while (pressures[i] < 0) {
      int most_similar = -1;
      for (int k = 0; k < count; ++k)
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

std::unique_ptr<Collisions> make_surface_contacts(SurfaceContacts contacts,
                                                  const BarrierParameters& parameters) {
  return std::make_unique<SurfaceCollisions>(std::move(contacts), parameters);
}

}  // namespace drape
