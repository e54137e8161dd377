#include "core/numerics/model/stretch_limit.h"

#include <algorithm>

#include "core/kernel/files/number_text.h"

namespace drape {

std::string to_string(const StretchedTriangle& stretched, double limit) {
  return "triangle " + std::to_string(stretched.triangle) + ", stretched to " +
         general_text(stretched.stretch, 6) + " (limit " + general_text(limit, 6) + ")";
}

std::string strain_limit_violations(const std::vector<const BoundEnergy*>& energies, const Positions& x,
                                    std::size_t most_named) {
  std::string text;
  for (const BoundEnergy* energy : energies)
    if (const StretchLimited* limit = energy->stretch_limit()) {
      const std::vector<StretchedTriangle> violations = limit->violations(x);
      for (std::size_t k = 0; k < std::min(violations.size(), most_named); ++k)
        text += (text.empty() ? "" : ", ") + to_string(violations[k], limit->limit());
      if (violations.size() > most_named)
        text += " and " + std::to_string(violations.size() - most_named) + " more";
    }
  return text;
}

}  // namespace drape
