#include "core/kernel/model/contact_model.h"

#include "core/kernel/files/number_text.h"

namespace drape {

std::string to_string(const Intersection& intersection) {
  const Eigen::Vector3d& at = intersection.where;
  return intersection.first + " and " + intersection.second + " at (" + general_text(at.x(), 4) + ", " +
         general_text(at.y(), 4) + ", " + general_text(at.z(), 4) + ")";
}

std::vector<TriangleMesh> obstacles_of(const BoundContacts& contacts) {
  std::vector<TriangleMesh> all;
  for (const auto& contact : contacts)
    for (TriangleMesh& mesh : contact->obstacles()) all.push_back(std::move(mesh));
  return all;
}

}  // namespace drape
