#include "plugins/refiner/coarsen/former_pieces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace drape {
namespace {

/// Finds fours of triangles: an inner one and those across its three edges.
class Fours {
 public:
  Fours(const Level& fine, const FlatCloth& flat)
      : fine_(fine),
        flat_(flat),
        inner_(fine.triangle_count(), -1),
        kind_(fine.vertex_count(), Kind::unknown) {}

  /// Whether all triangles belong to fours.
  bool find() {
    if (fine_.triangle_count() % 4 != 0) return false;
    for (int t = 0; t < fine_.triangle_count(); ++t) {
      if (inner_[t] >= 0) continue;
      bool grown = false;
      for (const int candidate : {t, across(t, 0), across(t, 1), across(t, 2)})
        grown = grown || (candidate >= 0 && grow_from(candidate));
      if (!grown) return false;
    }
    return true;
  }

  CoarsePieces pieces() const {
    CoarsePieces result;
    for (const Kind kind : kind_) result.kept.push_back(kind == Kind::old ? 1 : 0);
    std::vector<int> order;
    for (int t = 0; t < fine_.triangle_count(); ++t)
      if (inner_[t] == t) order.push_back(t);
    std::ranges::stable_sort(order, {}, [&](int t) { return flat_.piece[t]; });
    result.triangles.resize(static_cast<Eigen::Index>(order.size()), 3);
    result.first.assign(flat_.piece_count + 1, 0);
    for (int i = 0; i < std::ssize(order); ++i) {
      for (int k = 0; k < 3; ++k) result.triangles(i, k) = far_corner(order[i], k);
      ++result.first[flat_.piece[order[i]] + 1];
    }
    std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
    return result;
  }

 private:
  enum class Kind { unknown, old, added };  // vertices: of the former mesh, or on its edges

  /// The triangle across the edge opposite corner k, -1 beyond a border.
  int across(int t, int k) const {
    const auto both = fine_.topology.edge_triangles.row(fine_.topology.triangle_edges(t, k));
    return both[0] == t ? both[1] : both[0];
  }
  /// The corner of that triangle that t does not have, an image.
  int far_corner(int t, int k) const {
    return flat_.triangles(across(t, k),
                           fine_.topology.corner_opposite(fine_.topology.triangle_edges(t, k), across(t, k)));
  }
  bool is(int v, Kind kind) {
    if (kind_[v] == Kind::unknown) named_.push_back(v), kind_[v] = kind;
    return kind_[v] == kind;
  }

  /// Makes the four around an inner triangle; false if that contradicts one that is there.
  bool make(int t) {
    std::array<int, 3> outer;
    for (int k = 0; k < 3; ++k) {
      outer[k] = across(t, k);
      if (outer[k] < 0 || inner_[outer[k]] >= 0 || flat_.piece[outer[k]] != flat_.piece[t]) return false;
    }
    if (inner_[t] >= 0) return false;
    inner_[t] = t;
    made_.push_back(t);
    for (int k = 0; k < 3; ++k) {
      inner_[outer[k]] = t;
      made_.push_back(outer[k]);
      if (!is(fine_.rest.triangles(t, k), Kind::added) ||
          !is(flat_.images[far_corner(t, k)].vertex, Kind::old) || !is_halfway(t, k))
        return false;
    }
    return true;
  }

  /// Whether corner k of an inner triangle lies about halfway between the former vertices beside it.
  bool is_halfway(int t, int k) const {
    constexpr double most = 0.25;  // of their distance
    const auto place = [&](int image) { return flat_.images[image].place; };
    const Eigen::Vector2d a = place(far_corner(t, (k + 1) % 3)), b = place(far_corner(t, (k + 2) % 3));
    return (place(flat_.triangles(t, k)) - (a + b) / 2).norm() <= most * (b - a).norm();
  }

  /// Makes the fours of a connected part from its first one, or none of them.
  bool grow_from(int first) {
    made_.clear();
    named_.clear();
    if (make(first) && grow()) return true;
    for (const int t : made_) inner_[t] = -1;
    for (const int v : named_) kind_[v] = Kind::unknown;
    return false;
  }

  bool grow() {
    for (std::size_t i = 0; i < made_.size(); ++i) {
      const int t = made_[i];
      if (inner_[t] == t) continue;
      for (int k = 0; k < 3; ++k) {
        // Across a half of a former edge is an outer triangle, whose own four is beyond its other two
        // corners.
        const int other = across(t, k);
        if (other < 0 || other == inner_[t] || inner_[other] >= 0) continue;
        int old = -1;
        for (int c = 0; c < 3; ++c)
          if (kind_[fine_.rest.triangles(other, c)] == Kind::old) old = c;
        if (old < 0 || across(other, old) < 0 || !make(across(other, old))) return false;
      }
    }
    return true;
  }

  const Level& fine_;
  const FlatCloth& flat_;
  std::vector<int> inner_;         // of each triangle's four; -1: none yet
  std::vector<Kind> kind_;         // of each vertex
  std::vector<int> made_, named_;  // triangles and vertices of the part that grows
};

}  // namespace

std::optional<CoarsePieces> former_pieces(const Level& fine, const FlatCloth& flat) {
  Fours fours(fine, flat);
  if (!fours.find()) return std::nullopt;
  return fours.pieces();
}

}  // namespace drape
