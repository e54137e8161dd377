#include "plugins/refiner/coarsen/coarse_pieces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/numerics/patterns/delaunay.h"

namespace drape {
namespace {

/// A side of a coarse outline, in the direction of its piece.
struct CoarseSide {
  int from, to;  ///< images
  int edge;      ///< the smallest fine edge at its ends: the same on both sides of a seam
  int middle;    ///< a vertex about halfway, -1 without any
};

class Builder {
 public:
  Builder(const FlatCloth& flat, std::vector<char> kept)
      : flat_(flat), sides_(AdjacencyList::of(static_cast<int>(flat.images.size()), [&](const auto& add) {
          for (int s = 0; s < std::ssize(flat.outline); ++s) add(flat.outline[s].from, s);
        })) {
    result_.kept = std::move(kept);
  }

  CoarsePieces build() {
    constexpr int max_rounds = 100;
    for (int round = 0; round < max_rounds; ++round) {
      if (!triangulate() || !is_a_mesh()) {
        if (!keep_wanted()) break;
        continue;
      }
      drop_unused();
      return std::move(result_);
    }
    throw std::runtime_error(
        "the flat pieces have no coarser mesh within their outlines: they are too narrow there, or overlap "
        "themselves; ask for fewer coarser levels");
  }

 private:
  int vertex(int image) const { return flat_.images[image].vertex; }
  const Eigen::Vector2d& place(int image) const { return flat_.images[image].place; }

  void find_sides() {
    by_ends_.clear();
    for (const FlatCloth::Side& first : flat_.outline) {
      if (!result_.kept[vertex(first.from)]) continue;
      const FlatCloth::Side* last = &first;
      std::vector<int> between;
      while (!result_.kept[vertex(last->to)]) {
        between.push_back(vertex(last->to));
        last = &flat_.outline[sides_.row(last->to).front()];
      }
      const int middle = between.empty() ? -1 : between[between.size() / 2];
      const CoarseSide side{first.from, last->to, std::min(first.edge, last->edge), middle};
      const auto [other, is_new] = by_ends_.emplace(std::pair(side.from, side.to), side);
      if (!is_new) want(other->second), want(side);
    }
  }

  /// Wants a vertex in the middle of a side.
  void want(const CoarseSide& side) {
    if (side.middle >= 0) wanted_.insert(side.middle);
  }
  /// Wants a vertex near the middle of a side or inner edge.
  void want(int a, int b) {
    for (const auto& ends : {std::pair(a, b), std::pair(b, a)})
      if (const auto side = by_ends_.find(ends); side != by_ends_.end()) return want(side->second);
    const Eigen::Vector2d middle = (place(a) + place(b)) / 2;
    int nearest = -1;
    double smallest = std::numeric_limits<double>::infinity();
    for (const FlatCloth::Image& image : flat_.images) {
      if (image.piece != flat_.images[a].piece || result_.kept[image.vertex] ||
          flat_.on_outline[image.vertex])
        continue;
      if (const double distance = (image.place - middle).norm(); distance < smallest)
        smallest = distance, nearest = image.vertex;
    }
    if (nearest >= 0 && smallest < (place(a) - place(b)).norm()) wanted_.insert(nearest);
  }
  bool keep_wanted() {
    for (const int v : wanted_) result_.kept[v] = 1;
    return !std::exchange(wanted_, {}).empty();
  }

  /// Whether every piece has its triangles.
  bool triangulate() {
    find_sides();
    for (const auto& [ends, side] : by_ends_)
      if (vertex(side.from) == vertex(side.to) || by_ends_.contains({side.to, side.from})) want(side);
    if (!wanted_.empty()) return false;
    std::vector<std::vector<int>> images(flat_.piece_count);
    std::vector<int> number(flat_.images.size());
    for (int i = 0; i < std::ssize(flat_.images); ++i) {
      if (!result_.kept[vertex(i)]) continue;
      auto& own = images[flat_.images[i].piece];
      number[i] = static_cast<int>(own.size());
      own.push_back(i);
    }
    std::vector<std::vector<const CoarseSide*>> sides(flat_.piece_count);
    for (const auto& [ends, side] : by_ends_) sides[flat_.images[side.from].piece].push_back(&side);
    std::vector<int> all;
    result_.first = {0};
    for (int p = 0; p < flat_.piece_count; ++p) {
      std::vector<Eigen::Vector2d> places;
      for (const int i : images[p]) places.push_back(place(i));
      std::vector<std::array<int, 2>> segments;
      for (const CoarseSide* side : sides[p]) segments.push_back({number[side->from], number[side->to]});
      const auto crossing = crossing_segments(places, segments);
      for (const auto& pair : crossing)
        for (const int s : pair) want(*sides[p][s]);
      if (crossing.empty()) {
        const Triangles own = triangles_within(places, segments);
        for (const int k : own.reshaped<Eigen::RowMajor>()) all.push_back(images[p][k]);
      }
      result_.first.push_back(static_cast<int>(all.size() / 3));
    }
    result_.triangles = Eigen::Map<const Triangles>(all.data(), static_cast<Eigen::Index>(all.size() / 3), 3);
    return wanted_.empty();
  }

  /// Whether triangles share edges only where the cloth does.
  bool is_a_mesh() {
    struct Use {
      std::pair<int, int> edge;  ///< the same for two triangles that the cloth joins there
      int from, to;
    };
    std::map<std::pair<int, int>, std::vector<Use>> uses;
    for (const auto& t : result_.triangles.rowwise())
      for (int k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        if (vertex(a) == vertex(b)) want(a, b);
        const auto side = by_ends_.find({a, b});
        uses[std::minmax({vertex(a), vertex(b)})].push_back(
            {side != by_ends_.end() ? std::pair(-1, side->second.edge) : std::minmax({a, b}), a, b});
      }
    for (const auto& [ends, own] : uses) {
      const bool joined = own.size() <= 2 && own.front().edge == own.back().edge &&
                          (own.size() == 1 || vertex(own[0].from) == vertex(own[1].to));
      if (!joined)
        for (const Use& use : own) want(use.from, use.to);
    }
    return wanted_.empty();
  }

  /// Inner vertices outside of the coarse outlines.
  void drop_unused() {
    std::vector<char> used(result_.kept.size(), 0);
    for (const int i : result_.triangles.reshaped()) used[vertex(i)] = 1;
    result_.kept = std::move(used);
  }

  const FlatCloth& flat_;
  AdjacencyList sides_;  // of the outline that begin at each image
  CoarsePieces result_;
  std::map<std::pair<int, int>, CoarseSide> by_ends_;
  std::set<int> wanted_;
};

}  // namespace

CoarsePieces CoarsePieces::of(const FlatCloth& flat, std::vector<char> kept) {
  return Builder(flat, std::move(kept)).build();
}

}  // namespace drape
