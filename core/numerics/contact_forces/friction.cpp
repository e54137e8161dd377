#include "core/numerics/contact_forces/friction.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr int contacts_per_task = 1024;

/// Σ c_k x_k over the cloth's vertices: their contribution to the relative position of the two sides.
Vector3d position(const FrictionContact& contact, const Positions& x) {
  Vector3d sum = Vector3d::Zero();
  for (int k = 0; k < 4; ++k)
    if (contact.vertices[k] >= 0) sum += contact.c[k] * x.row(contact.vertices[k]).transpose();
  return sum;
}

/// For a contact with an obstacle: 1 if Σ c_k x_k is the position of the cloth relative to the obstacle, -1
/// if it is the obstacle's relative to the cloth.
double side_of_cloth(const FrictionContact& contact) {
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    if (contact.vertices[k] >= 0) sum += contact.c[k];
  return sum > 0 ? 1 : -1;
}

/// The key of a cloth vertex's mean displacement on an obstacle; contacts have other second numbers.
ContactKey key_of_mean(int vertex, int obstacle) { return {vertex, -3, obstacle, 0, 0}; }

const TangentialDisplacement* find(const ContactKey& key, const TangentialDisplacements& displacements) {
  const auto found = std::ranges::lower_bound(displacements, key, {}, &TangentialDisplacement::contact);
  return found != displacements.end() && found->contact == key ? &*found : nullptr;
}

/// The displacement at which friction of at most `force` is what it was at the stored one, or nearly so.
Vector3d with_kept_force(const TangentialDisplacement& stored, double force, double epsilon) {
  const double length = stored.displacement.norm(), q = std::min(1.0, length / epsilon),
               part = force > 0 ? stored.force * q * (2 - q) / force : 0;
  if (!(length > 0) || !(part > 0)) return stored.displacement;
  return (part < 1 ? 1 - std::sqrt(1 - part) : 1) * epsilon / length * stored.displacement;
}

/// The stored displacement of a contact; for a new one that of its vertices on its obstacle, or zero.
Vector3d displacement_of(const FrictionContact& contact, const TangentialDisplacements& displacements,
                         double epsilon, Sticking sticking) {
  if (const TangentialDisplacement* own = find(contact.key, displacements))
    return sticking == Sticking::force ? with_kept_force(*own, contact.force, epsilon) : own->displacement;
  Vector3d sum = Vector3d::Zero();
  double weights = 0;
  if (contact.touched.obstacle < 0) return sum;
  for (int k = 0; k < 4; ++k) {
    if (contact.vertices[k] < 0) continue;
    const TangentialDisplacement* mean =
        find(key_of_mean(contact.vertices[k], contact.touched.obstacle), displacements);
    if (!mean) continue;
    sum += std::abs(contact.c[k]) * mean->displacement;
    weights += std::abs(contact.c[k]);
  }
  return weights > 0 ? Vector3d(side_of_cloth(contact) * sum / weights) : sum;
}

/// A contact that has ended is dropped once its force is below this fraction of the largest one.
constexpr double negligible_force = 1e-9;

/// The mean of two states of one contact, by the parts that they have in its force.
FrictionContact mean(const FrictionContact& before, FrictionContact now, double fraction) {
  const double old_part = (1 - fraction) * before.force, force = old_part + fraction * now.force;
  if (const double share = force > 0 ? old_part / force : 0; share > 0) {
    now.c = share * before.c + (1 - share) * now.c;
    if (const Eigen::Vector3d normal = share * before.normal + (1 - share) * now.normal; normal.norm() > 0)
      now.normal = normal.normalized();
  }
  now.force = force;
  return now;
}

TangentialDisplacements sorted(TangentialDisplacements displacements) {
  std::ranges::sort(displacements, {}, &TangentialDisplacement::contact);
  return displacements;
}

/// compute(i) of each of `count` contacts. All threads compute, and one then adds in order, which makes
/// results independent of the thread count.
template <class T, class Compute>
std::vector<T> of_each(int count, const Compute& compute) {
  std::vector<T> all(count);
  parallel_for(count, 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) all[i] = compute(i);
  });
  return all;
}

}  // namespace

