#include "core/numerics/hierarchy/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
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
void require_prolongation(const Level& of, const ProlongationMatrix& weights, Eigen::Index rows,
                          Eigen::Index columns, const char* meaning) {
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error("the refiner's result for level " + std::to_string(of.index) + ": " + what);
  };
  if (weights.rows() != rows || weights.cols() != columns)
    fail("weights of " + std::to_string(weights.rows()) + " × " + std::to_string(weights.cols()) + ", not " +
         std::to_string(rows) + " × " + std::to_string(columns) + ": " + meaning);
  for (Eigen::Index i = 0; i < rows; ++i) {
    double sum = 0;
    for (ProlongationMatrix::InnerIterator entry(weights, i); entry; ++entry) sum += entry.value();
    if (!(std::abs(sum - 1) <= 1e-9))
      fail("row " + std::to_string(i) + " of its weights sums to " + std::to_string(sum) + ", not to 1");
  }
}

/// The coarse vertex with the largest weight for each fine one; of equal ones the first.
std::vector<int> nearest_parents(const ProlongationMatrix& weights) {
  std::vector<int> parents(weights.rows(), 0);
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    double largest = -1;
    for (ProlongationMatrix::InnerIterator entry(weights, i); entry; ++entry)
      if (entry.value() > largest) largest = entry.value(), parents[i] = static_cast<int>(entry.col());
  }
  return parents;
}

/// Flat pieces are refined linearly, so a refiner that moves vertices would strain them.
void require_unmoved(const ProlongationMatrix& weights, const ProlongationMatrix& midpoints) {
  if ((weights - midpoints).norm() > 0)
    throw std::runtime_error(
        "the refiner moves vertices along the cloth, and so would strain flat pieces, whose outlines and "
        "seams are refined at edge midpoints; write \"refiner: midpoint\"");
}

CoarserMesh coarser_mesh(const Refiner& refiner, const Level& fine) {
  std::optional<CoarserMesh> made = with_name("the refiner", [&] { return refiner.coarser(fine); });
  if (!made)
    throw std::runtime_error(
        "the refiner makes no levels that are coarser than the cloth's mesh; write \"refiner: coarsen\"");
  require_prolongation(fine, made->weights, fine.vertex_count(),
                       static_cast<Eigen::Index>(made->vertices.size()),
                       "a row for each vertex, and a column for each of the coarser mesh");
  made->weights.makeCompressed();
  return std::move(*made);
}

}  // namespace

Hierarchy Hierarchy::of(TriangleMesh cloth, const Refiner& refiner, int level_count, int coarser_count) {
  if (level_count < 1) throw std::runtime_error("hierarchy: at least one level is needed");
  Hierarchy hierarchy;
  hierarchy.cloth = coarser_count;
  hierarchy.levels.reserve(coarser_count + level_count);
  hierarchy.levels.push_back(checked_level(coarser_count, std::move(cloth)));
  hierarchy.add_coarser(refiner, coarser_count);
  hierarchy.add_finer(refiner, level_count - 1);
  return hierarchy;
}

void Hierarchy::add_coarser(const Refiner& refiner, int count) {
  for (int k = 0; k < count; ++k) {
    const Level& fine = levels.back();  // the coarsest one so far
    CoarserMesh made = coarser_mesh(refiner, fine);
    Level coarse = checked_level(fine.index - 1, std::move(made.rest));
    coarse.own_vertices = nearest_parents(made.weights);
    coarse.cloth_vertices = std::move(made.vertices);
    if (k > 0) {
      for (int& v : coarse.cloth_vertices) v = fine.cloth_vertices[v];
      std::vector<int> own;
      for (const int v : fine.own_vertices) own.push_back(coarse.own_vertices[v]);
      coarse.own_vertices = std::move(own);
    }
    offsets.push_back(NormalOffsets::of(coarse, made.weights, fine));
    prolongations.push_back(std::move(made.weights));
    levels.push_back(std::move(coarse));
  }
  std::ranges::reverse(levels);
  std::ranges::reverse(prolongations);
  std::ranges::reverse(offsets);
  midpoints = linear = prolongations;
}

void Hierarchy::coarsen_below(const Refiner& refiner, int vertices) {
  std::vector<ProlongationMatrix> found;
  for (Level level = levels.front(); level.vertex_count() > vertices;) {
    CoarserMesh made = coarser_mesh(refiner, level);
    level = checked_level(level.index - 1, std::move(made.rest));
    found.push_back(std::move(made.weights));
  }
  below.assign(std::make_move_iterator(found.rbegin()), std::make_move_iterator(found.rend()));
}

std::vector<ProlongationMatrix> Hierarchy::leading_to(int level) const {
  std::vector<ProlongationMatrix> all = below;
  all.insert(all.end(), prolongations.begin(), prolongations.begin() + level);
  return all;
}

void Hierarchy::add_finer(const Refiner& refiner, int count) {
  for (int k = 0; k < count; ++k) {
    const Level& coarse = levels.back();
    ProlongationMatrix weights = with_name("the refiner", [&] { return refiner.weights(coarse); });
    const Eigen::Index n = coarse.vertex_count();
    require_prolongation(coarse, weights, n + coarse.topology.edges.rows(), n,
                         "a row for each vertex, then one for each edge, and a column for each vertex");
    weights.makeCompressed();
    Level fine = checked_level(coarse.index + 1, refined_rest(coarse, weights));
    midpoints.push_back(midpoint_weights(coarse));
    if (coarse.rest.sewing) require_unmoved(weights, midpoints.back());
    linear.push_back(rest_interpolation(coarse, fine.rest.vertices));
    offsets.emplace_back();
    prolongations.push_back(std::move(weights));
    levels.push_back(std::move(fine));
  }
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
  for (int l = from; l < to; ++l) {
    const Positions coarse = std::move(fine);
    fine = weights[l] * coarse;
    offsets[l].add(levels[l].rest.triangles, coarse, fine);
  }
  return fine;
}

}  // namespace drape
