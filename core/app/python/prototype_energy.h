#pragma once

#include "core/app/python/python_call.h"
#include "core/kernel/interfaces/energy.h"

namespace drape::python {

/// An energy whose elements a Python object evaluates, all at once: see drape.Energy. Summation, projection
/// and scatter are here, in the order of the elements.
class PythonEnergy final : public Energy {
 public:
  /// Throws ValueError for a role that does not exist. Call with the GIL held.
  explicit PythonEnergy(py::object prototype);

  EnergyRole role() const override { return role_; }
  std::optional<double> midpoint_factor() const override { return midpoint_factor_; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override;

 private:
  SharedObject prototype_;
  EnergyRole role_ = EnergyRole::membrane;
  std::optional<double> midpoint_factor_;
};

}  // namespace drape::python
