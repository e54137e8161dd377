#include "core/numerics/linear_algebra/supernodal_tree.h"

#include <algorithm>
#include <numeric>

namespace drape {
namespace {

/// Cost of a supernode in multiplications. Passing on an entry of the update matrix costs about as much as
/// twenty.
double work(double pivots, double updates) {
  pivots *= 3, updates *= 3;
  return pivots * pivots * pivots / 6 + pivots * pivots * updates / 2 + pivots * updates * updates / 2 +
         10 * updates * updates;
}

}  // namespace

SupernodalTree::SupernodalTree(Supernodes supernodes, FrontSizes sizes)
    : first_(std::move(supernodes.first)), rows_(std::move(supernodes.rows)) {
  find_children();
  panel_.assign(1, 0);
  for (int s = 0; s < count(); ++s) panel_.push_back(panel_[s] + sizes.panel(pivots(s), rows_.size(s)));
  cut();
  update_.resize(count());
  for (const Range& r : subtrees_) {
    std::vector<int> part(r.end - r.begin);
    std::iota(part.begin(), part.end(), r.begin);
    place_updates(part, sizes);
  }
  place_updates(top_, sizes);
}

void SupernodalTree::find_children() {
  std::vector<int> supernode(first_.back());  // of each position
  for (int s = 0; s < count(); ++s)
    std::fill(supernode.begin() + first_[s], supernode.begin() + first_[s + 1], s);
  parent_.assign(count(), -1);
  for (int s = 0; s < count(); ++s)
    if (rows_.size(s) > 0) parent_[s] = supernode[*rows_.begin(s)];
  children_ = AdjacencyList::of(count(), [&](const auto& add) {
    for (int s = 0; s < count(); ++s)
      if (parent_[s] >= 0) add(parent_[s], s);
  });
  relative_.resize(rows_.items.size());
  for (int s = 0; s < count(); ++s) {
    const int p = parent_[s];
    if (p < 0) continue;
    const int* row = rows_.begin(p);
    for (int k = rows_.start[s]; k < rows_.start[s + 1]; ++k) {
      const int position = rows_.items[k];
      if (position < first_[p + 1]) {
        relative_[k] = position - first_[p];
      } else {
        row = std::lower_bound(row, rows_.end(p), position);
        relative_[k] = pivots(p) + static_cast<int>(row - rows_.begin(p));
      }
    }
  }
}

/// From the roots down, splits the subtree with most work until none has more than a sixteenth of it.
void SupernodalTree::cut() {
  constexpr double max_fraction = 1.0 / 16;
  std::vector<double> sum(count());  // work of the whole subtree
  std::vector<int> begin(count());   // its first supernode
  std::iota(begin.begin(), begin.end(), 0);
  double all = 0;
  for (int s = 0; s < count(); ++s) {
    const double w = work(pivots(s), rows_.size(s));
    sum[s] += w;
    all += w;
    if (const int p = parent_[s]; p >= 0) sum[p] += sum[s], begin[p] = std::min(begin[p], begin[s]);
  }
  std::vector<int> roots;
  const auto less = [&](int s, int t) { return sum[s] != sum[t] ? sum[s] < sum[t] : s < t; };
  for (int s = 0; s < count(); ++s)
    if (parent_[s] < 0) roots.push_back(s);
  std::make_heap(roots.begin(), roots.end(), less);
  while (!roots.empty() && sum[roots.front()] > max_fraction * all) {
    std::pop_heap(roots.begin(), roots.end(), less);
    const int s = roots.back();
    roots.pop_back();
    top_.push_back(s);
    for (const int c : children_.row(s)) {
      roots.push_back(c);
      std::push_heap(roots.begin(), roots.end(), less);
    }
  }
  std::sort(top_.begin(), top_.end());
  std::sort_heap(roots.begin(), roots.end(), less);
  for (auto s = roots.rbegin(); s != roots.rend(); ++s) subtrees_.push_back({begin[*s], *s + 1});
}

/// Two stacks, for supernodes of even and odd depth: when s is done, in postorder, its children are on top of
/// one stack, and s goes onto the other.
void SupernodalTree::place_updates(const std::vector<int>& part, FrontSizes sizes) {
  std::size_t top[2] = {0, 0}, peak[2] = {0, 0};
  std::vector<int> odd(part.size());  // depth
  const auto index = [&](int s) {     // in the part, or its size
    const auto at = std::lower_bound(part.begin(), part.end(), s);
    return at != part.end() && *at == s ? static_cast<std::size_t>(at - part.begin()) : part.size();
  };
  for (std::size_t k = part.size(); k-- > 0;)
    if (const std::size_t p = index(parent_[part[k]]); p < part.size()) odd[k] = 1 - odd[p];
  for (std::size_t k = 0; k < part.size(); ++k) {
    const int s = part[k], mine = odd[k];
    update_[s] = top[mine];
    top[mine] += sizes.update(rows_.size(s));
    peak[mine] = std::max(peak[mine], top[mine]);
    for (const int c : children_.row(s))
      if (index(c) < part.size()) {
        top[1 - mine] = update_[c];
        break;
      }
  }
  for (std::size_t k = 0; k < part.size(); ++k) update_[part[k]] += update_size_ + (odd[k] ? peak[0] : 0);
  update_size_ += peak[0] + peak[1];
}

}  // namespace drape
