#include "core/kernel/contact/friction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernel/linear_algebra/parallel.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int grain = 1024;

/// Σ c_k x_k over the cloth's vertices: their contribution to the relative position of the two sides.
Vector3d position(const FrictionContact& contact, const Positions& x) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 4; ++k)
    if (contact.vertices[k] >= 0) sum += contact.c[k] * x.row(contact.vertices[k]).transpose();
  return sum;
}

/// A contact of the cloth with itself has four cloth vertices.
bool is_with_obstacle(const FrictionContact& contact) {
  return std::ranges::find(contact.vertices, -1) != contact.vertices.end();
}

/// The stored displacement of a contact, zero for a new one.
Vector3d displacement_of(const ContactKey& key, const TangentialDisplacements& displacements) {
  const auto found = std::ranges::lower_bound(displacements, key, {}, &TangentialDisplacement::contact);
  return found != displacements.end() && found->contact == key ? found->displacement : Vector3d::Zero();
}

class Friction final : public FrictionEnergy {
 public:
  Friction(std::vector<FrictionContact> contacts, const Positions& reference,
           const TangentialDisplacements& displacements, double friction_smoothing_distance)
      : contacts_(std::move(contacts)), origin_(contacts_.size()), epsilon_(friction_smoothing_distance) {
    parallel_for(size(), grain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        origin_[i] = position(contacts_[i], reference) - displacement_of(contacts_[i].key, displacements);
    });
  }

  double value(const Positions& x) const override {
    return parallel_sum(size(), grain, [&](int begin, int end) {
      double sum = 0;
      for (int i = begin; i < end; ++i) sum += potential(i, displacement(i, x).norm());
      return sum;
    });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    for (int i = 0; i < size(); ++i) {
      const Vector3d u = displacement(i, x), force = contacts_[i].force * ratio(u.norm()) * u;
      for (int k = 0; k < 4; ++k)
        if (contacts_[i].vertices[k] >= 0) g.row(contacts_[i].vertices[k]) += contacts_[i].c[k] * force;
    }
    return value(x);
  }

  void append_tangential_displacements(const Positions& x,
                                       TangentialDisplacements& displacements) const override {
    append(displacements, [&](int i) {
      const Vector3d u = displacement(i, x);
      return Vector3d(std::min(1.0, epsilon_ / u.norm()) * u);
    });
  }

  void append_advected_tangential_displacements(const Positions& x, const Positions& obstacle_motion,
                                                TangentialDisplacements& displacements) const override {
    append(displacements, [&](int i) {
      const Vector3d u = displacement(i, x);
      if (!is_with_obstacle(contacts_[i])) return u;
      return Vector3d(u - tangential(i, position(contacts_[i], obstacle_motion)));
    });
  }

  Stencils stencils() const override {
    Stencils result(size(), 4);
    for (int i = 0; i < size(); ++i)
      for (int k = 0; k < 4; ++k) result(i, k) = contacts_[i].vertices[k];
    return result;
  }

  void add_hessian(const Positions& x, Projection, BlockSink& sink) const override {
    for (int i = 0; i < size(); ++i) {
      const FrictionContact& contact = contacts_[i];
      const Eigen::Matrix3d h = stiffness(i, displacement(i, x));
      for (int b = 0; b < 4; ++b)
        for (int a = 0; a <= b; ++a) {
          if (contact.vertices[a] < 0 || contact.vertices[b] < 0) continue;
          const Eigen::Matrix3d block = contact.c[a] * contact.c[b] * h;
          sink.add(i, a, b, block.data());
        }
    }
  }

 private:
  int size() const { return static_cast<int>(contacts_.size()); }

  template <class DisplacementOf>
  void append(TangentialDisplacements& displacements, const DisplacementOf& displacement_of_contact) const {
    displacements.reserve(displacements.size() + size());
    for (int i = 0; i < size(); ++i) displacements.push_back({contacts_[i].key, displacement_of_contact(i)});
  }

  Vector3d tangential(int i, const Vector3d& u) const {
    const Vector3d& n = contacts_[i].normal;
    return u - n.dot(u) * n;
  }

  Vector3d displacement(int i, const Positions& x) const {
    return tangential(i, position(contacts_[i], x) - origin_[i]);
  }

  double potential(int i, double y) const {
    const double q = y / epsilon_;
    return contacts_[i].force * (q < 1 ? y * q * (1 - q / 3) : y - epsilon_ / 3);
  }

  /// f₁(y) / y
  double ratio(double y) const { return y < epsilon_ ? (2 - y / epsilon_) / epsilon_ : 1 / y; }

  /// f₁/y (I - n nᵀ) + (f₁/y)' / y u uᵀ; symmetric, so row- and column-major agree.
  Eigen::Matrix3d stiffness(int i, const Vector3d& u) const {
    const Vector3d& n = contacts_[i].normal;
    const double y = u.norm(),
                 along = y < epsilon_ ? (y > 0 ? -1 / (epsilon_ * epsilon_ * y) : 0) : -1 / (y * y * y);
    return contacts_[i].force *
           (ratio(y) * (Eigen::Matrix3d::Identity() - n * n.transpose()) + along * u * u.transpose());
  }

  std::vector<FrictionContact> contacts_;
  std::vector<Vector3d> origin_;
  double epsilon_;
};

}  // namespace

std::unique_ptr<FrictionEnergy> make_friction(std::vector<FrictionContact> contacts,
                                              const Positions& reference,
                                              const TangentialDisplacements& displacements,
                                              double friction_smoothing_distance) {
  if (contacts.empty()) return nullptr;
  return std::make_unique<Friction>(std::move(contacts), reference, displacements,
                                    friction_smoothing_distance);
}

}  // namespace drape
