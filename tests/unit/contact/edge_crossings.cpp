// Edges through triangles, and the way in which what crosses comes apart.

#include "core/numerics/collision_detection/edge_crossings.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace drape;

namespace {

std::vector<EdgeCrossing> crossings_of(const Eigen::Matrix3d& triangle, const Eigen::Matrix3d& pierced) {
  std::vector<EdgeCrossing> all;
  visit_edge_crossings(triangle, pierced, [&](const EdgeCrossing& crossing) { all.push_back(crossing); });
  return all;
}

}  // namespace

TEST_CASE(
    "The tip of a triangle that pierces another one leaves it by the way in which their curve shortens") {
  Eigen::Matrix3d pierced, tip;
  pierced << -2, 3, 0, -2, -1, 3, 0, 0, 0;
  tip << 0.1, -0.6, 0.9, 0.2, -0.1, 0.3, -0.4, 1, 1.3;  // its first corner is beyond
  const auto place = [&](const EdgeCrossing& at, const Eigen::Matrix3d& of) -> Eigen::Vector3d {
    return of.col(at.corner) + at.along * (of.col((at.corner + 1) % 3) - of.col(at.corner));
  };
  const auto length = [&](const Eigen::Matrix3d& of) {
    const std::vector<EdgeCrossing> all = crossings_of(of, pierced);
    REQUIRE(all.size() == 2);
    return (place(all[0], of) - place(all[1], of)).norm();
  };
  for (const EdgeCrossing& at : crossings_of(tip, pierced)) {
    CHECK(place(at, tip).isApprox(pierced * at.weights));
    CHECK(at.away.norm() == Approx(1));
    CHECK(length(tip.colwise() + 0.01 * at.away) < length(tip) - 0.002);
  }
  CHECK(crossings_of(pierced, tip).empty());
  CHECK(crossings_of(tip.colwise() + Eigen::Vector3d(0, 0, 0.41), pierced).empty());
}
