#include "core/kernel/model/hierarchy.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "core/kernel/mesh/check.h"
#include "core/kernel/model/midpoint.h"
#include "core/kernel/model/rest_interpolation.h"

namespace drape {
namespace {

Level checked_level(int index, TriangleMesh rest) {
  const std::vector<std::string> faults = check_mesh(rest);
  if (!faults.empty())
    throw std::runtime_error(
        "rest shape of level " + std::to_string(index) + ": " + faults[0] +
        (faults.size() == 1 ? "" : " (and " + std::to_string(faults.size() - 1) + " more faults)"));
  return Level::of(index, std::move(rest));
}

}  // namespace

Hierarchy Hierarchy::of(TriangleMesh coarsest, const Refiner& refiner, int level_count) {
  if (level_count < 1) throw std::runtime_error("hierarchy: at least one level is needed");
  Hierarchy hierarchy;
  hierarchy.levels.reserve(level_count);
  hierarchy.levels.push_back(checked_level(0, std::move(coarsest)));
  for (int l = 1; l < level_count; ++l) {
    const Level& coarse = hierarchy.levels.back();
    Refinement finer = refiner.refine(coarse);
    TriangleMesh rest{finer.weights * coarse.rest.vertices, std::move(finer.triangles)};
    hierarchy.midpoints.push_back(midpoint_refinement(coarse).weights);
    hierarchy.linear.push_back(rest_interpolation(coarse, rest.vertices));
    hierarchy.prolongations.push_back(std::move(finer.weights));
    hierarchy.levels.push_back(checked_level(l, std::move(rest)));
  }
  return hierarchy;
}

Positions Hierarchy::prolong(const Positions& x, int from, int to,
                             const std::vector<ProlongationMatrix>& weights) const {
  if (from < 0 || from > to || to >= level_count())
    throw std::runtime_error("prolong: levels " + std::to_string(from) + " to " + std::to_string(to) +
                             " of a hierarchy of " + std::to_string(level_count()));
  if (x.rows() != levels[from].vertex_count())
    throw std::runtime_error("prolong: " + std::to_string(x.rows()) + " positions for the " +
                             std::to_string(levels[from].vertex_count()) + " vertices of level " +
                             std::to_string(from));
  Positions fine = x;
  for (int l = from; l < to; ++l) fine = (weights[l] * fine).eval();
  return fine;
}

}  // namespace drape
