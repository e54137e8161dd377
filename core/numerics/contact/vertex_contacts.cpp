#include "core/numerics/contact/vertex_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {

namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
constexpr int vertex_contacts_per_task = 1024;

class VertexCollisions final : public Collisions {
 public:
  VertexCollisions(std::vector<VertexContact> contacts, const BarrierParameters& parameters)
      : contacts_(std::move(contacts)), barriers_(contacts_.size()), p_(parameters) {
    parallel_for(contact_count(), vertex_contacts_per_task, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) barriers_[i] = barrier(contacts_[i].nearest.distance / p_.dhat);
    });
  }

  int contact_count() const override { return static_cast<int>(contacts_.size()); }

  double smallest_gap() const override {
    double gap = std::numeric_limits<double>::infinity();
    for (const VertexContact& c : contacts_) gap = std::min(gap, c.nearest.distance);
    return gap;
  }

  void append_gaps(std::vector<double>& gaps) const override {
    for (const VertexContact& c : contacts_) gaps.push_back(c.nearest.distance);
  }

  NormalForces normal_forces() const override {
    NormalForces forces;
    for (int i = 0; i < contact_count(); ++i) forces.add(force(i), barriers_[i].first);
    return forces;
  }
  double value(const Positions&) const override {
    double sum = 0;
    for (int i = 0; i < contact_count(); ++i) sum += contacts_[i].weight * barriers_[i].value;
    return p_.stiffness * p_.dhat * sum;
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    for (int i = 0; i < contact_count(); ++i)
      g.row(contacts_[i].vertex) -= force(i) * contacts_[i].nearest.normal.transpose();
    return value(x);
  }

  Stencils stencils() const override {
    Stencils result = Stencils::Constant(contact_count(), 4, -1);
    for (int i = 0; i < contact_count(); ++i) result(i, 0) = contacts_[i].vertex;
    return result;
  }

  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    for (int i = 0; i < contact_count(); ++i) {
      const VertexContact& c = contacts_[i];
      const Vector3d &n = c.nearest.normal, &a = c.nearest.tangent, b = n.cross(a);
      const Eigen::Vector2d curvature_terms = -force(i) * c.nearest.curvature;  // ≤ 0 for convex obstacles
      const Eigen::Vector2d across(projection.map(curvature_terms[0]), projection.map(curvature_terms[1]));
      const Matrix3d h = p_.stiffness * c.weight / p_.dhat * barriers_[i].second * n * n.transpose() +
                         across[0] * a * a.transpose() + across[1] * b * b.transpose();
      sink.add(i, 0, 0, h.data());
    }
  }

  void append_friction_contacts(FrictionContacts& groups) const override {
    std::vector<FrictionContact>& frictions = groups.emplace_back();
    for (int i = 0; i < contact_count(); ++i)
      if (const VertexContact& c = contacts_[i]; c.friction > 0)
        frictions.push_back({{c.vertex, c.obstacle, -1, -1, -1},  // -1: no second primitive
                             {c.vertex, -1, -1, -1},
                             {1, 0, 0, 0},
                             c.nearest.normal,
                             c.friction * force(i),
                             {c.obstacle, {-1, -1, -1}, Vector3d::Zero(), c.touched}});
  }
  double friction_smoothing_distance() const override { return p_.friction_smoothing_distance; }

 private:
  /// The normal force [N].
  double force(int i) const { return -p_.stiffness * contacts_[i].weight * barriers_[i].first; }

  std::vector<VertexContact> contacts_;
  std::vector<Derivatives> barriers_;  // by distance / d̂
  BarrierParameters p_;
};

}  // namespace

std::unique_ptr<Collisions> make_vertex_contacts(std::vector<VertexContact> contacts,
                                                 const BarrierParameters& parameters) {
  return std::make_unique<VertexCollisions>(std::move(contacts), parameters);
}

}  // namespace drape
