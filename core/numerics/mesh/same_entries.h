#pragma once

#include <Eigen/Core>

namespace drape {

/// Whether two matrices, as of triangles or stencils, have the same size and the same entries in the same
/// order. Eigen's == requires equal sizes.
template <class A, class B>
bool same_entries(const Eigen::DenseBase<A>& a, const Eigen::DenseBase<B>& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a.derived() == b.derived();
}

}  // namespace drape
