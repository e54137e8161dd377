#include "core/app/python/arrays.h"

#include <limits>

namespace drape::python {

namespace {

/// An array of anything that numpy takes. Throws TypeError unless its kind is among `kinds` (numpy's
/// letters).
py::array array_of_kind(const py::handle& values, const std::string& kinds, const std::string& name,
                        const std::string& wanted) {
  const py::array array = py::array::ensure(values);
  if (!array) PyErr_Clear();
  if (!array || kinds.find(array.dtype().kind()) == kinds.npos)
    throw py::type_error(
        name + " must be an array of " + wanted + ", not " +
        (array ? "of " + std::string(py::str(array.dtype())) : std::string(py::str(py::type::of(values)))));
  return array;
}

}  // namespace

std::string shape_text(const py::array& array) { return std::string(py::str(array.attr("shape"))); }

py::array_t<double> real_array(const py::handle& values, const std::string& name) {
  return py::array_t<double>::ensure(array_of_kind(values, "fiu", name, "real numbers"));
}

py::array_t<int, py::array::c_style> integer_array(const py::handle& values, const std::string& name) {
  const py::array array = array_of_kind(values, "iu", name, "integers");
  const auto wide = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
  for (py::ssize_t i = 0; i < wide.size(); ++i)
    if (wide.data()[i] > std::numeric_limits<int>::max() || wide.data()[i] < std::numeric_limits<int>::min())
      throw py::value_error(name + " has an integer that does not fit 32 bits");
  return py::array_t<int, py::array::c_style | py::array::forcecast>::ensure(wide);
}

Positions positions_of(const py::handle& values, Eigen::Index rows, const std::string& name) {
  const auto array = real_array(values, name);
  if (array.ndim() != 2 || array.shape(1) != 3 || (rows >= 0 && array.shape(0) != rows))
    throw py::value_error(name + " must have the shape (" + (rows >= 0 ? std::to_string(rows) : "n") +
                          ", 3), one row a vertex, not " + shape_text(array));
  Positions positions(array.shape(0), 3);
  const auto coordinate = array.unchecked<2>();
  for (Eigen::Index i = 0; i < positions.rows(); ++i)
    for (int c = 0; c < 3; ++c) positions(i, c) = coordinate(i, c);
  return positions;
}

py::object bsr_matrix(const BlockMatrix& matrix) {
  const BlockPattern& pattern = *matrix.pattern;
  const int n = pattern.rows();
  py::array_t<int> starts(n + 1);
  int* const start = starts.mutable_data();
  std::fill(start, start + n + 1, 0);
  const auto for_each_block = [&](const auto& body) {
    for (int i = 0; i < n; ++i)
      for (int b = pattern.row_start[i]; b < pattern.row_start[i + 1]; ++b) body(i, pattern.columns[b], b);
  };
  for_each_block([&](int i, int j, int) {
    ++start[i + 1];
    if (j > i) ++start[j + 1];
  });
  for (int i = 0; i < n; ++i) start[i + 1] += start[i];
  py::array_t<int> columns(start[n]);
  py::array_t<double> blocks({static_cast<py::ssize_t>(start[n]), py::ssize_t{3}, py::ssize_t{3}});
  std::vector<int> next(start, start + n);
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const auto put = [&](int row, int column, const Block& values) {
    const int at = next[row]++;
    columns.mutable_data()[at] = column;
    Eigen::Map<Block>(blocks.mutable_data() + 9 * static_cast<std::ptrdiff_t>(at)) = values;
  };
  // Columns ascend: all those left of the diagonal first.
  for_each_block([&](int i, int j, int b) {
    if (j > i) put(j, i, Eigen::Map<const Block>(matrix.block(b)).transpose());
  });
  for_each_block([&](int i, int j, int b) { put(i, j, Eigen::Map<const Block>(matrix.block(b))); });
  const py::object make = py::module_::import("scipy.sparse").attr("bsr_matrix");
  return make(py::make_tuple(blocks, columns, starts), py::arg("shape") = py::make_tuple(3 * n, 3 * n));
}

}  // namespace drape::python
