#include <cmath>
#include <iostream>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/version.h"

// A program of somebody else's: exits with 0 when the library it was linked with works.
int main() {
  drape::TriangleMesh square;
  square.vertices.resize(4, 3);
  square.vertices << 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0;
  square.triangles.resize(2, 3);
  square.triangles << 0, 1, 2, 0, 2, 3;
  const drape::Level level = drape::Level::of(0, square);
  std::cout << "drape " << drape::version() << " (" << drape::commit() << "), " << level.topology.edges.rows()
            << " edges, " << level.vertex_area.sum() << " m²\n";
  const bool right = level.topology.edges.rows() == 5 && std::abs(level.vertex_area.sum() - 4) < 1e-12;
  return right ? 0 : 1;
}
