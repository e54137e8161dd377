#include "core/numerics/linear_algebra/block_cholesky.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <new>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/held_signals.h"
#include "core/numerics/linear_algebra/cholmod_context.h"
#include "core/numerics/linear_algebra/supernodal_factor.h"

namespace drape {
namespace {

/// One symbolic analysis by CHOLMOD.
struct SymbolicAnalysis : CholmodContext {
  cholmod_sparse* graph = nullptr;  // lower triangle
  cholmod_factor* factor = nullptr;

  ~SymbolicAnalysis() {
    cholmod_free_sparse(&graph, &common);
    cholmod_free_factor(&factor, &common);
  }
  /// With this ordering, or with METIS's if it is empty.
  void analyse(std::vector<int> ordering) {
    cholmod_free_factor(&factor, &common);
    if (ordering.empty()) {
      // METIS draws from std::rand, which all threads share: solves side by side would change each other's
      // ordering, and with it their last bits.
      static std::mutex one_at_a_time;
      const std::lock_guard lock(one_at_a_time);
      // A SIGTERM would end it in the middle, and be lost; it gives back a handler that serves once.
      const HeldSignals held;
      struct sigaction before;
      sigaction(SIGTERM, nullptr, &before);
      common.method[0].ordering = CHOLMOD_METIS;
      factor = cholmod_analyze(graph, &common);
      sigaction(SIGTERM, &before, nullptr);
    } else {
      common.method[0].ordering = CHOLMOD_GIVEN;
      factor = cholmod_analyze_p(graph, ordering.data(), nullptr, 0, &common);
    }
    require(factor, "symbolic analysis");
  }
};

/// An ordering from another pattern is reused while the factorisation costs at most this many times as much
/// as it did there: computing a new one takes longer than several factorisations.
constexpr double max_flops_growth = 1.5;

/// Conjugate gradients with a factor in single precision: relative residual at which they end, commonly after
/// two iterations, and iterations after which the factor counts as useless. A residual of 1e-3 takes one
/// iteration and Newton no more of its own, but keeps less of a distance to soft modes, of which the residual
/// shows little.
constexpr double mixed_tolerance = 1e-5;
constexpr int mixed_iterations = 12;

/// The ordering of vertices as indices into `free`.
std::vector<int> indices_in(const std::vector<int>& free, const std::vector<int>& ordering, int vertices) {
  const std::vector<int> index = positions_in(free, vertices);
  std::vector<int> indices;
  for (int v : ordering) indices.push_back(index[v]);
  return indices;
}

/// The graph of the free vertices, by their index in `free`.
void make_graph(const BlockPattern& pattern, const std::vector<int>& free, SymbolicAnalysis& c) {
  const int n = static_cast<int>(free.size());
  const std::vector<int> index = positions_in(free, pattern.rows());
  const AdjacencyList rows = AdjacencyList::of(n, [&](const auto& add) {
    for (int i = 0; i < n; ++i)  // row i of the upper triangle is column i of the lower
      for (const int j : pattern.row(free[i]))
        if (index[j] >= 0) add(i, index[j]);
  });
  c.graph = cholmod_allocate_sparse(n, n, rows.items.size(), 1, 1, -1, CHOLMOD_PATTERN, &c.common);
  c.require(c.graph, "allocating the graph");
  std::ranges::copy(rows.start, static_cast<int*>(c.graph->p));
  std::ranges::copy(rows.items, static_cast<int*>(c.graph->i));
}

Supernodes supernodes_of(const cholmod_factor& factor) {
  const auto* super = static_cast<const int*>(factor.super);
  const auto* start = static_cast<const int*>(factor.pi);
  const auto* rows = static_cast<const int*>(factor.s);
  const int count = static_cast<int>(factor.nsuper);
  AdjacencyList below;
  below.start.push_back(0);
  for (int s = 0; s < count; ++s) {  // a supernode's rows begin with its own
    below.items.insert(below.items.end(), rows + start[s] + (super[s + 1] - super[s]), rows + start[s + 1]);
    below.start.push_back(static_cast<int>(below.items.size()));
  }
  return {std::vector<int>(super, super + count + 1), std::move(below)};
}

std::unique_ptr<NumericFactor> make_factor(LinearSolver solver) {
  if (solver == LinearSolver::cholmod) return make_cholmod_factor();
  if (solver == LinearSolver::mixed) return std::make_unique<SupernodalFactor<float>>();
  return std::make_unique<SupernodalFactor<double>>();
}

}  // namespace

BlockCholesky::BlockCholesky(LinearSolver solver) : solver_(solver), factor_(make_factor(solver)) {}

void BlockCholesky::use(LinearSolver solver) {
  if (solver == solver_) return;
  factor_.reset();  // first, so that two factors never take up memory together
  factor_ = make_factor(solver);
  solver_ = solver;
  has_factor_ = false;
  if (pattern_ && !analysis_.ordering.empty()) set_structure();
}

void BlockCholesky::analyse(std::shared_ptr<const BlockPattern> pattern, const std::vector<char>& fixed) {
  if (pattern == pattern_ && fixed == analysis_.fixed) return;
  std::vector<int> ordering;
  if (fixed == analysis_.fixed) ordering.swap(analysis_.ordering);
  pattern_ = std::move(pattern);
  analysis_.fixed = fixed;
  ++analysis_.count;
  order_and_analyse(std::move(ordering), max_flops_growth * analysis_.ordering_flops);
}

void BlockCholesky::restore(std::shared_ptr<const BlockPattern> pattern, Analysis analysis) {
  analysis_ = std::move(analysis);
  pattern_ = analysis_.fixed.empty() ? nullptr : std::move(pattern);
  has_factor_ = false;
  if (!pattern_) return;
  const double ordering_flops = analysis_.ordering_flops;
  order_and_analyse(std::move(analysis_.reused_ordering), std::numeric_limits<double>::infinity());
  analysis_.ordering_flops = ordering_flops;
}

void BlockCholesky::forget() {
  const int analyses = analysis_.count;
  *this = BlockCholesky(solver_);
  analysis_.count = analyses;
}

void BlockCholesky::order_and_analyse(std::vector<int> ordering, double max_flops) {
  has_factor_ = false;
  std::vector<int> free;
  for (int v = 0; v < pattern_->rows(); ++v)
    if (!analysis_.fixed[v]) free.push_back(v);
  flops_ = entries_ = 0;
  if (free.empty()) {
    analysis_.ordering.clear();
    analysis_.reused_ordering.clear();
    return;
  }

  SymbolicAnalysis c;
  make_graph(*pattern_, free, c);
  analysis_.reused_ordering = std::move(ordering);
  if (!analysis_.reused_ordering.empty())
    c.analyse(indices_in(free, analysis_.reused_ordering, pattern_->rows()));
  if (analysis_.reused_ordering.empty() || c.common.fl > max_flops) {
    analysis_.reused_ordering.clear();
    c.analyse({});
    analysis_.ordering_flops = c.common.fl;
  }
  const auto* permutation = static_cast<const int*>(c.factor->Perm);
  analysis_.ordering.clear();
  for (std::size_t p = 0; p < free.size(); ++p) analysis_.ordering.push_back(free[permutation[p]]);
  for (std::size_t p = 0; p < free.size(); ++p)
    for (int k = 0; k < 3; ++k) {
      const double column = 3.0 * static_cast<const int*>(c.factor->ColCount)[p] - k;
      entries_ += column;
      flops_ += column * column;
    }
  supernodes_ = supernodes_of(*c.factor);
  set_structure();
}

void BlockCholesky::set_structure() {
  try {
    factor_->set_structure(*pattern_, analysis_.ordering, supernodes_);
  } catch (const std::bad_alloc&) {
    const double bytes = entries_ * (solver_ == LinearSolver::mixed ? 4 : 8);
    throw std::runtime_error("sparse Cholesky: no memory for a factor of " + three_digits(bytes * 1e-9) +
                             " GB; use a coarser mesh");
  }
}

bool BlockCholesky::factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
  if (solver_ == LinearSolver::mixed) matrix_ = &matrix, shift_ = shift;
  return has_factor_ = analysis_.ordering.empty() || factor_->factorise(matrix, shift);
}

