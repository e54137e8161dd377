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

/// Three numbers in double precision and one of padding.
using Double4 = double __attribute__((vector_size(32)));

/// A row of blocks, at given columns. Each row of a block is padded by a number without meaning.
class BlockRow {
 public:
  explicit BlockRow(int columns) : place_(static_cast<std::size_t>(columns)) {}

  /// Zeros at `count` columns.
  void clear(const int* columns, int count) {
    rows_.assign(3 * static_cast<std::size_t>(count), Double4{});
    for (int k = 0; k < count; ++k) place_[columns[k]] = 3 * k;
  }
  /// Adds w times the block, whose rows of three numbers are `stride` apart and may be read beyond their end.
  template <int stride>
  [[gnu::always_inline]] void add(int column, double w, const double* block) {
    Double4* rows = &rows_[static_cast<std::size_t>(place_[column])];
    for (int r = 0; r < 3; ++r) {
      Double4 v;
      std::memcpy(&v, block + stride * r, sizeof v);
      rows[r] += w * v;
    }
  }
  /// The block at the k-th of the columns, its rows 4 apart.
  const double* block(int k) const { return reinterpret_cast<const double*>(&rows_[3 * k]); }

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
  for (auto* v : {&x, &b, &r, &old}) v->resize(order.size());
}

MultigridMesh::MultigridMesh(const ProlongationMatrix& p, const MultigridMesh& coarse)
    : MultigridMesh(static_cast<int>(p.rows())) {
  const int n = size();
  std::vector<int> key(order.size());  // position of the parent with the largest weight
  for (int i = 0; i < n; ++i) {
    double largest = -1;
    for (ProlongationMatrix::InnerIterator it(p, i); it; ++it)
      if (it.value() > largest + 1e-9) largest = it.value(), key[i] = coarse.position[it.col()];
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key[a] < key[b]; });
  for (int q = 0; q < n; ++q) position[order[q]] = q;
  std::vector<Eigen::Triplet<float>> weights;
  for (int i = 0; i < n; ++i)
    for (ProlongationMatrix::InnerIterator it(p, i); it; ++it)
      weights.emplace_back(position[i], coarse.position[it.col()], static_cast<float>(it.value()));
  parents.resize(n, coarse.size());
  parents.setFromTriplets(weights.begin(), weights.end());
  children = parents.transpose();
}

void MultigridMesh::set_pattern(const std::shared_ptr<const BlockPattern>& given) {
  if (pattern_ == given) return;
  pattern_ = given;
  struct Entry {
    int column, source;
  };
  auto entries = Grouped<Entry>::of(size(), [&](const auto& add) {
    given->for_each_block([&](int i, int j, int k) {
      const int p = position[i], q = position[j];
      add(p, {q, k});
      if (p != q) add(q, {p, ~k});
    });
  });
  std::vector<int> columns(entries.items.size());
  source_.resize(entries.items.size());
  parallel_for(size(), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) std::ranges::sort(entries.row(i), {}, &Entry::column);
    for (int k = entries.start[begin]; k < entries.start[end]; ++k)
      columns[k] = entries.items[k].column, source_[k] = entries.items[k].source;
  });
  set_pattern({std::move(entries.start), std::move(columns)});
}

void MultigridMesh::set_pattern(AdjacencyList pattern) {
  values_.resize(9 * pattern.items.size() + 1);
  half_ = {};
  matrix.set_pattern(std::move(pattern));
}

void MultigridMesh::fill(const BlockMatrix& given, const Eigen::VectorXd& shift,
                         const std::vector<char>& fixed) {
  set_pattern(given.pattern);
  const std::vector<int>&start = matrix.pattern().start, &columns = matrix.pattern().items;
  parallel_for(size(), SmoothedMatrix::piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int vertex = order[i];
      for (int k = start[i]; k < start[i + 1]; ++k) {
        double* to = &values_[9 * static_cast<std::size_t>(k)];
        const bool is_diagonal = columns[k] == i;
        if (fixed[vertex] || fixed[order[columns[k]]]) {
          std::fill(to, to + 9, 0.0);
        } else {
          const bool turned = source_[k] < 0;
          const double* from = given.block(turned ? ~source_[k] : source_[k]);
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) to[3 * r + c] = turned ? from[3 * c + r] : from[3 * r + c];
          if (is_diagonal)
            for (int e = 0; e < 9; e += 4) to[e] += shift[vertex];
        }
        float* copy = matrix.block(k);
        round_to(copy, to);
        if (is_diagonal && fixed[vertex])
          for (int e = 0; e < 9; e += 4) copy[e] = 1;
      }
    }
  });
}

void MultigridMesh::find_product_pattern(MultigridMesh& coarse) {
  half_ = collect_columns(coarse.size(), size(), [&](int i, const auto& add) {
    for (Weights::InnerIterator child(children, i); child; ++child)
      for (const int j : matrix.pattern().row(static_cast<int>(child.col()))) add(j);
  });
  coarse.set_pattern(collect_columns(coarse.size(), coarse.size(), [&](int i, const auto& add) {
    for (const int j : half_.row(i))
      for (Weights::InnerIterator parent(parents, j); parent; ++parent) add(static_cast<int>(parent.col()));
    add(i);  // also where no child of the vertex has a block
  }));
}

double MultigridMesh::make_product(MultigridMesh& coarse) {
  if (half_.start.empty()) find_product_pattern(coarse);
  SmoothedMatrix& to = coarse.matrix;
  const std::vector<int>&start = matrix.pattern().start, &columns = matrix.pattern().items;
  const std::vector<int>&to_start = to.pattern().start, &to_columns = to.pattern().items;
  return parallel_sum(coarse.size(), product_piece, [&](int begin, int end) {
    BlockRow half(size()), sums(coarse.size());
    double count = 0;
    for (int i = begin; i < end; ++i) {
      const int* half_columns = half_.begin(i);
      const int half_count = half_.size(i);
      half.clear(half_columns, half_count);
      for (Weights::InnerIterator child(children, i); child; ++child) {
        const int first = start[child.col()], last = start[child.col() + 1];
        for (int k = first; k < last; ++k)
          half.add<3>(columns[k], child.value(), &values_[9 * static_cast<std::size_t>(k)]);
        count += last - first;
      }
      sums.clear(&to_columns[to_start[i]], to_start[i + 1] - to_start[i]);
      for (int k = 0; k < half_count; ++k)
        for (Weights::InnerIterator parent(parents, half_columns[k]); parent; ++parent, ++count)
          sums.add<4>(static_cast<int>(parent.col()), parent.value(), half.block(k));
      for (int k = to_start[i]; k < to_start[i + 1]; ++k) {
        const double* sum = sums.block(k - to_start[i]);
        double* value = &coarse.values_[9 * static_cast<std::size_t>(k)];
        for (int r = 0; r < 3; ++r) std::copy_n(sum + 4 * r, 3, value + 3 * r);
        // The block is 0 for a vertex whose children are all fixed.
        if (to_columns[k] == i && std::all_of(value, value + 9, [](double e) { return e == 0; }))
          for (int e = 0; e < 9; e += 4) value[e] = 1;
        round_to(to.block(k), value);
      }
    }
    return count;
  });
}

bool MultigridMesh::copy_to(BlockMatrix& to) const {
  std::vector<int> start = {0}, columns;
  std::vector<double> upper;
  for (int i = 0; i < size(); ++i) {
    for (int k = matrix.pattern().start[i]; k < matrix.pattern().start[i + 1]; ++k) {
      if (matrix.pattern().items[k] < i) continue;
      columns.push_back(matrix.pattern().items[k]);
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
