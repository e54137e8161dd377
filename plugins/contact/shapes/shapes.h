#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/contact_model.h"
#include "core/plugin/parameters.h"
#include "plugins/contact/shapes/solid.h"

namespace drape {

/// One obstacle as it is written.
struct ShapeParameters {
  std::string name;
  SolidKind shape = SolidKind::sphere;
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 0.1;
  Eigen::Vector3d size{0.2, 0.2, 0.2};
  double height = 0.2;
  Eigen::Vector3d rotate{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 1};
  std::optional<double> friction;
  static void declare(Declaration<ShapeParameters>& d);
};

/// The word for a kind, as in `shape: half_space`.
std::string word(SolidKind kind);

/// Contact with convex obstacles in closed form; a ball then costs no triangles (see README.md).
class Shapes final : public ContactModel {
 public:
  struct Parameters {
    std::vector<ShapeParameters> shapes;
    double friction = 0;              ///< μ
    double range = 1e-3;              ///< d̂
    std::optional<double> stiffness;  ///< κ
    double slip_distance = 1e-4;      ///< ε_v h
    double keep = 0.1;
    static void declare(Declaration<Parameters>& d);
  };

  /// Throws std::runtime_error if a half-space's normal is zero.
  explicit Shapes(const Parameters& parameters);
  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
  std::vector<Solid> solids_;
};

}  // namespace drape
