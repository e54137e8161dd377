#include "core/app/dressing/tightness.h"

#include "core/app/experiment/garment_place.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/dressing/garment_rest.h"

namespace drape {

std::string tightness_text(const std::string& verdict, const ClothParameters& cloth, const Level& level,
                           const Positions& x, double much) {
  const Tightness tightest = tightest_piece(level, x);
  if (tightest.stretch <= much) return "";
  const GarmentPlace place = place_in_garment(cloth, level, tightest.triangle);
  return (place.where ? place.where->text() + ": " : "") + verdict + ": a tenth of " + place.text +
         (place.where ? "," : "") + " is stretched by more than " + three_digits(100 * tightest.stretch) +
         " %";
}

}  // namespace drape
