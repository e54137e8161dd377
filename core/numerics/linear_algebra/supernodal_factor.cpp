#include "core/numerics/linear_algebra/supernodal_factor.h"

#include <algorithm>
#include <atomic>

namespace drape {

template <class Scalar>
void SupernodalFactor<Scalar>::set_structure(const BlockPattern& pattern, const std::vector<int>& ordering,
                                             Supernodes supernodes) {
  tree_ = SupernodalTree(std::move(supernodes), {&Front<Scalar>::panel_size, &Front<Scalar>::update_size});
  ordering_ = ordering;
  const std::vector<int> position = positions_in(ordering, pattern.rows());
  std::vector<int> supernode(ordering.size());
  for (int s = 0; s < tree_.count(); ++s) std::fill_n(supernode.begin() + tree_.first(s), tree_.pivots(s), s);

  entries_ = Grouped<Entry>::of(tree_.count(), [&](const auto& add) {
    for_each_lower_block(pattern, position, [&](int column, int row, int block, bool transposed) {
      const int s = supernode[column];
      int local = row - tree_.first(s);
      if (local >= tree_.pivots(s)) {
        const int* rows = tree_.rows().begin(s);
        local = tree_.pivots(s) + static_cast<int>(std::lower_bound(rows, tree_.rows().end(s), row) - rows);
      }
      add(s, {block, local, column - tree_.first(s), transposed});
    });
  });

  const auto grow = [](Vector& v, std::size_t size) {
    if (static_cast<std::size_t>(v.size()) < size) v.resize(static_cast<Eigen::Index>(size));
  };
  vector_start_.assign(1, 0);
  for (int s = 0; s < tree_.count(); ++s)
    vector_start_.push_back(vector_start_[s] + padded<Scalar>(3 * tree_.pivots(s)) +
                            padded<Scalar>(3 * tree_.rows().size(s)));
  grow(work_, vector_start_.back());
  grow(panels_, tree_.panel_size());
  grow(updates_, tree_.update_size());
}

template <class Scalar>
Front<Scalar> SupernodalFactor<Scalar>::front(int s) {
  return {tree_.pivots(s), tree_.rows().size(s), panels_.data() + tree_.panel(s),
          updates_.data() + tree_.update(s)};
}

template <class Scalar>
bool SupernodalFactor<Scalar>::factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
  [[maybe_unused]] const KernelMode<Scalar> mode;
  std::atomic<bool> failed = false;
  const auto run = [&](int s) {
    if (failed.load(std::memory_order_relaxed)) return;
    const Front<Scalar> f = front(s);
    assemble(s, f, matrix, shift);
    if (!f.eliminate()) failed = true;
  };
  const auto& subtrees = tree_.subtrees();
  parallel_kernels<Scalar>(static_cast<int>(subtrees.size()), 1, [&](int k, int) {
    for (int s = subtrees[k].begin; s < subtrees[k].end; ++s) run(s);
  });
  for (const int s : tree_.top()) run(s);
  return !failed;
}

namespace {

template <class Scalar>
void set_zero(Scalar* begin, std::size_t size) {
  constexpr int piece = 1 << 15;
  parallel_kernels<Scalar>(static_cast<int>((size + piece - 1) / piece), 1, [&](int k, int) {
    Scalar* from = begin + static_cast<std::size_t>(k) * piece;
    std::fill(from, std::min(from + piece, begin + size), Scalar(0));
  });
}

}  // namespace

template <class Scalar>
void SupernodalFactor<Scalar>::assemble(int s, const Front<Scalar>& f, const BlockMatrix& matrix,
                                        const Eigen::VectorXd& shift) {
  set_zero(f.panel, Front<Scalar>::panel_size(f.pivots, f.updates));
  set_zero(f.update, Front<Scalar>::update_size(f.updates));
  for (const Entry& e : entries_.row(s)) {
    const double* b = matrix.block(e.block);
    const RowPanel<Scalar> row_panel = f.panel_rows(f.row_panel_of(e.row));
    Scalar* to = row_panel.column(3 * e.column) + f.row_of(e.row);
    const int down = e.transposed ? 1 : 3, right = e.transposed ? 3 : 1;
    for (int c = 0; c < 3; ++c, to += row_panel.height)
      for (int r = 0; r < 3; ++r) to[r] = static_cast<Scalar>(b[r * down + c * right]);
    if (e.row == e.column)
      for (int c = 0; c < 3; ++c)
        to[(c - 3) * row_panel.height + c] += static_cast<Scalar>(shift[ordering_[tree_.first(s) + e.row]]);
  }
  for (int c = 3 * f.pivots; c < f.columns(); ++c)
    f.panel_rows(c / row_panel_height<Scalar>).column(c)[c % row_panel_height<Scalar>] = 1;
  for (const int c : tree_.children().row(s)) f.add_update(front(c), tree_.indices_in_parent(c));
}

template <class Scalar>
void SupernodalFactor<Scalar>::solve(Eigen::VectorXd& x) {
  [[maybe_unused]] const KernelMode<Scalar> mode;
  const auto& subtrees = tree_.subtrees();
  const auto& top = tree_.top();
  parallel_kernels<Scalar>(static_cast<int>(subtrees.size()), 1, [&](int k, int) {
    for (int s = subtrees[k].begin; s < subtrees[k].end; ++s) forward(s, x);
  });
  for (const int s : top) forward(s, x);
  for (auto s = top.rbegin(); s != top.rend(); ++s) backward(*s, x);
  parallel_kernels<Scalar>(static_cast<int>(subtrees.size()), 1, [&](int k, int) {
    for (int s = subtrees[k].end - 1; s >= subtrees[k].begin; --s) backward(s, x);
  });
}

template <class Scalar>
void SupernodalFactor<Scalar>::forward(int s, const Eigen::VectorXd& x) {
  const Front<Scalar> f = front(s);
  Scalar* pivots = work_.data() + vector_start_[s];
  Scalar* updates = pivots + f.columns();
  std::fill(pivots, work_.data() + vector_start_[s + 1], Scalar(0));
  for (int k = 0; k < 3 * f.pivots; ++k) pivots[k] = static_cast<Scalar>(x[3 * tree_.first(s) + k]);
  for (const int c : tree_.children().row(s)) {
    const int* indices = tree_.indices_in_parent(c);
    const Scalar* from = work_.data() + vector_start_[c] + padded<Scalar>(3 * tree_.pivots(c));
    for (int k = 0; k < tree_.rows().size(c); ++k) {
      Scalar* to = indices[k] < f.pivots ? pivots + 3 * indices[k] : updates + 3 * (indices[k] - f.pivots);
      for (int d = 0; d < 3; ++d) to[d] += from[3 * k + d];
    }
  }
  f.solve_forward(pivots);
}

template <class Scalar>
void SupernodalFactor<Scalar>::backward(int s, Eigen::VectorXd& x) {
  const Front<Scalar> f = front(s);
  Scalar* pivots = work_.data() + vector_start_[s];
  Scalar* updates = pivots + f.columns();
  const int* rows = tree_.rows().begin(s);
  for (int k = 0; k < f.updates; ++k)
    for (int d = 0; d < 3; ++d) updates[3 * k + d] = static_cast<Scalar>(x[3 * rows[k] + d]);
  f.solve_backward(pivots);
  std::copy_n(pivots, 3 * f.pivots, x.data() + 3 * tree_.first(s));
}

template class SupernodalFactor<double>;
template class SupernodalFactor<float>;

}  // namespace drape
