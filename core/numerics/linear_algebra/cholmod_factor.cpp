#include <algorithm>

#include "core/kernel/interfaces/topology.h"
#include "core/kernel/threads/held_signals.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/linear_algebra/cholmod_context.h"

namespace drape {
namespace {

class CholmodFactor : public NumericFactor {
 public:
  CholmodFactor() {
    // The matrix comes in the order of elimination, so that CHOLMOD makes no permuted copies of it.
    context_.common.method[0].ordering = CHOLMOD_NATURAL;
    context_.common.postorder = 0;
    context_.common.quick_return_if_not_posdef = 1;
  }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;
  ~CholmodFactor() override {
    for (cholmod_dense** workspace : {&solution_, &y_, &e_}) cholmod_free_dense(workspace, &context_.common);
    free_structure();
  }

  void set_structure(const BlockPattern& pattern, const std::vector<int>& ordering, Supernodes) override {
    ordering_ = ordering;
    find_entries(pattern);
    free_structure();
    allocate_matrix();
    factor_ = cholmod_analyze(matrix_, &context_.common);
    context_.require(factor_, "symbolic analysis");
  }

  bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) override {
    const HeldSignals held;  // also from threads of OpenMP, which METIS's handler must not run in
    set_values(matrix, shift);
    context_.require(cholmod_factorize(matrix_, factor_, &context_.common), "numeric factorisation");
    return context_.common.status == CHOLMOD_OK && has_positive_diagonal();
  }

  void solve(Eigen::VectorXd& x) override {
    const HeldSignals held;
    cholmod_dense right = {};  // refers to x
    right.nrow = right.nzmax = right.d = static_cast<std::size_t>(x.size());
    right.ncol = 1;
    right.x = x.data();
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    context_.require(
        cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &y_, &e_, &context_.common),
        "solve");
    std::copy_n(static_cast<const double*>(solution_->x), x.size(), x.data());
  }

 private:
  /// A block of the matrix in its column.
  struct Entry {
    int row, block;
    bool transposed;
  };

  void find_entries(const BlockPattern& pattern) {
    const std::vector<int> position = positions_in(ordering_, pattern.rows());
    const int columns = static_cast<int>(ordering_.size());
    entries_ = Grouped<Entry>::of(columns, [&](const auto& add) {
      for_each_lower_block(pattern, position, [&](int column, int row, int block, bool transposed) {
        add(column, {row, block, transposed});
      });
    });
    for (int p = 0; p < columns; ++p) std::ranges::sort(entries_.row(p), {}, &Entry::row);
  }

  void allocate_matrix() {
    const std::size_t size = 3 * ordering_.size(), nonzeros = 9 * entries_.items.size() - size;
    matrix_ = cholmod_allocate_sparse(size, size, nonzeros, 1, 1, -1, CHOLMOD_REAL, &context_.common);
    context_.require(matrix_, "allocating the matrix");
    auto* start = static_cast<int*>(matrix_->p);
    auto* rows = static_cast<int*>(matrix_->i);
    int at = 0;
    for (int p = 0; p < static_cast<int>(ordering_.size()); ++p)
      for (int c = 0; c < 3; ++c) {
        start[3 * p + c] = at;
        for (const Entry& e : entries_.row(p))
          for (int r = e.row == p ? c : 0; r < 3; ++r) rows[at++] = 3 * e.row + r;
      }
    start[size] = at;
  }

  void set_values(const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
    const auto* start = static_cast<const int*>(matrix_->p);
    auto* values = static_cast<double*>(matrix_->x);
    parallel_for(static_cast<int>(ordering_.size()), 1024, [&](int begin, int end) {
      for (int p = begin; p < end; ++p)
        for (int c = 0; c < 3; ++c) {
          double* to = values + start[3 * p + c];
          double& diagonal = *to;
          for (const Entry& e : entries_.row(p)) {
            const double* b = matrix.block(e.block);
            const int down = e.transposed ? 1 : 3, right = e.transposed ? 3 : 1;
            for (int r = e.row == p ? c : 0; r < 3; ++r) *to++ = b[r * down + c * right];
          }
          diagonal += shift[ordering_[p]];
        }
    });
  }

  /// Not every LAPACK reports NaN. A NaN anywhere in the factor reaches the diagonal of its row.
  bool has_positive_diagonal() const {
    const auto* first = static_cast<const int*>(factor_->super);
    const auto* rows = static_cast<const int*>(factor_->pi);
    const auto* panel = static_cast<const int*>(factor_->px);
    const auto* values = static_cast<const double*>(factor_->x);
    for (std::size_t s = 0; s < factor_->nsuper; ++s) {
      const std::size_t height = rows[s + 1] - rows[s];
      for (int k = 0; k < first[s + 1] - first[s]; ++k)
        if (!(values[panel[s] + k * (height + 1)] > 0)) return false;
    }
    return true;
  }

  void free_structure() {
    cholmod_free_factor(&factor_, &context_.common);
    cholmod_free_sparse(&matrix_, &context_.common);
  }

  CholmodContext context_;
  cholmod_sparse* matrix_ = nullptr;  // lower triangle of the scalars
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *solution_ = nullptr, *y_ = nullptr, *e_ = nullptr;  // CHOLMOD keeps them between solves
  std::vector<int> ordering_;
  Grouped<Entry> entries_;  // of each position's block column, rows ascending, so the diagonal comes first
};

}  // namespace

std::unique_ptr<NumericFactor> make_cholmod_factor() { return std::make_unique<CholmodFactor>(); }

}  // namespace drape
