#include "core/kernel/interfaces/contact_model.h"

#include "core/kernel/files/number_text.h"

namespace drape {

std::string to_string(const Intersection& intersection) {
  const Eigen::Vector3d& at = intersection.where;
  return intersection.first + " and " + intersection.second + " at (" + general_text(at.x(), 4) + ", " +
         general_text(at.y(), 4) + ", " + general_text(at.z(), 4) + ")";
}

StepLimit BoundContact::max_step([[maybe_unused]] const BoundContact& before, const Positions& x) const {
  const auto found = intersections(x);
  return found.empty() ? StepLimit{} : StepLimit{0.5, to_string(found.front())};
}

std::vector<TriangleMesh> obstacles_of(const BoundContacts& contacts) {
  std::vector<TriangleMesh> all;
  for (const auto& contact : contacts)
    for (TriangleMesh& mesh : contact->obstacles()) all.push_back(std::move(mesh));
  return all;
}

ContactStiffness stiffness_of(const BoundContacts& contacts) {
  ContactStiffness stiffness;
  for (const auto& contact : contacts) stiffness.push_back(contact->stiffness());
  return stiffness;
}

BoundContacts stiffened(const BoundContacts& contacts, const ContactStiffness& stiffness) {
  BoundContacts result = contacts;
  for (std::size_t k = 0; k < stiffness.size(); ++k)
    if (stiffness[k] > contacts.at(k)->stiffness())
      if (auto stiffer = contacts[k]->with_stiffness(stiffness[k])) result[k] = std::move(stiffer);
  return result;
}

}  // namespace drape
