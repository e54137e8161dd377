#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/model/derivative_check.h"
#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/model/required.h"
#include "core/numerics/model/smoothness_check.h"

namespace drape::python {

namespace {

using Shape = std::vector<py::ssize_t>;

EnergyRole role_of(const py::object& prototype) {
  const std::string what = class_of(prototype) + ".role", wanted = "membrane, bending, external or position";
  const auto word = cast_to<std::string>(prototype.attr("role"), what, wanted);
  if (word == "membrane") return EnergyRole::membrane;
  if (word == "bending") return EnergyRole::bending;
  if (word == "external") return EnergyRole::external;
  if (word == "position") return EnergyRole::position;
  throw py::value_error(what + " must be " + wanted + ", not \"" + word + "\"");
}

std::optional<double> midpoint_factor_of(const py::object& prototype) {
  const std::string what = class_of(prototype) + ".midpoint_factor",
                    wanted = "a finite number above 0, or None";
  const py::object given = prototype.attr("midpoint_factor");
  const auto factor = cast_to<std::optional<double>>(given, what, wanted);
  if (factor && !(std::isfinite(*factor) && *factor > 0))
    throw py::value_error(what + " must be " + wanted + ", not " + shown(given));
  return factor;
}

/// What a prototype's function returns, for messages.
std::string answer_of(const py::object& prototype, const char* function) {
  return "what " + class_of(prototype) + "." + function + " returns";
}

/// m×k vertices, all of the level. No rows: an array of any type, as of an empty list.
Stencils stencils_of(const py::object& prototype, const std::shared_ptr<Level>& level) {
  const std::string what = answer_of(prototype, "elements");
  const py::object elements = prototype.attr("elements")(level);
  if (const auto any = py::array::ensure(elements); any && any.ndim() > 0 && any.shape(0) == 0)
    return Stencils(0, 1);
  Stencils stencils = integer_rows(elements, -1, what);
  if (stencils.cols() == 0) throw py::value_error(what + " must have at least one column");
  if (stencils.minCoeff() < 0 || stencils.maxCoeff() >= level->vertex_count())
    throw py::value_error(what + " must be vertices of the level, 0 … " +
                          std::to_string(level->vertex_count() - 1));
  return stencils;
}

class BoundPythonEnergy final : public BoundEnergy {
 public:
  BoundPythonEnergy(SharedObject prototype, SharedObject rest, Stencils stencils)
      : prototype_(std::move(prototype)), rest_(std::move(rest)), stencils_(std::move(stencils)) {}