LaggedFriction::LaggedFriction(FrictionContacts groups, const Positions& reference,
                               const TangentialDisplacements& displacements,
                               double friction_smoothing_distance, Sticking sticking)
    : epsilon_(friction_smoothing_distance) {
  for (std::vector<FrictionContact>& group : groups) {
    if (contacts_.empty())
      contacts_ = std::move(group);  // there are rarely other groups
    else
      contacts_.insert(contacts_.end(), group.begin(), group.end());
    group_ends_.push_back(size());
  }
  origin_.resize(contacts_.size());
  parallel_for(size(), contacts_per_task, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      origin_[i] = position(contacts_[i], reference) -
                   displacement_of(contacts_[i], displacements, epsilon_, sticking);
  });
}

double LaggedFriction::value(const Positions& x) const {
  double sum = 0;
  int first = 0;
  for (const int group_end : group_ends_) {
    sum += parallel_sum(group_end - first, contacts_per_task, [&](int begin, int end) {
      double part = 0;
      for (int i = first + begin; i < first + end; ++i) part += potential(i, displacement(i, x).norm());
      return part;
    });
    first = group_end;
  }
  return sum;
}

double LaggedFriction::add_gradient(const Positions& x, Positions& g) const {
  const auto forces = of_each<Vector3d>(size(), [&](int i) {
    const Vector3d u = displacement(i, x);
    return Vector3d(contacts_[i].force * ratio(u.norm()) * u);
  });
  for (int i = 0; i < size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (contacts_[i].vertices[k] >= 0) g.row(contacts_[i].vertices[k]) += contacts_[i].c[k] * forces[i];
  return value(x);
}

Stencils LaggedFriction::stencils() const {
  Stencils result(size(), 4);
  for (int i = 0; i < size(); ++i)
    for (int k = 0; k < 4; ++k) result(i, k) = contacts_[i].vertices[k];
  return result;
}

void LaggedFriction::add_hessian(const Positions& x, Projection, BlockSink& sink) const {
  const auto stiffnesses =
      of_each<Eigen::Matrix3d>(size(), [&](int i) { return stiffness(i, displacement(i, x)); });
  for (int i = 0; i < size(); ++i) {
    const FrictionContact& contact = contacts_[i];
    const Eigen::Matrix3d& h = stiffnesses[i];
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a <= b; ++a) {
        if (contact.vertices[a] < 0 || contact.vertices[b] < 0) continue;
        const Eigen::Matrix3d block = contact.c[a] * contact.c[b] * h;
        sink.add(i, a, b, block.data());
      }
  }
}

TangentialDisplacements LaggedFriction::tangential_displacements(const Positions& x) const {
  TangentialDisplacements all;
  all.reserve(contacts_.size());
  for (int i = 0; i < size(); ++i) {
    const Vector3d u = displacement(i, x);
    all.push_back({contacts_[i].key, std::min(1.0, epsilon_ / u.norm()) * u, contacts_[i].force});
  }
  return sorted(std::move(all));
}

TangentialDisplacements LaggedFriction::advected_tangential_displacements(
    const Positions& x, const ObstacleMotion& motion) const {
  TangentialDisplacements all;
  all.reserve(contacts_.size());
  for (int i = 0; i < size(); ++i) {
    const FrictionContact& contact = contacts_[i];
    Vector3d u = displacement(i, x);
    if (contact.touched.obstacle >= 0) u -= side_of_cloth(contact) * tangential(i, motion(contact.touched));
    all.push_back({contact.key, u, contact.force});
  }
  append_means(all);
  return sorted(std::move(all));
}

