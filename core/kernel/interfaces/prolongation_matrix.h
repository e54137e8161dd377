#pragma once

#include <Eigen/SparseCore>

namespace drape {

/// n_f × n_c prolongation weights, applied to each coordinate; rows sum to 1.
using ProlongationMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

}  // namespace drape
