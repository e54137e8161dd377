#include "core/numerics/formulas/metric_formula.h"
#include "core/numerics/model/level_model.h"

DRAPE_PAIR_METRIC(energy_above_end,
                  "How much higher the prolonged state lies than the end, in the fine level's energy without "
                  "contact; a dash means that it violates the strain limit.",
                  "J", lower) {
  return model.energy_without_contact(*other) - model.energy_without_contact(x);
}