/// Means of the cloth's displacements relative to the obstacle, weighted by friction force.
void LaggedFriction::append_means(TangentialDisplacements& of_contacts) const {
  struct Part {
    ContactKey mean;
    double weight;
    Vector3d displacement;
  };
  std::vector<Part> parts;
  for (int i = 0; i < size(); ++i) {
    const FrictionContact& contact = contacts_[i];
    for (int k = 0; k < 4 && contact.touched.obstacle >= 0; ++k)
      if (const double weight = std::abs(contact.c[k]) * contact.force;
          contact.vertices[k] >= 0 && weight > 0)
        parts.push_back({key_of_mean(contact.vertices[k], contact.touched.obstacle), weight,
                         side_of_cloth(contact) * of_contacts[i].displacement});
  }
  std::ranges::stable_sort(parts, {}, &Part::mean);
  for (std::size_t first = 0, last = 0; first < parts.size(); first = last) {
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    for (; last < parts.size() && parts[last].mean == parts[first].mean; ++last) {
      sum += parts[last].weight * parts[last].displacement;
      weights += parts[last].weight;
    }
    of_contacts.push_back({parts[first].mean, sum / weights});
  }
}

Vector3d LaggedFriction::tangential(int i, const Vector3d& u) const {
  const Vector3d& n = contacts_[i].normal;
  return u - n.dot(u) * n;
}

Vector3d LaggedFriction::displacement(int i, const Positions& x) const {
  return tangential(i, position(contacts_[i], x) - origin_[i]);
}

double LaggedFriction::potential(int i, double y) const {
  const double q = y / epsilon_;
  return contacts_[i].force * (q < 1 ? y * q * (1 - q / 3) : y - epsilon_ / 3);
}

/// f₁(y) / y
double LaggedFriction::ratio(double y) const { return y < epsilon_ ? (2 - y / epsilon_) / epsilon_ : 1 / y; }

/// f₁/y (I - n nᵀ) + (f₁/y)' / y u uᵀ; symmetric, so row- and column-major agree.
Eigen::Matrix3d LaggedFriction::stiffness(int i, const Vector3d& u) const {
  const Vector3d& n = contacts_[i].normal;
  const double y = u.norm(),
               along = y < epsilon_ ? (y > 0 ? -1 / (epsilon_ * epsilon_ * y) : 0) : -1 / (y * y * y);
  return contacts_[i].force *
         (ratio(y) * (Eigen::Matrix3d::Identity() - n * n.transpose()) + along * u * u.transpose());
}

FrictionContacts under_relaxed(const FrictionContacts& before, FrictionContacts now, double fraction) {
  std::vector<FrictionContact> ended;
  for (const auto& group : before) ended.insert(ended.end(), group.begin(), group.end());
  std::ranges::sort(ended, {}, &FrictionContact::key);
  std::vector<char> continues(ended.size(), 0);
  double largest = 0;
  for (auto& group : now)
    for (FrictionContact& contact : group) {
      const auto old = std::ranges::lower_bound(ended, contact.key, {}, &FrictionContact::key);
      if (old != ended.end() && old->key == contact.key) {
        continues[old - ended.begin()] = 1;
        contact = mean(*old, contact, fraction);
      } else {
        contact.force *= fraction;
      }
      largest = std::max(largest, contact.force);
    }
  std::vector<FrictionContact> rest;
  for (std::size_t i = 0; i < ended.size(); ++i) {
    if (continues[i]) continue;
    FrictionContact& contact = ended[i];
    if (contact.force > negligible_force * largest) {
      contact.force *= 1 - fraction;
      rest.push_back(contact);
    }
  }
  if (!rest.empty()) now.push_back(std::move(rest));
  return now;
}

FrictionContacts friction_contacts(const Collisions& collisions) {
  FrictionContacts groups;
  collisions.append_friction_contacts(groups);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

std::unique_ptr<const LaggedFriction> lagged_friction(const Collisions& collisions, FrictionContacts contacts,
                                                      const Positions& reference,
                                                      const TangentialDisplacements& displacements,
                                                      Sticking sticking) {
  if (contacts.empty()) return nullptr;
  return std::make_unique<const LaggedFriction>(std::move(contacts), reference, displacements,
                                                collisions.friction_smoothing_distance(), sticking);
}

}  // namespace drape
