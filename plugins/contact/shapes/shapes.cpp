#include "plugins/contact/shapes/shapes.h"

#include <stdexcept>

#include "core/contact/stiffness.h"
#include "core/plugin/bounds.h"
#include "core/plugin/plugin.h"
#include "plugins/contact/shapes/bound_shapes.h"

namespace drape {

namespace {

const std::vector<std::pair<std::string, SolidKind>> words = {{"sphere", SolidKind::sphere},
                                                              {"box", SolidKind::box},
                                                              {"capsule", SolidKind::capsule},
                                                              {"cylinder", SolidKind::cylinder},
                                                              {"half_space", SolidKind::half_space}};

/// A cylinder's features are those of a prism, whose sides become more the smaller the range is: here 700
/// 000.
constexpr double most_radius_by_range = 5e6;

Solid solid_of(const ShapeParameters& p, int index, double friction) {
  Solid s;
  s.kind = p.shape;
  s.name = (p.name.empty() ? "shape " + std::to_string(index) : p.name) + ": " + word(p.shape);
  s.centre = p.centre;
  s.turn = p.rotate;
  s.plane = p.normal;
  s.friction = p.friction.value_or(friction);
  if (p.shape == SolidKind::half_space) {
    // Its square would underflow.
    if (!(p.normal.norm() > 1e-100))
      throw std::runtime_error(s.name + " needs a \"normal\" that is not zero");
  } else if (p.shape == SolidKind::box) {
    s.half = p.size / 2;
  } else {
    s.radius = p.radius;
    if (p.shape != SolidKind::sphere) s.half.z() = p.height / 2;
  }
  s.orient();
  return s;
}

}  // namespace

std::string word(SolidKind kind) {
  for (const auto& [word, own] : words)
    if (own == kind) return word;
  throw std::runtime_error("a kind of solid has no word");
}

void ShapeParameters::declare(Declaration<ShapeParameters>& d) {
  d.add("name", &ShapeParameters::name)
      .description("what messages call it; empty: its number")
      .source("this project");
  d.add_choice("shape", &ShapeParameters::shape, words)
      .required()
      .description("capsule: all points within radius of a segment; half_space: all behind a plane")
      .source("this project");
  d.add("centre", &ShapeParameters::centre)
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("its middle; of a half_space any point of the plane")
      .source("this project");
  d.add("radius", &ShapeParameters::radius)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description("of a sphere, capsule or cylinder")
      .source("this project");
  d.add("size", &ShapeParameters::size)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description("edges of a box")
      .source("this project");
  d.add("height", &ShapeParameters::height)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description(
          "along the z axis before it is turned: of a cylinder, or of a capsule without its round ends")
      .source("this project");
  d.add("rotate", &ShapeParameters::rotate)
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("about the x axis, then y, then z")
      .source("this project");
  d.add("normal", &ShapeParameters::normal)
      .at_least(-1e6)
      .at_most(1e6)
      .description("of a half_space, towards the cloth; any length")
      .source("this project");
  d.add("friction", &ShapeParameters::friction)
      .at_least(0)
      .at_most(bounds::largest_friction)
      .description("coefficient μ; null: that of all shapes")
      .source("Li et al. 2020, section 5");
}

void Shapes::Parameters::declare(Declaration<Parameters>& d) {
  d.add_sections("shapes", &Parameters::shapes)
      .required()
      .description("the obstacles")
      .source("this project");
  d.add("friction", &Parameters::friction)
      .unit("1")
      .at_least(0)
      .at_most(bounds::largest_friction)
      .description("coefficient μ of Coulomb friction")
      .source("Li et al. 2020, section 5");
  d.add("range", &Parameters::range)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(1e3)
      .description("d̂, the distance below which the barrier acts")
      .source("Li et al. 2020, eq. 6");
  d.add("stiffness", &Parameters::stiffness)
      .unit("Pa")
      .at_least(1e-9)
      .at_most(bounds::largest_modulus)
      .description("κ, the barrier's; null: ten times the cloth's weight a unit of area")
      .source("this project");
  d.add("slip_distance", &Parameters::slip_distance)
      .unit("m")
      .at_least(1e-12)
      .at_most(1e3)
      .description("a contact that has slid less than this sticks: friction is smoothed below")
      .source("Li et al. 2020, equation 14: ε_v h");
  d.add("keep", &Parameters::keep)
      .unit("1")
      .at_least(1e-6)
      .at_most(0.99)
      .description("part of every gap that a step leaves")
      .source("Li et al. 2021, additive CCD");
}

Shapes::Shapes(const Parameters& parameters) : p_(parameters) {
  for (const ShapeParameters& shape : p_.shapes) {
    solids_.push_back(solid_of(shape, static_cast<int>(solids_.size()), p_.friction));
    const Solid& solid = solids_.back();
    if (solid.kind == SolidKind::cylinder && solid.radius > most_radius_by_range * p_.range)
      throw std::runtime_error(solid.name +
                               " has a radius of more than 5e6 times \"range\"; raise \"range\"");
  }
}

std::unique_ptr<BoundContact> Shapes::bind(const Level& level, const Material& material) const {
  if (solids_.empty()) return nullptr;
  const BarrierParameters barrier{p_.range, p_.stiffness.value_or(contact_stiffness(material)),
                                  p_.slip_distance};
  return bind_shapes(level, solids_, barrier, p_.keep);
}

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, drape::Shapes>(
      "shapes", "Contact with balls, boxes, capsules, cylinders and half-spaces in closed form.");
}
