#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/numerics/block_matrix.h"
#include "core/numerics/supernodal_factor.h"

namespace drape {

/// Sparse Cholesky factorisation of a symmetric block matrix plus a diagonal, without the rows and columns of
/// fixed vertices. Vertices are ordered by nested dissection (METIS) and gathered into supernodes by CHOLMOD
/// (Chen, Davis, Hager and Rajamanickam 2008); SupernodalFactor does the numbers. Supernodes are kept
/// until the pattern changes, the order until it has become a bad one for it or the fixed vertices change.
class BlockCholesky {
 public:
  /// What an analysis was made from, the same pattern with which gives the same layout, and came to.
  struct Analysis {
    std::vector<char> fixed;
    std::vector<int> given;    ///< order of the free vertices that was kept; empty where one was found
    std::vector<int> order;    ///< that came of it
    double ordered_flops = 0;  ///< what it cost where it was found
    int count = 0;             ///< of analyses so far, this one with them; 0 where none was made
  };

  /// Orders and analyses; does nothing when called again with the same pattern and flags.
  /// `fixed` has one flag a vertex. Throws std::runtime_error when memory runs out.
  void analyse(std::shared_ptr<const BlockPattern> pattern, const std::vector<char>& fixed);

  /// Factorises A + diag(shift_i I₃); shift has one entry a vertex [N/m]. False when the sum is not
  /// positive definite: there is no factor then.
  bool factorise(const BlockMatrix& matrix, const Eigen::VectorXd& shift);

  /// Solves with the last factor; n×3 right-hand side and solution, whose fixed rows are zero.
  void solve(const Positions& right_hand_side, Positions& solution);

  Analysis analysis() const { return {fixed_, given_, order_, ordered_flops_, analyses_}; }
  /// Is laid out as after that analysis of the pattern, without a factor. Where the pattern is null, being
  /// used no more, there is only the order to begin the next analysis from.
  void restore(std::shared_ptr<const BlockPattern> pattern, Analysis analysis);

  bool has_factor() const { return has_factor_; }
  int unknowns() const { return 3 * static_cast<int>(order_.size()); }
  /// Floating-point operations of one numeric factorisation, and entries of the factor, without the zeros
  /// that supernodes bring.
  double flops() const { return flops_; }
  double factor_entries() const { return entries_; }
  /// How many times an analysis was made.
  int analyses() const { return analyses_; }

 private:
  /// In `order`, as long as that costs no more; else in one that is found.
  void lay_out(std::vector<int> order, double most_flops);

  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<char> fixed_;
  std::vector<int> order_;  // order_[p] is the vertex at place p
  std::vector<int> given_;  // what order_ was made from; empty where it was found
  SupernodalFactor factor_;
  Eigen::VectorXd x_;
  double flops_ = 0, entries_ = 0;
  double ordered_flops_ = 0;  // of CHOLMOD's count, when order_ was found
  bool has_factor_ = false;
  int analyses_ = 0;
};

}  // namespace drape
