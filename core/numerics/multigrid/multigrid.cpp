#include "core/numerics/multigrid/multigrid.h"

#include <algorithm>
#include <cmath>

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {

/// Relative residual of a direction, and the one with which it is taken when cycles run out: contacts leave
/// soft modes that take many, and Newton makes up for them.
constexpr double tolerance = 0.1, sufficient = 0.4;

/// Cycles that take about half the time of a factorisation, which grows with n^1.5: 31 for 98K vertices, as
/// measured.
int most_cycles(double vertices) { return std::max(10, static_cast<int>(0.1 * std::sqrt(vertices))); }

}  // namespace

Multigrid::Multigrid(std::span<const ProlongationMatrix> prolongations) {
  std::size_t first = prolongations.size() - 1;
  while (first > 0 && prolongations[first].cols() > small_mesh) --first;
  meshes_.emplace_front(static_cast<int>(prolongations[first].cols()));
  for (std::size_t l = first; l < prolongations.size(); ++l)
    meshes_.emplace_front(prolongations[l], meshes_.front());
}

bool Multigrid::set(const BlockMatrix& matrix, const Eigen::VectorXd& shift, const std::vector<char>& fixed) {
  matrix_ = &matrix, shift_ = shift, fixed_ = fixed;
  meshes_.front().fill(matrix, shift, fixed);
  for (std::size_t k = 0; k + 1 < meshes_.size(); ++k) {
    if (!meshes_[k].matrix.finish()) return false;
    flops_ += 18 * meshes_[k].make_product(meshes_[k + 1]);
  }
  MultigridMesh& coarsest = meshes_.back();
  // An ordering from former contacts would change last bits, and a resumed run has none.
  if (coarsest.copy_to(coarsest_matrix_)) coarsest_.forget();
  coarsest_.analyse(coarsest_matrix_.pattern, std::vector<char>(coarsest.order.size(), 0));
  flops_ += coarsest_.flops();
  return coarsest_.factorise(coarsest_matrix_, Eigen::VectorXd::Zero(coarsest.size()));
}

void Multigrid::cycle(std::size_t mesh) {
  MultigridMesh& f = meshes_[mesh];
  if (mesh + 1 == meshes_.size()) {
    right_.resize(f.size(), 3);
    for (int i = 0; i < f.size(); ++i)
      for (int c = 0; c < 3; ++c) right_(i, c) = f.b[i][c];
    coarsest_.solve(right_, solution_);
    for (int i = 0; i < f.size(); ++i)
      for (int c = 0; c < 3; ++c) f.x[i][c] = static_cast<float>(solution_(i, c));
    return;
  }
  MultigridMesh& c = meshes_[mesh + 1];
  f.matrix.presmooth(f.b, f.x, f.r);
  parallel_for(c.size(), SmoothedMatrix::piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) c.b[i] = weighted_sum(f.children, i, f.r);
  });
  cycle(mesh + 1);
  parallel_for(f.size(), SmoothedMatrix::piece, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) f.x[i] += weighted_sum(f.parents, i, c.x);
  });
  f.matrix.postsmooth(f.b, f.x, f.old);
  flops_ += 2 * f.matrix.flops_of_product();
}

void Multigrid::precondition(const Positions& r, Positions& z) {
  MultigridMesh& f = meshes_.front();
  // To numbers of the order of 1, so that none is lost in single precision.
  const double scale = r.cwiseAbs().maxCoeff();
  for (int i = 0; i < f.size(); ++i)
    for (int c = 0; c < 3; ++c) f.b[i][c] = static_cast<float>(r(f.order[i], c) / scale);
  cycle(0);
  z.resize(r.rows(), 3);
  for (int i = 0; i < f.size(); ++i)
    for (int c = 0; c < 3; ++c) z(f.order[i], c) = scale * f.x[i][c];
  flops_ += f.matrix.flops_of_product();  // of the product that follows
}

ConjugateGradients::End Multigrid::solve(const Positions& right_hand_side, Positions& solution) {
  return gradients_.solve(
      *matrix_, shift_, fixed_, right_hand_side,
      [this](const Positions& r, Positions& z) { precondition(r, z); },
      {tolerance, most_cycles(meshes_.front().size()), sufficient}, solution);
}

}  // namespace drape
