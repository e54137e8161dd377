#include "core/app/python/prototype_energy.h"

#include <pybind11/stl.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "core/app/python/arrays.h"
#include "core/app/python/level_handle.h"
#include "core/kernel/threads/parallel.h"

namespace drape::python {

namespace {

using Shape = std::vector<py::ssize_t>;

EnergyRole role_of(const std::string& word) {
  if (word == "membrane") return EnergyRole::membrane;
  if (word == "bending") return EnergyRole::bending;
  if (word == "external") return EnergyRole::external;
  if (word == "position") return EnergyRole::position;
  throw py::value_error("role must be membrane, bending, external or position, not \"" + word + "\"");
}

/// m×k vertices, all of the level.
Stencils stencils_of(const py::object& elements, int vertex_count) {
  const auto array = integer_array(elements, "elements");
  if (array.ndim() != 2 || array.shape(0) == 0 || array.shape(1) == 0)
    throw py::value_error("elements must have the shape (m, k), m and k at least 1, not " +
                          shape_text(array));
  Stencils stencils = Eigen::Map<const Stencils>(array.data(), array.shape(0), array.shape(1));
  if (stencils.minCoeff() < 0 || stencils.maxCoeff() >= vertex_count)
    throw py::value_error("elements must be vertices of the level, 0 … " + std::to_string(vertex_count - 1));
  return stencils;
}

class BoundPythonEnergy final : public BoundEnergy {
 public:
  BoundPythonEnergy(SharedObject prototype, SharedObject rest, Stencils stencils)
      : prototype_(std::move(prototype)), rest_(std::move(rest)), stencils_(std::move(stencils)) {}

  double value(const Positions& x) const override {
    return with_python([&] { return value_at(corners_of(x)); });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    return with_python([&] {
      const py::object corners = corners_of(x);
      const py::array_t<double> gradients = evaluate("gradient", corners, {m(), k(), 3});
      const auto gradient = gradients.unchecked<3>();
      for (py::ssize_t a = 0; a < k(); ++a)
        for (py::ssize_t e = 0; e < m(); ++e)
          for (int c = 0; c < 3; ++c) g(stencils_(e, a), c) += gradient(e, a, c);
      return value_at(corners);
    });
  }

  Stencils stencils() const override { return stencils_; }

  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    const auto size = static_cast<int>(3 * k());
    std::vector<double> hessians(static_cast<std::size_t>(m()) * size * size);
    with_python([&] {
      const py::array_t<double> returned = evaluate("hessian", corners_of(x), {m(), size, size});
      const auto hessian = returned.unchecked<3>();
      parallel_for(static_cast<int>(m()), 64, [&](int begin, int end) {
        for (int i = 0; i < size; ++i)
          for (int j = 0; j < size; ++j)
            for (int e = begin; e < end; ++e)
              hessians[(static_cast<std::ptrdiff_t>(e) * size + i) * size + j] = hessian(e, i, j);
      });
    });
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto matrix = [&](int e) {
      return Eigen::Map<Matrix>(hessians.data() + static_cast<std::ptrdiff_t>(e) * size * size, size, size);
    };
    if (!projection.is_exact())
      parallel_for(static_cast<int>(m()), 64, [&](int begin, int end) {
        for (int e = begin; e < end; ++e) {
          const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen{Eigen::MatrixXd(matrix(e))};
          const Eigen::VectorXd mapped =
              eigen.eigenvalues().unaryExpr([&](double value) { return projection.map(value); });
          matrix(e) = eigen.eigenvectors() * mapped.asDiagonal() * eigen.eigenvectors().transpose();
        }
      });
    for (int e = 0; e < m(); ++e)
      for (int b = 0; b < k(); ++b)
        for (int a = 0; a <= b; ++a) {
          const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = matrix(e).block<3, 3>(3 * a, 3 * b);
          sink.add(e, a, b, block.data());
        }
  }

 private:
  py::ssize_t m() const { return stencils_.rows(); }
  py::ssize_t k() const { return stencils_.cols(); }

  /// The elements' positions, m×k×3 and read-only. The axis of the elements is the innermost in memory: numpy
  /// keeps this order in what it computes from them, and its loops are fastest along a long axis.
  py::object corners_of(const Positions& x) const {
    py::array_t<double> corners(Shape{k(), 3, m()});
    double* const values = corners.mutable_data();
    parallel_for(static_cast<int>(m()), 2048, [&](int begin, int end) {
      for (py::ssize_t a = 0; a < k(); ++a)
        for (int e = begin; e < end; ++e)
          for (int c = 0; c < 3; ++c) values[(3 * a + c) * m() + e] = x(stencils_(e, a), c);
    });
    corners.attr("setflags")(py::arg("write") = false);
    return corners.attr("transpose")(2, 0, 1);
  }

  /// What the prototype's function returns for the elements' positions; it must have this shape.
  py::array_t<double> evaluate(const char* function, const py::object& corners, const Shape& shape) const {
    py::array_t<double> values = real_array(prototype_->attr(function)(corners, *rest_), function);
    if (!std::equal(shape.begin(), shape.end(), values.shape(), values.shape() + values.ndim())) {
      std::string wanted;
      for (const py::ssize_t n : shape) wanted += (wanted.empty() ? "" : ", ") + std::to_string(n);
      throw py::value_error(std::string(py::str(py::type::of(*prototype_))) + "." + function +
                            " must return the shape (" + wanted + "), not " + shape_text(values));
    }
    return values;
  }

  double value_at(const py::object& corners) const {
    const py::array_t<double> energies = evaluate("value", corners, {m()});
    const auto energy = energies.unchecked<1>();
    double sum = 0;
    for (py::ssize_t e = 0; e < m(); ++e)
      sum += std::isnan(energy(e)) ? std::numeric_limits<double>::infinity() : energy(e);
    return sum;
  }

  SharedObject prototype_, rest_;
  Stencils stencils_;
};

}  // namespace

PythonEnergy::PythonEnergy(py::object prototype)
    : role_(role_of(prototype.attr("role").cast<std::string>())),
      midpoint_factor_(prototype.attr("midpoint_factor").cast<std::optional<double>>()) {
  prototype_ = share(std::move(prototype));
}

std::unique_ptr<BoundEnergy> PythonEnergy::bind(const Level& level, const Material& material) const {
  return with_python([&]() -> std::unique_ptr<BoundEnergy> {
    const LevelHandle kept = LevelHandle::copy_of(level);  // Python may store it
    Stencils stencils = stencils_of(prototype_->attr("elements")(kept), level.vertex_count());
    SharedObject rest = share(prototype_->attr("rest")(kept, material));
    return std::make_unique<BoundPythonEnergy>(prototype_, std::move(rest), std::move(stencils));
  });
}

}  // namespace drape::python
