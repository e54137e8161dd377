#include "core/model/stretch_limit.h"

#include <cstdio>

namespace drape {

std::string to_string(const StretchedTriangle& stretched, double limit) {
  char text[128];
  std::snprintf(text, sizeof text, "triangle %d, stretched to %.6g (limit %.6g)", stretched.triangle,
                stretched.stretch, limit);
  return text;
}

}  // namespace drape
