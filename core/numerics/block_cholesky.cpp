#include "core/numerics/block_cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <stdexcept>

#include "core/numerics/parallel.h"

extern "C" void openblas_set_num_threads(int);

namespace drape {

namespace {

int chosen_blas_threads = 1;

}  // namespace

void set_blas_threads(int threads) {
  chosen_blas_threads = threads;
  openblas_set_num_threads(threads);
}

int blas_threads() { return chosen_blas_threads; }

struct BlockCholesky::Cholmod {
  cholmod_common common;
  cholmod_sparse* matrix = nullptr;  // lower triangle, in elimination order
  cholmod_factor* factor = nullptr;
  cholmod_dense* rhs = nullptr;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;

  Cholmod() {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    // Supernodes three times as wide as by default, since every vertex brings three columns, and more zeros
    // allowed in them: fewer, larger dense products, 1.3 to 1.7 times as fast on shell matrices.
    const std::size_t columns[] = {12, 48, 144};
    const double zeros[] = {0.8, 0.3, 0.1};
    std::copy(std::begin(columns), std::end(columns), common.nrelax);
    std::copy(std::begin(zeros), std::end(zeros), common.zrelax);
  }
  void clear() {
    cholmod_free_sparse(&matrix, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_free_dense(&rhs, &common);
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
  }
  ~Cholmod() {
    clear();
    cholmod_finish(&common);
  }
  void require(const void* result, const char* what) const {
    if (!result)
      throw std::runtime_error(std::string("sparse Cholesky: ") + what + " failed (CHOLMOD status " +
                               std::to_string(common.status) + "; -2 means out of memory)");
  }
};

BlockCholesky::BlockCholesky() : c_(std::make_unique<Cholmod>()) {
  openblas_set_num_threads(chosen_blas_threads);  // OpenBLAS itself would take every core
}

BlockCholesky::~BlockCholesky() = default;

int BlockCholesky::unknowns() const { return 3 * static_cast<int>(order_.size()); }
double BlockCholesky::flops() const { return c_->common.fl; }
double BlockCholesky::factor_entries() const { return c_->common.lnz; }

namespace {

/// A fill-reducing, postordered elimination order of the graph of free vertices.
std::vector<int> nested_dissection(const BlockPattern& pattern, const std::vector<int>& place,
                                   const std::vector<int>& free, cholmod_common& common) {
  const int n = static_cast<int>(free.size());
  std::size_t entries = 0;
  for (int v : free)
    for (int k = pattern.row_start[v]; k < pattern.row_start[v + 1]; ++k)
      entries += place[pattern.columns[k]] >= 0;
  cholmod_sparse* graph = cholmod_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_PATTERN, &common);
  if (!graph) throw std::runtime_error("sparse Cholesky: out of memory");
  auto* start = static_cast<int*>(graph->p);
  auto* rows = static_cast<int*>(graph->i);
  int at = 0;
  for (int c = 0; c < n; ++c) {  // row i of the upper triangle is column i of the lower
    start[c] = at;
    for (int k = pattern.row_start[free[c]]; k < pattern.row_start[free[c] + 1]; ++k)
      if (const int r = place[pattern.columns[k]]; r >= 0) rows[at++] = r;
  }
  start[n] = at;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_METIS;
  common.postorder = 1;
  cholmod_factor* symbolic = cholmod_analyze(graph, &common);
  cholmod_free_sparse(&graph, &common);
  if (!symbolic) throw std::runtime_error("sparse Cholesky: ordering failed");
  const auto* permutation = static_cast<int*>(symbolic->Perm);
  std::vector<int> order(n);
  for (int p = 0; p < n; ++p) order[p] = free[permutation[p]];
  cholmod_free_factor(&symbolic, &common);
  return order;
}

}  // namespace

void BlockCholesky::analyse(std::shared_ptr<const BlockPattern> pattern, const std::vector<char>& fixed) {
  if (pattern == pattern_ && fixed == fixed_) return;
  pattern_ = std::move(pattern);
  fixed_ = fixed;
  c_->clear();
  has_factor_ = false;
  ++analyses_;
  const BlockPattern& P = *pattern_;

  std::vector<int> free, place(P.rows(), -1);
  for (int v = 0; v < P.rows(); ++v)
    if (!fixed_[v]) place[v] = static_cast<int>(free.size()), free.push_back(v);
  order_.clear();
  off_diagonal_.clear();
  diagonal_.clear();
  if (free.empty()) return;
  order_ = nested_dissection(P, place, free, c_->common);
  const int n = static_cast<int>(order_.size());
  for (int p = 0; p < n; ++p) place[order_[p]] = p;

  // Block columns of the lower triangle in elimination order: which rows, from which block.
  struct Entry {
    int row, block;
    bool transpose;
  };
  std::vector<std::vector<Entry>> columns(n);
  for (int i = 0; i < P.rows(); ++i)
    for (int k = P.row_start[i]; k < P.row_start[i + 1]; ++k) {
      const int p = place[i], q = place[P.columns[k]];
      if (p < 0 || q < 0) continue;
      // Block (i, j) has rows of i. Below the diagonal at (q, p) it is needed transposed.
      if (p == q) continue;
      if (p < q)
        columns[p].push_back({q, k, true});
      else
        columns[q].push_back({p, k, false});
    }

  std::size_t entries = 0;
  for (const auto& column : columns) entries += 6 + 9 * column.size();
  if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::runtime_error("sparse Cholesky: the matrix has more than 2^31 entries; use a coarser mesh");
  auto& common = c_->common;
  c_->matrix = cholmod_allocate_sparse(3 * n, 3 * n, entries, 1, 1, -1, CHOLMOD_REAL, &common);
  c_->require(c_->matrix, "allocating the matrix");
  auto* start = static_cast<int*>(c_->matrix->p);
  auto* rows = static_cast<int*>(c_->matrix->i);
  int at = 0;
  for (int p = 0; p < n; ++p) {
    auto& column = columns[p];
    std::sort(column.begin(), column.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    const int stride = 3 + 3 * static_cast<int>(column.size());
    diagonal_.push_back({P.row_start[order_[p]], false, static_cast<std::size_t>(at), stride});
    for (std::size_t k = 0; k < column.size(); ++k)
      off_diagonal_.push_back(
          {column[k].block, column[k].transpose, static_cast<std::size_t>(at) + 3 + 3 * k, stride});
    for (int c = 0; c < 3; ++c) {
      start[3 * p + c] = at;
      for (int r = c; r < 3; ++r) rows[at++] = 3 * p + r;
      for (const Entry& e : column)
        for (int r = 0; r < 3; ++r) rows[at++] = 3 * e.row + r;
    }
  }
  start[3 * n] = at;

  common.method[0].ordering = CHOLMOD_NATURAL;
  common.postorder = 0;  // the order of the vertices is a postorder already
  c_->factor = cholmod_analyze(c_->matrix, &common);
  c_->require(c_->factor, "symbolic analysis");
  c_->rhs = cholmod_allocate_dense(3 * n, 1, 3 * n, CHOLMOD_REAL, &common);
  c_->require(c_->rhs, "allocating the right-hand side");
}

bool BlockCholesky::factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
  has_factor_ = false;
  if (order_.empty()) return has_factor_ = true;
  auto* v = static_cast<double*>(c_->matrix->x);
  parallel_for(static_cast<int>(off_diagonal_.size()), 8192, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      const Target& to = off_diagonal_[t];
      const double* b = matrix.block(to.block);
      double* column = v + to.offset;
      // Columns shrink by one towards the right: the diagonal block keeps its lower triangle only.
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) column[r] = to.transpose ? b[3 * c + r] : b[3 * r + c];
        column += to.stride - 1 - c;
      }
    }
  });
  for (std::size_t p = 0; p < diagonal_.size(); ++p) {
    const Target& to = diagonal_[p];
    const double* b = matrix.block(to.block);
    const double s = shift[order_[p]];
    double* column = v + to.offset;
    column[0] = b[0] + s, column[1] = b[3], column[2] = b[6];
    column += to.stride;
    column[0] = b[4] + s, column[1] = b[7];
    column += to.stride - 1;
    column[0] = b[8] + s;
  }
  c_->common.quick_return_if_not_posdef = 1;
  if (!cholmod_factorize(c_->matrix, c_->factor, &c_->common))
    throw std::runtime_error("sparse Cholesky: factorisation failed (CHOLMOD status " +
                             std::to_string(c_->common.status) + "; -2 means out of memory)");
  has_factor_ = c_->common.status != CHOLMOD_NOT_POSDEF;
  return has_factor_;
}

void BlockCholesky::solve(const Positions& right_hand_side, Positions& solution) {
  solution.setZero(right_hand_side.rows(), 3);
  if (order_.empty()) return;
  if (!has_factor_) throw std::logic_error("sparse Cholesky: solve before a successful factorise");
  auto* b = static_cast<double*>(c_->rhs->x);
  for (std::size_t p = 0; p < order_.size(); ++p)
    for (int c = 0; c < 3; ++c) b[3 * p + c] = right_hand_side(order_[p], c);
  if (!cholmod_solve2(CHOLMOD_A, c_->factor, c_->rhs, nullptr, &c_->solution, nullptr, &c_->work_y,
                      &c_->work_e, &c_->common))
    throw std::runtime_error("sparse Cholesky: triangular solve failed");
  const auto* x = static_cast<const double*>(c_->solution->x);
  for (std::size_t p = 0; p < order_.size(); ++p)
    for (int c = 0; c < 3; ++c) solution(order_[p], c) = x[3 * p + c];
}

}  // namespace drape
