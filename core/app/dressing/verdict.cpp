#include "core/app/dressing/verdict.h"

#include "core/app/dressing/tightness.h"
#include "core/app/dressing/worn.h"

namespace drape {

LevelResult with_verdict(const Experiment& e, const Scene& scene, LevelResult result) {
  constexpr double tight = 0.5;
  if (result.level != scene.finest() || !has_converged(result.outcome)) return result;
  const auto add = [&](const std::string& text) {
    result.message += (result.message.empty() || text.empty() ? "" : "; ") + text;
  };
  const ClothParameters& cloth = e.parameters.cloth;
  const Level& level = scene.hierarchy.levels[result.level];
  add(tightness_text("the garment is tight", cloth, level, result.x, tight));
  const std::string fault = not_worn_text(cloth, level, result.x, dressed_body(e, scene.finest_model()));
  if (fault.empty()) return result;
  if (e.parameters.dress.worn) result.outcome = Outcome::infeasible;
  add("the garment is not worn: " + fault);
  return result;
}

}  // namespace drape
