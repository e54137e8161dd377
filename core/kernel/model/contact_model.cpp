#include "core/kernel/model/contact_model.h"

#include <cstdio>

namespace drape {

std::string to_string(const Intersection& intersection) {
  char point[100];
  std::snprintf(point, sizeof point, " at (%.4g, %.4g, %.4g)", intersection.where.x(), intersection.where.y(),
                intersection.where.z());
  return intersection.first + " and " + intersection.second + point;
}

}  // namespace drape
