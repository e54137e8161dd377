#include <algorithm>
#include <utility>

#include "core/numerics/contact_forces/friction.h"

namespace drape {
namespace {

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

}  // namespace

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

}  // namespace drape