bool BlockCholesky::solve(const Positions& right_hand_side, Positions& solution) {
  if (analysis_.ordering.empty()) {
    solution.setZero(right_hand_side.rows(), 3);
    return true;
  }
  if (!has_factor_) throw std::logic_error("sparse Cholesky: solve before a successful factorise");
  if (solver_ != LinearSolver::mixed) {
    apply_factor(right_hand_side, solution);
    return true;
  }
  const auto end = gradients_.solve(
      *matrix_, shift_, analysis_.fixed, right_hand_side,
      [&](const Positions& r, Positions& z) {
        // To numbers of the order of 1, so that none is lost in single precision.
        const double scale = r.cwiseAbs().maxCoeff();
        apply_factor(r / scale, z);
        z *= scale;
      },
      {mixed_tolerance, mixed_iterations, mixed_tolerance}, solution);
  return end == ConjugateGradients::End::converged;
}

void BlockCholesky::apply_factor(const Positions& right_hand_side, Positions& solution) {
  solution.setZero(right_hand_side.rows(), 3);
  x_.resize(unknowns());
  for (std::size_t p = 0; p < analysis_.ordering.size(); ++p)
    for (int c = 0; c < 3; ++c) x_[3 * p + c] = right_hand_side(analysis_.ordering[p], c);
  factor_->solve(x_);
  for (std::size_t p = 0; p < analysis_.ordering.size(); ++p)
    for (int c = 0; c < 3; ++c) solution(analysis_.ordering[p], c) = x_[3 * p + c];
}

}  // namespace drape