  double value(const Positions& x) const override {
    if (m() == 0) return 0;
    return with_python([&] { return value_at(corners_of(x)); });
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    if (m() == 0) return 0;
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
    if (m() == 0) return;
    const auto size = static_cast<int>(3 * k());
    std::vector<double> hessians(static_cast<std::size_t>(m()) * size * size);
    with_python([&] {
      const py::array_t<double> returned = evaluate("hessian", corners_of(x), {m(), size, size});
      const auto hessian = returned.unchecked<3>();
      parallel_for(static_cast<int>(m()), 64, [&](int begin, int end) {
        for (int i = 0; i < size; ++i)
          for (int j = 0; j < size; ++j)
            for (int e = begin; e < end; ++e)
              hessians[(static_cast<std::ptrdiff_t>(e) * size + i) * size + j] =
                  0.5 * (hessian(e, i, j) + hessian(e, j, i));  // of a triangle alone check_energy finds half
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
    py::array_t<double> values =
        real_array(prototype_->attr(function)(corners, *rest_), answer_of(*prototype_, function));
    if (!std::equal(shape.begin(), shape.end(), values.shape(), values.shape() + values.ndim())) {
      std::string wanted;
      for (const py::ssize_t n : shape) wanted += (wanted.empty() ? "" : ", ") + std::to_string(n);
      throw py::value_error(answer_of(*prototype_, function) + " must have the shape (" + wanted + "), not " +
                            shown(values.attr("shape")));
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

/// An energy whose elements a Python object evaluates, all at once: see drape.Energy. Summation, projection
/// and scatter are here, in the order of the elements.
class PythonEnergy final : public Energy {
 public:
  explicit PythonEnergy(const py::object& prototype)
      : prototype_(share(prototype)),
        role_(role_of(prototype)),
        midpoint_factor_(midpoint_factor_of(prototype)) {}

  EnergyRole role() const override { return role_; }
  std::optional<double> midpoint_factor() const override { return midpoint_factor_; }
  double plate_stiffness(const Material& material) const override {
    return with_python([&] {
      return cast_to<double>(prototype_->attr("plate_stiffness")(material),
                             answer_of(*prototype_, "plate_stiffness"), "a number");
    });
  }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    return with_python([&]() -> std::unique_ptr<BoundEnergy> {
      const auto kept = std::make_shared<Level>(level);  // Python may store it
      Stencils stencils = stencils_of(*prototype_, kept);
      // Without elements there is nothing to evaluate.
      SharedObject rest =
          share(stencils.rows() > 0 ? prototype_->attr("rest")(kept, material) : py::object(py::none()));
      return std::make_unique<BoundPythonEnergy>(prototype_, std::move(rest), std::move(stencils));
    });
  }

 private:
  SharedObject prototype_;
  EnergyRole role_;
  std::optional<double> midpoint_factor_;
};

/// An energy bound to a level, which it keeps.
struct BoundEnergyHandle {
  std::shared_ptr<const BoundEnergy> energy;
  std::shared_ptr<const Level> level;
  std::shared_ptr<const Energy> kind;  ///< the energy that was bound
  Material material;
  int vertices = level->vertex_count();

  double value(const State& x) const { return energy->value(x.of(vertices)); }
  Positions gradient(const State& x) const {
    Positions g = Positions::Zero(vertices, 3);
    energy->add_gradient(x.of(vertices), g);
    return g;
  }
  BlockMatrix hessian(const State& x) const { return hessian_of(*energy, x.of(vertices), Projection::none); }
};

BoundEnergyHandle bind_energy(const py::object& source, const std::shared_ptr<Level>& level,
                              const Material& material) {
  std::shared_ptr<Energy> energy;
  if (py::isinstance<py::str>(source) || py::isinstance<py::dict>(source)) {
    ConfigErrors errors;
    energy = make_from<Energy>(registry(), node_of(source), errors);
    throw_errors(errors);
  } else {
    if (!py::isinstance(source, py::module_::import("drape.prototypes").attr("Energy")))
      throw py::type_error(
          "an energy is a drape.Energy object, a plugin's name or a dict with its parameters, "
          "not " +
          shown(source) + (PyType_Check(source.ptr()) ? "; make an object of the class by calling it" : ""));
    energy = prototype_energy(source);
  }
  return {bound_energy(*energy, *level, material), level, energy, material};
}

/// The largest error of the derivatives and of the midpoint factor at x, what the errors are, and what jumps.
std::tuple<double, std::string, std::string> check_energy(const BoundEnergyHandle& h,
                                                          const std::optional<State>& given, double step) {
  const Positions x = given ? given->of(h.vertices) : checked_state(*h.level);
  const DerivativeCheck found = check_derivatives(*h.energy, x, step);
  const std::optional<double> factor = h.kind->midpoint_factor();
  const std::string jump = jump_of(*h.energy, *h.level);
  if (!factor) return {found.worst(), found.text(), jump};
  const ProlongationMatrix midpoints = midpoint_weights(*h.level);
  const Level fine = Level::of(h.level->index + 1, refined_rest(*h.level, midpoints));
  const double expected = *factor * h.value({x}),
               split = bound_energy(*h.kind, fine, h.material)->value(midpoints * x);
  // An energy far below its terms, as where weights balance each other, is round-off.
  const double terms = (h.gradient({x}).array() * x.array()).abs().sum(),
               scale = std::max({std::abs(expected), std::abs(split), 1e-6 * terms}),
               error = scale > 0 ? std::abs(split - expected) / scale : 0;
  return {error <= found.worst() ? found.worst() : error,  // a NaN counts
          found.text() + "midpoint_factor: error " + scientific_text(error, 2) + "\n", jump};
}

}  // namespace

std::shared_ptr<Energy> prototype_energy(const py::object& prototype) {
  return std::make_shared<PythonEnergy>(prototype);
}

void bind_bound_energy(py::module_& m) {
  py::class_<BoundEnergyHandle>(m, "BoundEnergy", "An energy on one level. x is n×3 [m].")
      .def("value", &BoundEnergyHandle::value, py::arg("x"), "[J]")
      .def("gradient", &BoundEnergyHandle::gradient, py::arg("x"), "n×3 [N]")
      .def("hessian", &BoundEnergyHandle::hessian, py::arg("x"),
           "3n×3n scipy.sparse.bsr_matrix [N/m], without projection.");
  m.def("_check_energy", &check_energy, py::arg("bound"), py::arg("x"), py::arg("step"));
  m.def("_checked_level", [] { return std::make_shared<Level>(checked_level()); });
  m.def(
      "bind_energy", &bind_energy, py::arg("energy"), py::arg("level").none(false),
      py::arg("material") = Material(),
      "An energy on a level: of a plugin's name, of {\"type\": name, parameter: value}, or of a drape.Energy "
      "object. Raises ConfigError.");
}

}  // namespace drape::python
