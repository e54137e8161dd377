#include "core/contact/friction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/parallel.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int grain = 1024;

/// Σ c_k x_k over the cloth's vertices.
Vector3d place(const FrictionContact& contact, const Positions& x) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 4; ++k)
    if (contact.vertices[k] >= 0) sum += contact.c[k] * x.row(contact.vertices[k]).transpose();
  return sum;
}

/// Between two parts of the cloth all four vertices are its own.
bool is_with_obstacle(const FrictionContact& contact) {
  return std::ranges::find(contact.vertices, -1) != contact.vertices.end();
}

/// Zero for a contact that is new.
Vector3d slip_of(const ContactKey& key, const Slips& slips) {
  const auto found = std::ranges::lower_bound(slips, key, {}, &Slip::contact);
  return found != slips.end() && found->contact == key ? found->by : Vector3d::Zero();
}

class Friction final : public FrictionEnergy {
 public:
  Friction(std::vector<FrictionContact> contacts, const Positions& from, const Slips& slips,
           double slip_distance)
      : contacts_(std::move(contacts)), start_(contacts_.size()), epsilon_(slip_distance) {
    parallel_for(size(), grain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        start_[i] = place(contacts_[i], from) - slip_of(contacts_[i].key, slips);
    });
  }

  double value(const Positions& x) const override {
    return parallel_sum(size(), grain, [&](int begin, int end) {
      double sum = 0;
      for (int i = begin; i < end; ++i) sum += potential(i, slip(i, x).norm());
      return sum;
    });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    for (int i = 0; i < size(); ++i) {
      const Vector3d u = slip(i, x), force = contacts_[i].force * ratio(u.norm()) * u;
      for (int k = 0; k < 4; ++k)
        if (contacts_[i].vertices[k] >= 0) g.row(contacts_[i].vertices[k]) += contacts_[i].c[k] * force;
    }
    return value(x);
  }

  void add_slips(const Positions& x, Slips& slips) const override {
    append(slips, [&](int i) {
      const Vector3d u = slip(i, x);
      return Vector3d(std::min(1.0, epsilon_ / u.norm()) * u);
    });
  }

  void add_slips_carried(const Positions& x, const Positions& carried, Slips& slips) const override {
    append(slips, [&](int i) {
      const Vector3d u = slip(i, x);
      if (!is_with_obstacle(contacts_[i])) return u;
      return Vector3d(u - tangential(i, place(contacts_[i], carried)));
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
      const Eigen::Matrix3d h = stiffness(i, slip(i, x));
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

  template <class SlipOf>
  void append(Slips& slips, const SlipOf& slip_of_contact) const {
    slips.reserve(slips.size() + size());
    for (int i = 0; i < size(); ++i) slips.push_back({contacts_[i].key, slip_of_contact(i)});
  }

  Vector3d tangential(int i, const Vector3d& u) const {
    const Vector3d& n = contacts_[i].normal;
    return u - n.dot(u) * n;
  }

  Vector3d slip(int i, const Positions& x) const { return tangential(i, place(contacts_[i], x) - start_[i]); }

  double potential(int i, double y) const {
    const double q = y / epsilon_;
    return contacts_[i].force * (q < 1 ? y * q * (1 - q / 3) : y - epsilon_ / 3);
  }

  /// f₁(y) / y
  double ratio(double y) const { return y < epsilon_ ? (2 - y / epsilon_) / epsilon_ : 1 / y; }

  /// f₁/y (I - n nᵀ) + (f₁/y)' / y u uᵀ: symmetric, so its order in memory does not matter.
  Eigen::Matrix3d stiffness(int i, const Vector3d& u) const {
    const Vector3d& n = contacts_[i].normal;
    const double y = u.norm(),
                 along = y < epsilon_ ? (y > 0 ? -1 / (epsilon_ * epsilon_ * y) : 0) : -1 / (y * y * y);
    return contacts_[i].force *
           (ratio(y) * (Eigen::Matrix3d::Identity() - n * n.transpose()) + along * u * u.transpose());
  }

  std::vector<FrictionContact> contacts_;
  std::vector<Vector3d> start_;
  double epsilon_;
};

}  // namespace

std::unique_ptr<FrictionEnergy> make_friction(std::vector<FrictionContact> contacts, const Positions& from,
                                              const Slips& slips, double slip_distance) {
  if (contacts.empty()) return nullptr;
  return std::make_unique<Friction>(std::move(contacts), from, slips, slip_distance);
}

}  // namespace drape
