#include "plugins/contact/shapes/vertex_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/contact/barrier.h"
#include "core/contact/friction.h"
#include "core/numerics/parallel.h"

namespace drape {

namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
constexpr int grain = 1024;

struct Contact {
  int vertex, solid;
  double weight, friction;
  Nearest nearest;
  Derivatives barrier;  ///< by gap / d̂
};

class VertexContacts final : public ContactSet {
 public:
  VertexContacts(std::vector<Contact> contacts, const BarrierParameters& parameters)
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
    return p_.stiffness * p_.range * sum;
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
      const Eigen::Vector2d bent = -force(c) * c.nearest.curvature;  // ≤ 0, as solids are convex
      const Eigen::Vector2d across(projection.map(bent[0]), projection.map(bent[1]));
      const Matrix3d h = p_.stiffness * c.weight / p_.range * c.barrier.second * n * n.transpose() +
                         across[0] * a * a.transpose() + across[1] * b * b.transpose();
      sink.add(i, 0, 0, h.data());
    }
  }

  std::unique_ptr<FrictionEnergy> friction(const Positions& from, const Slips& slips) const override {
    std::vector<FrictionContact> frictions;
    for (const Contact& c : contacts_)
      if (c.friction > 0)
        frictions.push_back({{c.vertex, c.solid, -1, -1, -1},  // -1: no pair of primitives
                             {c.vertex, -1, -1, -1},
                             {1, 0, 0, 0},
                             c.nearest.normal,
                             c.friction * force(c)});
    return make_friction(std::move(frictions), from, slips, p_.slip_distance);
  }

 private:
  /// That pushes the vertex away [N].
  double force(const Contact& c) const { return -p_.stiffness * c.weight * c.barrier.first; }

  std::vector<Contact> contacts_;
  BarrierParameters p_;
};

}  // namespace

std::unique_ptr<ContactSet> make_vertex_contacts(const Positions& x, const std::vector<Solid>& solids,
                                                 const std::vector<VertexPair>& pairs,
                                                 const BarrierParameters& parameters) {
  std::vector<char> is_near(pairs.size());
  parallel_for(static_cast<int>(pairs.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      is_near[i] = solids[pairs[i].solid].distance(x.row(pairs[i].vertex)) < parameters.range;
  });
  std::vector<VertexPair> near;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (is_near[i]) near.push_back(pairs[i]);
  std::vector<Contact> contacts(near.size());
  parallel_for(static_cast<int>(near.size()), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Solid& solid = solids[near[i].solid];
      const Nearest nearest = solid.nearest(x.row(near[i].vertex));
      contacts[i] = {near[i].vertex, near[i].solid, near[i].weight,
                     solid.friction, nearest,       barrier(nearest.distance / parameters.range)};
    }
  });
  return std::make_unique<VertexContacts>(std::move(contacts), parameters);
}

}  // namespace drape
