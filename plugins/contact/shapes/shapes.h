#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/threads/deferred.h"
#include "core/numerics/contact/contact_parameters.h"
#include "plugins/contact/shapes/solid.h"

namespace drape::shapes {

/// One obstacle in a config. `radius`, `size`, `height` and `normal` count for some shapes alone.
struct ShapeParameters : CommonObstacleParameters {
  SolidKind shape = SolidKind::sphere;
  double radius = 0.1;
  Eigen::Vector3d size{0.2, 0.2, 0.2};
  double height = 0.2;
  Eigen::Vector3d normal{0, 0, 1};
  static void declare(Declaration<ShapeParameters>& d);
};

/// Each kind and its name in configs, as in `shape: half_space`.
extern const std::vector<std::pair<std::string, SolidKind>> kind_names;
std::string to_string(SolidKind kind);

struct SolidFeatures;

/// Contact with convex obstacles in closed form (see README.md).
class Shapes final : public ContactModel {
 public:
  struct Parameters : ContactParameters {
    std::vector<ShapeParameters> obstacles;
    static void declare(Declaration<Parameters>& d);
  };

  /// Throws RefusedParameters if a half-space's normal is zero or a cylinder's radius too large for d̂, and
  /// std::runtime_error if the rims of all cylinders have too many points.
  explicit Shapes(const Parameters& parameters);
  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
  std::vector<Solid> solids_;
  std::optional<Deferred<SolidFeatures>> features_;  // made when a level is first bound
};

}  // namespace drape::shapes
