#include "core/numerics/hierarchy/hierarchy.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/kernel/files/message_text.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/hierarchy/rest_interpolation.h"
#include "core/numerics/mesh/check.h"

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

/// Refuses what only a faulty refiner returns, before anything is computed from it.
void require_prolongation(const Level& coarse, const ProlongationMatrix& weights) {
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error("the refiner's result for level " + std::to_string(coarse.index) + ": " + what);
  };
  const Eigen::Index n = coarse.vertex_count(), edges = coarse.topology.edges.rows();
  if (weights.rows() != n + edges || weights.cols() != n)
    fail("weights of " + std::to_string(weights.rows()) + " × " + std::to_string(weights.cols()) + ", not " +
         std::to_string(n + edges) + " × " + std::to_string(n) +
         ": a row for each vertex, then one for each edge, and a column for each vertex");
  for (Eigen::Index i = 0; i < n + edges; ++i) {
    double sum = 0;
    for (ProlongationMatrix::InnerIterator entry(weights, i); entry; ++entry) sum += entry.value();
    if (!(std::abs(sum - 1) <= 1e-9))
      fail("row " + std::to_string(i) + " of its weights sums to " + std::to_string(sum) + ", not to 1");
  }
}

/// Flat pieces are refined linearly, so a refiner that moves vertices would strain them.
void require_unmoved(const ProlongationMatrix& weights, const ProlongationMatrix& midpoints) {
  if ((weights - midpoints).norm() > 0)
    throw std::runtime_error(
        "the refiner moves vertices along the cloth, and so would strain flat pieces, whose outlines and "
        "seams are refined at edge midpoints; write \"refiner: midpoint\"");
}

}  // namespace

Hierarchy Hierarchy::of(TriangleMesh coarsest, const Refiner& refiner, int level_count) {
  if (level_count < 1) throw std::runtime_error("hierarchy: at least one level is needed");
  Hierarchy hierarchy;
  hierarchy.levels.reserve(level_count);
  hierarchy.levels.push_back(checked_level(0, std::move(coarsest)));
  for (int l = 1; l < level_count; ++l) {
    const Level& coarse = hierarchy.levels.back();
    ProlongationMatrix weights = with_name("the refiner", [&] { return refiner.weights(coarse); });
    require_prolongation(coarse, weights);
    weights.makeCompressed();
    Level fine = checked_level(l, refined_rest(coarse, weights));
    hierarchy.midpoints.push_back(midpoint_weights(coarse));
    if (coarse.rest.sewing) require_unmoved(weights, hierarchy.midpoints.back());
    hierarchy.linear.push_back(rest_interpolation(coarse, fine.rest.vertices));
    hierarchy.prolongations.push_back(std::move(weights));
    hierarchy.levels.push_back(std::move(fine));
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
