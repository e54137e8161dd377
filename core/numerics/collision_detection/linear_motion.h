#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The linear motion of the cloth from x0 to x1 and of the obstacles' vertices, searched for pairs within d̂.
struct LinearMotion {
  const Positions& x0;
  const Positions& x1;
  double dhat;  ///< d̂ [m]
  const Positions &obstacles0, &obstacles1;
};

}  // namespace drape
