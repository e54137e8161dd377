#include "core/numerics/contact/surface_contacts.h"

#include <algorithm>
#include <limits>

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
  SurfaceCollisions(SurfaceContacts all, const BarrierParameters& parameters)
      : all_(std::move(all)), p_(parameters), barriers_(all_.features.size()) {
    parallel_for(static_cast<int>(barriers_.size()), features_per_task, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) barriers_[i] = barrier(all_.features[i].distance / p_.dhat);
    });
    double sum = 0;
    for (const SurfaceContact& contact : all_.contacts)
      for (int i = contact.first; i < contact.last; ++i) {
        const NearestFeature& f = all_.features[i];
        smallest_gap_ = std::min(smallest_gap_, f.distance);
        sum += contact.weight * f.coefficient * barriers_[i].value;
      }
    // For a gap of 0 the sum would be ∞ - ∞.
    value_ = smallest_gap_ > 0 ? p_.stiffness * p_.dhat * sum : std::numeric_limits<double>::infinity();
  }

  int contact_count() const override { return static_cast<int>(all_.features.size()); }
  double smallest_gap() const override { return smallest_gap_; }
  void append_gaps(std::vector<double>& gaps) const override {
    for (const SurfaceContact& contact : all_.contacts) {
      double gap = std::numeric_limits<double>::infinity();
      for (int i = contact.first; i < contact.last; ++i) gap = std::min(gap, all_.features[i].distance);
      gaps.push_back(gap);
    }
  }
  /// A negative coefficient takes a force away that other features of the surface count twice.
  NormalForces normal_forces() const override {
    NormalForces forces;
    for (const SurfaceContact& contact : all_.contacts)
      for (int i = contact.first; i < contact.last; ++i)
        forces.add(-stiffness(contact, i) * barriers_[i].first, barriers_[i].first);
    return forces;
  }
  double value(const Positions&) const override { return value_; }

  double add_gradient(const Positions&, Positions& g) const override {
    for (const SurfaceContact& contact : all_.contacts)
      for (int i = contact.first; i < contact.last; ++i)
        g.row(contact.vertex) +=
            stiffness(contact, i) * barriers_[i].first * all_.features[i].normal.transpose();
    return value_;
  }

  Stencils stencils() const override {
    Stencils result = Stencils::Constant(vertex_count(), 4, -1);
    for (int i = 0; i < vertex_count(); ++i) result(i, 0) = all_.contacts[i].vertex;
    return result;
  }

  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    for (int k = 0; k < vertex_count(); ++k) {
      const SurfaceContact& contact = all_.contacts[k];
      Matrix3d h = Matrix3d::Zero();
      for (int i = contact.first; i < contact.last; ++i) h += stiffness(contact, i) * curvature(i);
      // The Hessian b'' n nᵀ of a single plane is positive semidefinite.
      const NearestFeature& first = all_.features[contact.first];
      const bool is_one_plane = contact.last == contact.first + 1 && first.is_face() && first.coefficient > 0;
      if (!projection.is_exact() && !is_one_plane) h = projected_matrix(h, projection);
      sink.add(k, 0, 0, h.data());
    }
  }

  void append_friction_contacts(FrictionContacts& groups) const override {
    std::vector<FrictionContact>& frictions = groups.emplace_back();
    for (const SurfaceContact& contact : all_.contacts) {
      if (!has_friction(contact)) continue;
      const std::vector<double> pressures = all_.pressures(contact, p_.dhat);
      for (int i = contact.first; i < contact.last; ++i) {
        const NearestFeature& f = all_.features[i];
        const double force = f.friction * p_.stiffness * pressures[i - contact.first];
        if (force > 0)
          frictions.push_back({{contact.vertex, -2, f.vertices[0], f.vertices[1], f.vertices[2]},
                               {contact.vertex, -1, -1, -1},
                               {1, 0, 0, 0},
                               f.normal,
                               force,
                               {f.body, f.vertices, f.weights}});
      }
    }
  }
  double friction_smoothing_distance() const override { return p_.friction_smoothing_distance; }

 private:
  int vertex_count() const { return static_cast<int>(all_.contacts.size()); }

  bool has_friction(const SurfaceContact& contact) const {
    return std::any_of(all_.features.begin() + contact.first, all_.features.begin() + contact.last,
                       [](const NearestFeature& feature) { return feature.friction > 0; });
  }

  double stiffness(const SurfaceContact& contact, int i) const {
    return p_.stiffness * contact.weight * all_.features[i].coefficient;
  }

  /// The Hessian of d̂ b(distance / d̂).
  Matrix3d curvature(int i) const {
    const NearestFeature& f = all_.features[i];
    Matrix3d h = barriers_[i].second / p_.dhat * f.normal * f.normal.transpose();
    if (!f.is_face())
      h += barriers_[i].first / f.distance *
           (Matrix3d::Identity() - f.normal * f.normal.transpose() - f.along * f.along.transpose());
    return h;
  }

  SurfaceContacts all_;
  BarrierParameters p_;
  std::vector<Derivatives> barriers_;  // of each feature, by distance / d̂
  double value_ = 0, smallest_gap_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<double> SurfaceContacts::pressures(const SurfaceContact& contact, double dhat) const {
  const int count = contact.last - contact.first;
  const NearestFeature* f = features.data() + contact.first;
  std::vector<double> pressures(count);
  for (int i = 0; i < count; ++i)
    pressures[i] = -contact.weight * f[i].coefficient * barrier(f[i].distance / dhat).first;
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
