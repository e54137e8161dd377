#include "core/numerics/multigrid/multigrid_mesh.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

/// Coarse rows that one piece of a Galerkin product makes.
constexpr int product_piece = 512;
constexpr double no_block[12] = {};

/// Three numbers in double precision and one of padding.
using Double4 = double __attribute__((vector_size(32)));

/// The blocks of some rows by column.
struct Blocks {
  std::vector<int> row_start, columns;  // row_start counts from 0
  std::vector<double> values;           // 9 a block, row-major
};

/// Sums of blocks by column. Each row of a block is padded by a number of no meaning.
class BlockSums {
 public:
  explicit BlockSums(int columns) : place_(static_cast<std::size_t>(columns), -1) {}

  /// Adds w times the block, whose rows of three numbers are `stride` apart and may be read beyond their end.
  template <int stride>
  [[gnu::always_inline]] void add(int column, double w, const double* block) {
    int& place = place_[static_cast<std::size_t>(column)];
    const bool is_new = place < 0;
    if (is_new) {
      place = static_cast<int>(touched.size());
      touched.push_back(column);
      if (rows_.size() < 3 * touched.size()) rows_.resize(2 * rows_.size() + 768);
    }
    Double4* rows = &rows_[3 * static_cast<std::size_t>(place)];
    for (int r = 0; r < 3; ++r) {
      Double4 v;
      std::memcpy(&v, block + stride * r, sizeof v);
      rows[r] = is_new ? w * v : rows[r] + w * v;
    }
  }
  const double* operator[](int column) const {
    const int place = place_[static_cast<std::size_t>(column)];
    return reinterpret_cast<const double*>(&rows_[3 * static_cast<std::size_t>(place)]);
  }
  void clear() {
    for (const int c : touched) place_[static_cast<std::size_t>(c)] = -1;
    touched.clear();
  }

  std::vector<int> touched;  ///< columns

 private:
  std::vector<int> place_;
  std::vector<Double4> rows_;
};

/// A row-major block as one of SmoothedMatrix.
void round_to(float* block, const double* row_major) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) block[3 * c + r] = static_cast<float>(row_major[3 * r + c]);
}

}  // namespace

MultigridMesh::MultigridMesh(int vertices) : order(static_cast<std::size_t>(vertices)) {
  std::iota(order.begin(), order.end(), 0);
  position = order;
  resize();
}

MultigridMesh::MultigridMesh(const ProlongationMatrix& p, const MultigridMesh& coarse)
    : order(static_cast<std::size_t>(p.rows())), position(order.size()) {
  const int n = static_cast<int>(p.rows());
  std::vector<int> key(order.size());  // position of the parent with the largest weight
  for (int i = 0; i < n; ++i) {
    double largest = -1;
    for (ProlongationMatrix::InnerIterator it(p, i); it; ++it)
      if (it.value() > largest + 1e-9) largest = it.value(), key[i] = coarse.position[it.col()];
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key[a] < key[b]; });
  for (int q = 0; q < n; ++q) position[order[q]] = q;
  std::vector<Eigen::Triplet<float>> weights;
  for (int i = 0; i < n; ++i)
    for (ProlongationMatrix::InnerIterator it(p, i); it; ++it)
      weights.emplace_back(position[i], coarse.position[it.col()], static_cast<float>(it.value()));
  parents.resize(n, coarse.size());
  parents.setFromTriplets(weights.begin(), weights.end());
  children = parents.transpose();
  resize();
}

void MultigridMesh::resize() {
  for (auto* v : {&x, &b, &r, &old}) v->resize(order.size());
}

void MultigridMesh::set_pattern(const std::shared_ptr<const BlockPattern>& given) {
  if (pattern_ == given) return;
  pattern_ = given;
  const int n = size();
  auto& start = matrix.row_start;
  start.assign(static_cast<std::size_t>(n) + 1, 0);
  const auto visit = [&](const auto& each) {
    for (int i = 0; i < n; ++i)
      for (int k = given->row_start[i]; k < given->row_start[i + 1]; ++k) {
        const int p = position[i], q = position[given->columns[k]];
        each(p, q, k);
        if (p != q) each(q, p, ~k);
      }
  };
  visit([&](int row, int, int) { ++start[row + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  struct Entry {
    int column, source;
  };
  std::vector<Entry> entries(static_cast<std::size_t>(start[n]));
  std::vector<int> next(start.begin(), start.end() - 1);
  visit([&](int row, int column, int block) { entries[next[row]++] = {column, block}; });
  matrix.columns.resize(entries.size());
  source_.resize(entries.size());
  parallel_for(n, 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      std::sort(entries.begin() + start[i], entries.begin() + start[i + 1],
                [](const Entry& a, const Entry& b) { return a.column < b.column; });
    for (int k = start[begin]; k < start[end]; ++k)
      matrix.columns[k] = entries[k].column, source_[k] = entries[k].source;
  });
  matrix.allocate();
  values_.resize(9 * entries.size() + 1);
}

void MultigridMesh::fill(const BlockMatrix& given, const Eigen::VectorXd& shift,
                         const std::vector<char>& fixed) {
  set_pattern(given.pattern);
  parallel_for(size(), SmoothedMatrix::piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int vertex = order[i];
      for (int k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k) {
        double* to = &values_[9 * static_cast<std::size_t>(k)];
        const bool is_diagonal = matrix.columns[k] == i;
        if (fixed[vertex] || fixed[order[matrix.columns[k]]]) {
          std::fill(to, to + 9, 0.0);
        } else {
          const bool turned = source_[k] < 0;
          const double* from = given.block(turned ? ~source_[k] : source_[k]);
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) to[3 * r + c] = turned ? from[3 * c + r] : from[3 * r + c];
          if (is_diagonal)
            for (int e = 0; e < 9; e += 4) to[e] += shift[vertex];
        }
        float* copy = matrix.block(static_cast<std::size_t>(k));
        round_to(copy, to);
        if (is_diagonal && fixed[vertex])
          for (int e = 0; e < 9; e += 4) copy[e] = 1;
      }
    }
  });
}

