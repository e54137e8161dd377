#include "core/numerics/linear_algebra/block_matrix.h"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace drape {
namespace {

/// Refuses elements of [begin, end) that repeat a vertex or name one out of range.
void require_vertices(int vertex_count, const Stencils& stencils, Eigen::Index begin, Eigen::Index end) {
  for (Eigen::Index e = begin; e < end; ++e)
    for (Eigen::Index a = 0; a < stencils.cols(); ++a) {
      const int v = stencils(e, a);
      if (v == -1) continue;
      bool repeated = false;
      for (Eigen::Index b = 0; b < a; ++b) repeated |= stencils(e, b) == v;
      if (v < 0 || v >= vertex_count || repeated)
        throw std::runtime_error("block pattern: element " + std::to_string(e) + " of " +
                                 std::to_string(stencils.cols()) + " vertices " +
                                 (repeated ? "repeats vertex " : "has vertex ") + std::to_string(v) +
                                 (repeated ? "" : ", outside 0 … " + std::to_string(vertex_count - 1)));
    }
}

}  // namespace

std::shared_ptr<const BlockPattern> BlockPattern::of(int vertex_count,
                                                     const std::vector<Stencils>& stencils) {
  std::vector<AdjacencyList> elements;  // of each vertex, for each stencil array
  for (const Stencils& s : stencils) {
    require_vertices(vertex_count, s, 0, s.rows());
    elements.push_back(AdjacencyList::of(vertex_count, [&](const auto& add) {
      for (int e = 0; e < s.rows(); ++e)
        for (const int v : s.row(e))
          if (v >= 0) add(v, e);
    }));
  }
  return collect(vertex_count, [&](int i, const auto& add) {
    for (std::size_t s = 0; s < stencils.size(); ++s)
      for (const int e : elements[s].row(i)) {
        const int* row = stencils[s].data() + e * stencils[s].cols();
        std::for_each_n(row, stencils[s].cols(), add);
      }
  });
}

BlockPattern::BlockPattern(std::vector<int> row_start_in, std::vector<int> columns_in)
    : row_start(std::move(row_start_in)), columns(std::move(columns_in)) {
  if (row_start.empty() || row_start.front() != 0 || row_start.back() != blocks())
    throw std::runtime_error("block pattern: row starts must run from 0 to the number of columns");
  for (int i = 0; i < rows(); ++i) {
    bool good = row_start[i] < row_start[i + 1] && columns[row_start[i]] == i;
    for (int b = row_start[i] + 1; good && b < row_start[i + 1]; ++b)
      good = columns[b - 1] < columns[b] && columns[b] < rows();
    if (!good)
      throw std::runtime_error("block pattern: row " + std::to_string(i) +
                               " must have its diagonal first, then ascending columns");
  }
}

AdjacencyList BlockPattern::neighbours() const {
  return AdjacencyList::of(rows(), [&](const auto& add) {
    for_each_block([&](int i, int j, int) {
      add(i, j);
      if (j != i) add(j, i);
    });
  });
}

int BlockPattern::find(int i, int j) const {
  const auto begin = columns.begin() + row_start[i], end = columns.begin() + row_start[i + 1];
  const auto found = std::lower_bound(begin, end, j);
  return found != end && *found == j ? static_cast<int>(found - columns.begin()) : -1;
}

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> p) : pattern(std::move(p)) {
  if (pattern) values.assign(9 * static_cast<std::size_t>(pattern->blocks()), 0.0);
}

void BlockMatrix::set_zero() {
  parallel_for(static_cast<int>(values.size() / 9), 65536,
               [&](int begin, int end) { std::fill(block(begin), block(end), 0.0); });
}

void BlockMatrix::multiply(const Positions& x, Positions& y) const {
  if (x.rows() != pattern->rows())
    throw std::runtime_error("block matrix of " + std::to_string(pattern->rows()) + " rows times " +
                             std::to_string(x.rows()) + " vectors");
  if (&x == &y) return multiply(Positions(x), y);
  y.setZero(x.rows(), 3);
  constexpr int few = 16384;  // blocks, for which threads do not pay
  const std::vector<int>& start = pattern->row_start;
  const int parts = pattern->blocks() < few ? 1 : thread_count();
  const auto first_row = [&](int part) {
    const auto block = static_cast<int>(static_cast<std::int64_t>(pattern->blocks()) * part / parts);
    return static_cast<int>(std::ranges::lower_bound(start, block) - start.begin());
  };
  parallel_for(parts, 1, [&](int k, int) { multiply_rows(first_row(k), first_row(k + 1), x, y); });
}

// Adds to each row of y in the order of the blocks, whatever part of the rows it is in: the same bits.
void BlockMatrix::multiply_rows(int begin, int end, const Positions& x, Positions& y) const {
  using Block = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  const int* columns = pattern->columns.data();
  for (int i = 0; i < end; ++i) {
    const Eigen::RowVector3d xi = x.row(i);
    int b = pattern->row_start[i];
    const int row_end = pattern->row_start[i + 1];
    if (i < begin) {
      if (columns[row_end - 1] < begin) continue;
      for (b = static_cast<int>(std::lower_bound(columns + b, columns + row_end, begin) - columns);
           b < row_end && columns[b] < end; ++b)
        y.row(columns[b]).noalias() += xi * Block(block(b));
      continue;
    }
    Eigen::RowVector3d sum = xi * Block(block(b)).transpose();
    for (++b; b < row_end; ++b) {
      const int j = columns[b];
      sum.noalias() += x.row(j) * Block(block(b)).transpose();
      if (j < end) y.row(j).noalias() += xi * Block(block(b));
    }
    y.row(i) += sum;
  }
}

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const int n = matrix.pattern->rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  matrix.pattern->for_each_block([&](int i, int j, int b) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(matrix.block(b));
    all.block<3, 3>(3 * j, 3 * i) = block.transpose();
    all.block<3, 3>(3 * i, 3 * j) = block;
  });
  return all;
}

BlockSlots::BlockSlots(const BlockPattern& pattern, const Stencils& stencils)
    : pairs_(static_cast<int>(stencils.cols() * (stencils.cols() + 1) / 2)),
      slots_(static_cast<std::size_t>(stencils.rows()) * pairs_) {
  parallel_for(static_cast<int>(stencils.rows()), 512, [&](int begin, int end) {
    require_vertices(pattern.rows(), stencils, begin, end);
    for (int e = begin; e < end; ++e) {
      int* slots = slots_.data() + static_cast<std::size_t>(e) * pairs_;
      for (Eigen::Index b = 0; b < stencils.cols(); ++b)
        for (Eigen::Index a = 0; a <= b; ++a) {
          const int i = stencils(e, a), j = stencils(e, b);
          if (i < 0 || j < 0) {
            *slots++ = BlockSink::no_block;
            continue;
          }
          const int slot = pattern.find(std::min(i, j), std::max(i, j));
          if (slot < 0)
            throw std::runtime_error("block pattern has no block for vertices " + std::to_string(i) +
                                     " and " + std::to_string(j) + " of element " + std::to_string(e));
          *slots++ = i <= j ? slot : ~slot;
        }
    }
  });
}

}  // namespace drape
