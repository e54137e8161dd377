#include "core/numerics/dressing/tightness.h"

#include <algorithm>
#include <functional>
#include <vector>

#include "core/numerics/elements/stretch.h"

namespace drape {

Tightness tightest_piece(const Level& level, const Positions& x) {
  constexpr double share = 0.1;
  struct Stretched {
    double stretch, area;
    int triangle;
  };
  std::vector<std::vector<Stretched>> pieces(level.rest.piece_names.size());
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const RestTriangle rest = RestTriangle::of(level, t);
    const double largest = rest.stretch(x.row(v[1]) - x.row(v[0]), x.row(v[2]) - x.row(v[0])).largest;
    pieces[level.rest.piece[t]].push_back({largest - 1, rest.area, t});
  }
  Tightness tightest{0, -1, 0};
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    std::ranges::stable_sort(pieces[p], std::greater(), &Stretched::stretch);
    double whole = 0, passed = 0;
    for (const Stretched& s : pieces[p]) whole += s.area;
    for (const Stretched& s : pieces[p]) {
      passed += s.area;
      if (passed < share * whole) continue;
      if (s.stretch > tightest.stretch) tightest = {static_cast<int>(p), s.stretch, pieces[p][0].triangle};
      break;
    }
  }
  return tightest;
}

}  // namespace drape
