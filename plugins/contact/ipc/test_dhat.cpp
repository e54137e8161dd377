#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/ipc.h"

using namespace drape;
using namespace drape::ipc;

TEST_CASE("ipc: a dhat larger than the cloth is refused before its pairs exceed memory") {
  const Level level = Level::of(0, grid({1, 1}, 80, 80, Diagonals::one_way));
  Ipc::Parameters p;
  p.self_contact = true;
  p.dhat = 2 / 79.0;  // two edges
  CHECK_NOTHROW(Ipc(p).bind(level, Material()));
  p.dhat = 1000;
  CHECK_THROWS_WITH(Ipc(p).bind(level, Material()),
                    Catch::Contains("more than 50 million pairs of the resting cloth's vertices, edges and "
                                    "triangles are within \"dhat\" of each other"));
}
