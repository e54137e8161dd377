#include "plugins/contact/shapes/shapes.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "plugins/contact/shapes/shape_scene.h"

namespace drape::shapes {

const std::vector<std::pair<std::string, SolidKind>> kind_names = {{"sphere", SolidKind::sphere},
                                                                   {"box", SolidKind::box},
                                                                   {"capsule", SolidKind::capsule},
                                                                   {"cylinder", SolidKind::cylinder},
                                                                   {"half_space", SolidKind::half_space}};

namespace {

/// A rim's polygon has more sides the smaller d̂ is compared with the radius: 700 000 at this ratio.
constexpr double max_radius_over_dhat = 5e6;
/// Of all cylinders together, which take some 300 MB.
constexpr long most_rim_points = 4'000'000;

Solid solid_of(const ShapeParameters& p, int index, double friction) {
  Solid s;
  s.kind = p.shape;
  s.name = (p.name.empty() ? "shape " + std::to_string(index) : p.name) + ": " + to_string(p.shape);
  s.centre = p.translate;
  s.rotate = p.rotate;
  s.plane = p.normal;
  s.friction = p.friction.value_or(friction);
  switch (p.shape) {
    case SolidKind::half_space:
      // The square of a smaller norm would underflow.
      if (!(p.normal.norm() > 1e-100))
        throw std::runtime_error(s.name + " needs a \"normal\" that is not zero");
      break;
    case SolidKind::box:
      s.half = p.size / 2;
      break;
    case SolidKind::capsule:
    case SolidKind::cylinder:
      s.half.z() = p.height / 2;
      [[fallthrough]];
    case SolidKind::sphere:
      s.radius = p.radius;
  }
  s.update_axes();
  return s;
}

}  // namespace

std::string to_string(SolidKind kind) {
  return std::ranges::find(kind_names, kind, &std::pair<std::string, SolidKind>::second)->first;
}

void ShapeParameters::declare(Declaration<ShapeParameters>& d) {
  declare_obstacle(d);
  d.add_choice(
       "shape", &ShapeParameters::shape, kind_names,
       "centred at the origin; capsule: all points within radius of a segment; half_space: all points "
       "behind a plane")
      .required()
      .identifies_item();
  d.declared("rotate").only_with("shape", {"sphere", "box", "capsule", "cylinder"});
  const auto add_length = [&](const char* name, auto member, std::vector<std::string> shapes,
                              const char* description) {
    d.add(name, member, description)
        .unit("m")
        .between(bounds::smallest_length, bounds::largest_length)
        .only_with("shape", std::move(shapes));
  };
  add_length("radius", &ShapeParameters::radius, {"sphere", "capsule", "cylinder"},
             "radius of a sphere, capsule or cylinder");
  add_length("size", &ShapeParameters::size, {"box"}, "edge lengths of a box");
  add_length("height", &ShapeParameters::height, {"capsule", "cylinder"},
             "length along the local z axis of a cylinder, or of a capsule without its hemispheres");
  d.add("normal", &ShapeParameters::normal,
        "outward normal of a half_space, of any length, in place of `rotate`")
      .between(-1e6, 1e6)
      .only_with("shape", {"half_space"});
}

void Shapes::Parameters::declare(Declaration<Parameters>& d) {
  declare_obstacles(d).description("analytic shapes that the cloth collides with");
  declare_contact_parameters(d);
}

Shapes::Shapes(const Parameters& parameters) : p_(parameters) {
  long points = 0;
  for_all_items("obstacles", p_.obstacles, [&](const ShapeParameters& shape, std::size_t k) {
    const Solid solid = solid_of(shape, static_cast<int>(k), p_.friction);
    if (solid.kind == SolidKind::cylinder && solid.radius > max_radius_over_dhat * p_.dhat)
      throw std::runtime_error(solid.name + " has a radius of more than 5e6 times \"dhat\"; raise \"dhat\"");
    if (solid.kind == SolidKind::cylinder) points += rim_points(solid, p_.dhat);
    solids_.push_back(solid);
  });
  if (points > most_rim_points)
    throw std::runtime_error("the rims of cylinders have " + std::to_string(points) + " points, of at most " +
                             std::to_string(most_rim_points) +
                             " in all; raise \"dhat\", or make cylinders fewer");
  features_.emplace([solids = solids_, dhat = p_.dhat] { return SolidFeatures::of(solids, dhat); });
}

std::unique_ptr<BoundContact> Shapes::bind(const Level& level, const Material& material) const {
  if (solids_.empty()) return nullptr;
  return bind_shapes(
      ShapeScene::of(level, solids_, features_->get(), p_.barrier(material), p_.min_gap_fraction));
}

}  // namespace drape::shapes

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, drape::shapes::Shapes>(
      "shapes", "Contact with spheres, boxes, capsules, cylinders and half-spaces in closed form.");
}
