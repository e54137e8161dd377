#include "core/numerics/mesh_files/file_coordinates.h"

namespace drape {

void FileCoordinates::convert(Positions& x) const {
  // A quotient, unlike a product with 0.001, is the double nearest to the length in metres.
  if (unit == "mm")
    x /= 1000;
  else if (unit == "cm")
    x /= 100;
  else if (unit == "inch")
    x *= 0.0254;
  if (up != "y") return;
  // A quarter turn about x, without the rounding of a sine: what is flat stays flat.
  x.col(1).swap(x.col(2));
  x.col(1) = -x.col(1);
}

}  // namespace drape
