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

}  // namespace drape
