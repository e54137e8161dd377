#include "core/numerics/supernodal_factor.h"

#include <algorithm>

#include "core/numerics/parallel.h"

namespace drape {

void SupernodalFactor::lay_out(SupernodalTree tree, const BlockPattern& pattern,
                               const std::vector<int>& order) {
  tree_ = std::move(tree);
  order_ = order;
  std::vector<int> place(pattern.rows(), -1), supernode(order.size());
  for (std::size_t p = 0; p < order.size(); ++p) place[order[p]] = static_cast<int>(p);
  for (int s = 0; s < tree_.count(); ++s) std::fill_n(supernode.begin() + tree_.first(s), tree_.own(s), s);

  const auto each_block = [&](auto&& visit) {  // with the places of its column and row in the factor
    for (int i = 0; i < pattern.rows(); ++i)
      for (int k = pattern.row_start[i]; k < pattern.row_start[i + 1]; ++k)
        if (const int p = place[i], q = place[pattern.columns[k]]; p >= 0 && q >= 0)
          visit(std::min(p, q), std::max(p, q), k, p < q);
  };
  entry_start_.assign(tree_.count() + 1, 0);
  each_block([&](int column, int, int, bool) { ++entry_start_[supernode[column] + 1]; });
  for (int s = 0; s < tree_.count(); ++s) entry_start_[s + 1] += entry_start_[s];
  entries_.resize(entry_start_.back());
  std::vector<int> at(entry_start_.begin(), entry_start_.end() - 1);
  each_block([&](int column, int row, int block, bool transposed) {
    const int s = supernode[column];
    int local = row - tree_.first(s);
    if (local >= tree_.own(s)) {
      const int* rows = tree_.rows().begin(s);
      local = tree_.own(s) + static_cast<int>(std::lower_bound(rows, tree_.rows().end(s), row) - rows);
    }
    entries_[at[s]++] = {block, local, column - tree_.first(s), transposed};
  });

  const auto grow = [](Eigen::VectorXd& v, std::size_t size) {
    if (static_cast<std::size_t>(v.size()) < size) v.resize(static_cast<Eigen::Index>(size));
  };
  vector_start_.assign(1, 0);
  for (int s = 0; s < tree_.count(); ++s)
    vector_start_.push_back(vector_start_[s] + padded(3 * tree_.own(s)) + padded(3 * tree_.rows().size(s)));
  grow(work_, vector_start_.back());
  grow(panels_, tree_.panel_size());
  grow(updates_, tree_.update_size());
}

Front SupernodalFactor::front(int s) {
  return {tree_.own(s), tree_.rows().size(s), panels_.data() + tree_.panel(s),
          updates_.data() + tree_.update(s)};
}

bool SupernodalFactor::factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
  failed_ = false;
  const auto run = [&](int s) {
    if (!failed_.load(std::memory_order_relaxed) && !eliminate(s, matrix, shift)) failed_ = true;
  };
  const auto& subtrees = tree_.subtrees();
  parallel_for(static_cast<int>(subtrees.size()), 1, [&](int k, int) {
    for (int s = subtrees[k].begin; s < subtrees[k].end; ++s) run(s);
  });
  for (const int s : tree_.top()) run(s);
  return !failed_;
}

bool SupernodalFactor::eliminate(int s, const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
  const Front f = front(s);
  assemble(s, f, matrix, shift);
  return drape::eliminate(f);
}

namespace {

void set_zero(double* begin, std::size_t size) {
  constexpr int piece = 1 << 15;
  parallel_for(static_cast<int>((size + piece - 1) / piece), 1, [&](int k, int) {
    double* from = begin + static_cast<std::size_t>(k) * piece;
    std::fill(from, std::min(from + piece, begin + size), 0.0);
  });
}

}  // namespace

void SupernodalFactor::assemble(int s, const Front& f, const BlockMatrix& matrix,
                                const Eigen::VectorXd& shift) {
  set_zero(f.panel, Front::panel_size(f.own, f.rest));
  set_zero(f.update, Front::update_size(f.rest));
  for (int k = entry_start_[s]; k < entry_start_[s + 1]; ++k) {
    const Entry& e = entries_[k];
    const double* b = matrix.block(e.block);
    const Strip strip = f.panel_strip(f.strip_of(e.row));
    double* to = strip.column(3 * e.column) + f.row_of(e.row);
    const int down = e.transposed ? 1 : 3, right = e.transposed ? 3 : 1;
    for (int c = 0; c < 3; ++c, to += strip.height)
      for (int r = 0; r < 3; ++r) to[r] = b[r * down + c * right];
    if (e.row == e.column)
      for (int c = 0; c < 3; ++c) to[(c - 3) * strip.height + c] += shift[order_[tree_.first(s) + e.row]];
  }
  for (int c = 3 * f.own; c < f.columns(); ++c) f.panel_strip(c / strip_rows).column(c)[c % strip_rows] = 1;
  const AdjacencyList& children = tree_.children();
  for (const int* c = children.begin(s); c != children.end(s); ++c)
    add_update(front(*c), tree_.places_in_parent(*c), f);
}

void SupernodalFactor::solve(Eigen::VectorXd& x) {
  const auto& subtrees = tree_.subtrees();
  const auto& top = tree_.top();
  parallel_for(static_cast<int>(subtrees.size()), 1, [&](int k, int) {
    for (int s = subtrees[k].begin; s < subtrees[k].end; ++s) forward(s, x);
  });
  for (const int s : top) forward(s, x);
  for (auto s = top.rbegin(); s != top.rend(); ++s) backward(*s, x);
  parallel_for(static_cast<int>(subtrees.size()), 1, [&](int k, int) {
    for (int s = subtrees[k].end - 1; s >= subtrees[k].begin; --s) backward(s, x);
  });
}

void SupernodalFactor::forward(int s, const Eigen::VectorXd& x) {
  const Front f = front(s);
  double* own = work_.data() + vector_start_[s];
  double* rest = own + f.columns();
  std::fill(own, work_.data() + vector_start_[s + 1], 0.0);
  std::copy_n(x.data() + 3 * tree_.first(s), 3 * f.own, own);
  const AdjacencyList& children = tree_.children();
  for (const int* c = children.begin(s); c != children.end(s); ++c) {
    const int* places = tree_.places_in_parent(*c);
    const double* from = work_.data() + vector_start_[*c] + padded(3 * tree_.own(*c));
    for (int k = 0; k < tree_.rows().size(*c); ++k) {
      double* to = places[k] < f.own ? own + 3 * places[k] : rest + 3 * (places[k] - f.own);
      for (int d = 0; d < 3; ++d) to[d] += from[3 * k + d];
    }
  }
  solve_forward(f, own);
}

void SupernodalFactor::backward(int s, Eigen::VectorXd& x) {
  const Front f = front(s);
  double* own = work_.data() + vector_start_[s];
  double* rest = own + f.columns();
  const int* rows = tree_.rows().begin(s);
  for (int k = 0; k < f.rest; ++k)
    for (int d = 0; d < 3; ++d) rest[3 * k + d] = x[3 * rows[k] + d];
  solve_backward(f, own);
  std::copy_n(own, 3 * f.own, x.data() + 3 * tree_.first(s));
}

}  // namespace drape