double MultigridMesh::make_product(MultigridMesh& coarse) const {
  const int pieces = (coarse.size() + product_piece - 1) / product_piece;
  std::vector<Blocks> parts(static_cast<std::size_t>(pieces));
  const double terms = parallel_sum(coarse.size(), product_piece, [&](int begin, int end) {
    Blocks& part = parts[static_cast<std::size_t>(begin / product_piece)];
    BlockSums half(size()), sums(coarse.size());
    double count = 0;
    for (int i = begin; i < end; ++i) {
      part.row_start.push_back(static_cast<int>(part.columns.size()));
      for (Weights::InnerIterator child(children, i); child; ++child) {
        const int first = matrix.row_start[child.col()], last = matrix.row_start[child.col() + 1];
        for (int k = first; k < last; ++k)
          half.add<3>(matrix.columns[k], child.value(), &values_[9 * static_cast<std::size_t>(k)]);
        count += last - first;
      }
      for (const int j : half.touched)
        for (Weights::InnerIterator parent(parents, j); parent; ++parent, ++count)
          sums.add<4>(static_cast<int>(parent.col()), parent.value(), half[j]);
      sums.add<4>(i, 0, no_block);  // the diagonal, also of a vertex whose children are all fixed
      std::sort(sums.touched.begin(), sums.touched.end());
      for (const int j : sums.touched) {
        part.columns.push_back(j);
        for (int r = 0; r < 3; ++r)
          part.values.insert(part.values.end(), sums[j] + 4 * r, sums[j] + 4 * r + 3);
      }
      half.clear();
      sums.clear();
    }
    return count;
  });
  SmoothedMatrix& to = coarse.matrix;
  to.row_start.clear();
  std::vector<int> first;
  int blocks = 0;
  for (const Blocks& part : parts) {
    first.push_back(blocks);
    for (const int start : part.row_start) to.row_start.push_back(blocks + start);
    blocks += static_cast<int>(part.columns.size());
  }
  to.row_start.push_back(blocks);
  to.columns.resize(static_cast<std::size_t>(blocks));
  coarse.values_.resize(9 * static_cast<std::size_t>(blocks) + 1);
  to.values.resize(9 * static_cast<std::size_t>(blocks) + 4);
  parallel_for(pieces, 1, [&](int begin, int) {
    const Blocks& part = parts[static_cast<std::size_t>(begin)];
    std::copy(part.columns.begin(), part.columns.end(), to.columns.begin() + first[begin]);
    std::copy(part.values.begin(), part.values.end(),
              coarse.values_.begin() + 9 * static_cast<std::ptrdiff_t>(first[begin]));
  });
  parallel_for(coarse.size(), product_piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      for (int k = to.row_start[i]; k < to.row_start[i + 1]; ++k) {
        double* from = &coarse.values_[9 * static_cast<std::size_t>(k)];
        if (to.columns[k] == i && std::all_of(from, from + 9, [](double e) { return e == 0; }))
          for (int e = 0; e < 9; e += 4) from[e] = 1;
        round_to(to.block(static_cast<std::size_t>(k)), from);
      }
  });
  return terms;
}

bool MultigridMesh::copy_to(BlockMatrix& to) const {
  std::vector<int> start = {0}, columns;
  std::vector<double> upper;
  for (int i = 0; i < size(); ++i) {
    for (int k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k) {
      if (matrix.columns[k] < i) continue;
      columns.push_back(matrix.columns[k]);
      const double* block = &values_[9 * static_cast<std::size_t>(k)];
      upper.insert(upper.end(), block, block + 9);
    }
    start.push_back(static_cast<int>(columns.size()));
  }
  const bool is_new = !to.pattern || to.pattern->columns != columns || to.pattern->row_start != start;
  if (is_new) to = BlockMatrix(std::make_shared<const BlockPattern>(std::move(start), std::move(columns)));
  to.values = std::move(upper);
  return is_new;
}

}  // namespace drape
