#include "core/kernel/model/stretch_limit.h"

#include <algorithm>
#include <cstdio>

namespace drape {

std::string to_string(const StretchedTriangle& stretched, double limit) {
  char text[128];
  std::snprintf(text, sizeof text, "triangle %d, stretched to %.6g (limit %.6g)", stretched.triangle,
                stretched.stretch, limit);
  return text;
}

std::string strain_limit_violations(const std::vector<const BoundEnergy*>& energies, const Positions& x,
                                    std::size_t most_named) {
  std::string text;
  for (const BoundEnergy* energy : energies)
    if (const auto* limit = dynamic_cast<const StretchLimited*>(energy)) {
      const std::vector<StretchedTriangle> violations = limit->violations(x);
      for (std::size_t k = 0; k < std::min(violations.size(), most_named); ++k)
        text += (text.empty() ? "" : ", ") + to_string(violations[k], limit->limit());
      if (violations.size() > most_named)
        text += " and " + std::to_string(violations.size() - most_named) + " more";
    }
  return text;
}

}  // namespace drape
