#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape::python {

namespace py = pybind11;

/// A numpy array over numbers that `owner` keeps alive, without a copy.
template <class Number>
py::array array_over(const Number* data, std::vector<py::ssize_t> shape, std::shared_ptr<const void> owner) {
  const py::capsule base(new std::shared_ptr<const void>(std::move(owner)),
                         [](void* held) { delete static_cast<std::shared_ptr<const void>*>(held); });
  return py::array_t<Number>(std::move(shape), data, base);
}

/// The same of a dense row-major matrix, or of a vector as an array of one dimension.
template <class Matrix>
py::array array_over(const Matrix& matrix, std::shared_ptr<const void> owner) {
  static_assert(Matrix::IsRowMajor || Matrix::ColsAtCompileTime == 1);
  std::vector<py::ssize_t> shape = {matrix.rows()};
  if (Matrix::ColsAtCompileTime != 1) shape.push_back(matrix.cols());
  return array_over(matrix.data(), std::move(shape), std::move(owner));
}

/// A read-only view of what `owner` shares with others.
template <class Matrix>
py::array view(const Matrix& matrix, std::shared_ptr<const void> owner) {
  py::array array = array_over(matrix, std::move(owner));
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A writeable array of its own with these rows.
template <class Matrix>
py::array array_of(Matrix matrix) {
  const auto owner = std::make_shared<const Matrix>(std::move(matrix));
  return array_over(*owner, owner);
}

/// "(441, 3)"
std::string shape_text(const py::array& array);

/// An array of doubles, in any order in memory. Throws TypeError for what is not made of real numbers.
py::array_t<double> real_array(const py::handle& values, const std::string& name);
/// A C-contiguous array of integers, all within int.
py::array_t<int, py::array::c_style> integer_array(const py::handle& values, const std::string& name);

/// n×3 positions. Throws ValueError naming `name` and both shapes unless there are `rows` rows; -1 allows
/// any number.
Positions positions_of(const py::handle& values, Eigen::Index rows, const std::string& name);

/// A symmetric matrix of 3×3 blocks as a scipy.sparse.bsr_matrix with both triangles.
py::object bsr_matrix(const BlockMatrix& matrix);

}  // namespace drape::python
