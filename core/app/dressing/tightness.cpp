#include "core/app/dressing/tightness.h"

#include "core/app/experiment/garment_place.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/dressing/garment_rest.h"

namespace drape {

std::string too_tight(const ClothParameters& cloth, const Level& level, const Positions& x, double allowed,
                      const std::string& when) {
  const Tightness tightest = tightest_piece(level, x);
  if (tightest.stretch <= allowed) return "";
  const auto percent = [](double part) { return three_digits(100 * part) + " %"; };
  const GarmentPlace place = place_in_garment(cloth, level, tightest.triangle);
  return (place.where ? place.where->text() + ": " : "") + "the garment is too tight for its body: " + when +
         ", a tenth of " + place.text + ", is stretched by more than " + percent(tightest.stretch) +
         ", and " + percent(allowed) + " is allowed; ";
}

}  // namespace drape
