#include "core/model/contact_model.h"

#include <cstdio>

namespace drape {

std::string to_string(const Touch& touch) {
  char place[100];
  std::snprintf(place, sizeof place, " at (%.4g, %.4g, %.4g)", touch.where.x(), touch.where.y(),
                touch.where.z());
  return touch.first + " and " + touch.second + place;
}

}  // namespace drape
