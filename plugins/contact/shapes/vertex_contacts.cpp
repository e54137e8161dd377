#include "plugins/contact/shapes/vertex_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/kernel/contact/barrier.h"
#include "core/kernel/contact/friction.h"
#include "core/kernel/linear_algebra/parallel.h"

namespace drape::shapes {

namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
constexpr int grain = 1024;

struct Contact {
  int vertex, solid;
  double weight, friction;
  Nearest nearest;
  Derivatives barrier;  ///< by gap / d̂
};

class VertexCollisions final : public Collisions {
 public:
  VertexCollisions(std::vector<Contact> contacts, const BarrierParameters& parameters)
      : contacts_(std::move(contacts)), p_(parameters) {}

  int contact_count() const override { return static_cast<int>(contacts_.size()); }

  double smallest_gap() const override {
    double gap = std::numeric_limits<double>::infinity();
    for (const Contact& c : contacts_) gap = std::min(gap, c.nearest.distance);
    return gap;
  }

  double value(const Positions&) const override {
    double sum = 0;
    for (const Contact& c : contacts_) sum += c.weight * c.barrier.value;
    return p_.stiffness * p_.dhat * sum;
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    for (const Contact& c : contacts_) g.row(c.vertex) -= force(c) * c.nearest.normal.transpose();
    return value(x);
  }

  Stencils stencils() const override {
    Stencils result = Stencils::Constant(contact_count(), 4, -1);
    for (int i = 0; i < contact_count(); ++i) result(i, 0) = contacts_[i].vertex;
    return result;
  }

  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    for (int i = 0; i < contact_count(); ++i) {
      const Contact& c = contacts_[i];
      const Vector3d &n = c.nearest.normal, &a = c.nearest.tangent, b = n.cross(a);
      const Eigen::Vector2d curvature_terms = -force(c) * c.nearest.curvature;  // ≤ 0 for convex solids
      const Eigen::Vector2d across(projection.map(curvature_terms[0]), projection.map(curvature_terms[1]));
      const Matrix3d h = p_.stiffness * c.weight / p_.dhat * c.barrier.second * n * n.transpose() +
                         across[0] * a * a.transpose() + across[1] * b * b.transpose();
      sink.add(i, 0, 0, h.data());
    }
  }

  std::unique_ptr<FrictionEnergy> friction(const Positions& reference,
                                           const TangentialDisplacements& displacements) const override {
    std::vector<FrictionContact> frictions;
    for (const Contact& c : contacts_)
      if (c.friction > 0)
        frictions.push_back({{c.vertex, c.solid, -1, -1, -1},  // -1: no second primitive
                             {c.vertex, -1, -1, -1},
                             {1, 0, 0, 0},
                             c.nearest.normal,
                             c.friction * force(c)});
    return make_friction(std::move(frictions), reference, displacements, p_.friction_smoothing_distance);
  }

 private:
  /// The normal force [N].
  double force(const Contact& c) const { return -p_.stiffness * c.weight * c.barrier.first; }

  std::vector<Contact> contacts_;
  BarrierParameters p_;
};

}  // namespace

std::unique_ptr<Collisions> make_vertex_contacts(const Positions& x, const std::vector<Solid>& solids,
                                                 const std::vector<VertexSolidPair>& pairs,
                                                 const BarrierParameters& parameters) {
  std::vector<char> is_near(pairs.size());
  parallel_for(static_cast<int>(pairs.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      is_near[i] = solids[pairs[i].solid].distance(x.row(pairs[i].vertex)) < parameters.dhat;
  });
  std::vector<VertexSolidPair> close;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (is_near[i]) close.push_back(pairs[i]);
  std::vector<Contact> contacts(close.size());
  parallel_for(static_cast<int>(close.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Solid& solid = solids[close[i].solid];
      const Nearest nearest = solid.nearest(x.row(close[i].vertex));
      contacts[i] = {close[i].vertex, close[i].solid, close[i].weight,
                     solid.friction,  nearest,        barrier(nearest.distance / parameters.dhat)};
    }
  });
  return std::make_unique<VertexCollisions>(std::move(contacts), parameters);
}

}  // namespace drape::shapes
