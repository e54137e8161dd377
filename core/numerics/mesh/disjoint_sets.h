#pragma once

#include <numeric>
#include <vector>

namespace drape {

/// Sets of the numbers 0 … count - 1, which are united pair by pair.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The number that stands for i's set.
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) { parent_[find(i)] = find(j); }
  /// For each number that of its set, from 0 in the order of their first elements.
  std::vector<int> numbered() {
    std::vector<int> of_set(parent_.size(), -1), all;
    int count = 0;
    for (int i = 0; i < static_cast<int>(parent_.size()); ++i) {
      int& own = of_set[find(i)];
      if (own < 0) own = count++;
      all.push_back(own);
    }
    return all;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace drape
