#include "plugins/refiner/coarsen/choose_vertices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/patterns/plane_grid.h"
#include "plugins/refiner/coarsen/outline_chains.h"

namespace drape {
namespace {

using Eigen::Vector2d;

/// Radius of empty discs around chosen vertices over the square root of a coarse vertex's area: at first, and
/// from one round to the next while there are fewer than wanted. A grid's few distances leave gaps between.
constexpr double disc_radius = 0.85, shrinking = 0.95;
/// Moves of inner vertices to the centroids of their cells (Lloyd's method).
constexpr int moves = 4;

/// The inner vertices of one flat piece, chosen among its images.
class InnerVertices {
 public:
  InnerVertices(const Level& level, const FlatCloth& flat, std::vector<int> images, double ratio)
      : level_(level),
        flat_(flat),
        images_(std::move(images)),
        ratio_(ratio),
        fine_(grid()),
        chosen_(grid()) {
    for (const int i : images_) fine_.add(i, place(i), place(i));
  }

  void choose(std::vector<char>& kept) {
    for (const int i : images_)
      if (kept[vertex(i)]) fixed_.push_back(i), chosen_.add(i, place(i), place(i));
    std::vector<int> order;
    for (const int i : images_)
      if (!flat_.on_outline[vertex(i)]) order.push_back(i);
    Random random(1);
    for (std::size_t k = order.size(); k > 1; --k)
      std::swap(order[k - 1], order[static_cast<std::size_t>(random.unit() * static_cast<double>(k))]);
    const auto wanted = static_cast<std::size_t>(static_cast<double>(order.size()) / ratio_);
    for (double radius = disc_radius; inner_.size() < wanted && radius > 0.1; radius *= shrinking)
      for (const int i : order)
        if (inner_.size() < wanted && is_free(i, radius))
          inner_.push_back(i), chosen_.add(i, place(i), place(i));
    for (int k = 0; k < moves; ++k) move_to_centroids();
    for (const int i : inner_) kept[vertex(i)] = 1;
  }

 private:
  const Vector2d& place(int i) const { return flat_.images[i].place; }
  int vertex(int i) const { return flat_.images[i].vertex; }
  double spacing(int i) const { return std::sqrt(2 * ratio_ * flat_.triangle_area[vertex(i)]); }

  PlaneGrid grid() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vector2d lower(infinity, infinity), upper = -lower;
    double sum = 0;
    for (const int i : images_) {
      lower = lower.cwiseMin(place(i));
      upper = upper.cwiseMax(place(i));
      sum += spacing(i);
    }
    return {lower, upper, sum / static_cast<double>(images_.size())};
  }

  bool is_free(int i, double relative_radius) const {
    const double radius = relative_radius * spacing(i);
    const Vector2d reach(radius, radius);
    bool free = true;
    chosen_.for_each(place(i) - reach, place(i) + reach,
                     [&](int j) { free = free && (place(i) - place(j)).norm() >= radius; });
    return free;
  }

  /// The item of a grid that is nearest to p and for which `counts` holds, or -1; of equal ones the first.
  template <class Counts>
  int nearest(const PlaneGrid& grid, const Vector2d& p, const Counts& counts) const {
    int best = -1;
    double smallest = std::numeric_limits<double>::infinity();
    for (double radius = grid.cell(); radius < 1e4 * grid.cell(); radius *= 2) {
      grid.for_each(p - Vector2d(radius, radius), p + Vector2d(radius, radius), [&](int j) {
        const double distance = (place(j) - p).norm();
        if (counts(j) && (distance < smallest || (distance == smallest && j < best)))
          smallest = distance, best = j;
      });
      if (smallest <= radius) return best;
    }
    return best;
  }

  void move_to_centroids() {
    std::vector<Vector2d> sum(flat_.images.size(), Vector2d(0, 0));
    std::vector<double> mass(flat_.images.size(), 0);
    for (const int i : images_) {
      const int own = nearest(chosen_, place(i), [](int) { return true; });
      sum[own] += level_.vertex_area[vertex(i)] * place(i);
      mass[own] += level_.vertex_area[vertex(i)];
    }
    std::vector<char> taken(flat_.images.size(), 0);
    for (int& i : inner_) {
      const Vector2d centroid = mass[i] > 0 ? Vector2d(sum[i] / mass[i]) : place(i);
      const int moved =
          nearest(fine_, centroid, [&](int j) { return !flat_.on_outline[vertex(j)] && !taken[j]; });
      if (moved >= 0) i = moved;
      taken[i] = 1;
    }
    chosen_ = grid();
    for (const auto* list : {&fixed_, &inner_})
      for (const int i : *list) chosen_.add(i, place(i), place(i));
  }

  const Level& level_;
  const FlatCloth& flat_;
  std::vector<int> images_;
  double ratio_;
  PlaneGrid fine_, chosen_;  // all images; the chosen ones
  std::vector<int> fixed_, inner_;
};

}  // namespace

std::vector<char> chosen_vertices(const Level& level, const FlatCloth& flat, double ratio) {
  std::vector<char> kept(level.vertex_count(), 0);
  for (const OutlineChain& chain : outline_chains(level, flat))
    for (const int v : kept_of(chain, level, flat, ratio)) kept[v] = 1;
  std::vector<std::vector<int>> images(flat.piece_count);
  for (int i = 0; i < std::ssize(flat.images); ++i) images[flat.images[i].piece].push_back(i);
  for (std::vector<int>& own : images) InnerVertices(level, flat, std::move(own), ratio).choose(kept);
  return kept;
}

}  // namespace drape
