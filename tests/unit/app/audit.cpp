// Ends that contact holds: those at rest pass the run's own check, and others do not.

#include "core/app/run/audit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/model/required.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

const std::string standing = "cloth: {shape: rectangle, size: [0.25, 0.3], vertices: 400}\n";
const std::string stood_up = "start: {rotate: [90, 0, 0]}\n";

/// Two boxes with the cloth between them, `distance` from the cloth to the middle of each.
std::string jaws(const std::string& key, const std::string& distance, const std::string& left = "",
                 const std::string& right = "") {
  const auto body = [&](const std::string& name, const std::string& y, const std::string& more) {
    return "  - {name: " + name + ", " + key + ": box, size: [0.2, 0.1, 0.1], translate: [0.125, " + y +
           ", 0.2]" + more + "}\n";
  };
  return "obstacles:\n" + body("left", "-" + distance, left) + body("right", distance, right);
}

/// Both jaws rise and move along the cloth.
std::string rising() {
  std::string text = "schedule:\n  steps: 3\n  keys:\n";
  for (const std::string jaw : {"left, -0.0503", "right, 0.0503"}) {
    const std::string name = jaw.substr(0, jaw.find(',')), y = jaw.substr(jaw.find(',') + 2);
    text += "    - {parameter: obstacles." + name + ".translate, times: [0, 1], values: [[0.125, " + y +
            ", 0.2], [0.135, " + y + ", 0.23]]}\n";
  }
  return text;
}

/// A square that falls on a body.
std::string fallen_on(const std::string& contact, const std::string& body, const std::string& height) {
  return "cloth: {shape: square, side: 0.3, columns: 12, rows: 12}\nstart: {translate: [-0.15, -0.15, " +
         height + "]}\ncontact: " + contact + "\nobstacles: [{name: body, " + body + "}]\n";
}

/// A strip of 20 cm that is folded once, 3 mm high and around the plane z = 3 mm.
Positions folded(Positions x) {
  constexpr double radius = 0.0015, straight = (0.2 - M_PI * radius) / 2;
  for (auto v : x.rowwise()) {
    const double s = v.x() - straight, angle = std::clamp(s / radius, 0.0, M_PI);
    v.x() = straight + std::min(s, 0.0) + radius * std::sin(angle) - std::max(s - M_PI * radius, 0.0);
    v.z() = 0.003 - radius * std::cos(angle);
  }
  return x;
}

/// The meshes that the scenes read.
void write_meshes(const Scratch& folder) {
  TriangleMesh layer = grid({0.25, 0.3}, 11, 13, Diagonals::one_way);
  layer.vertices.col(1).swap(layer.vertices.col(2));
  write_mesh(folder / "layers.obj", both_of(layer, layer, {0.003, 0.0006, 0.002}));
  TriangleMesh six = grid({0.18, 0.18}, 7, 7, Diagonals::one_way);
  const TriangleMesh one = six;
  for (int k = 1; k < 6; ++k) six = both_of(six, one, k * Eigen::RowVector3d(0.001, 0.002, 0.0006));
  write_mesh(folder / "stack.obj", six);
  TriangleMesh strip = grid({0.2, 0.06}, 31, 4, Diagonals::one_way);
  write_mesh(folder / "strip.obj", strip);
  strip.vertices = folded(strip.vertices);
  write_mesh(folder / "folded.obj", strip);
  TriangleMesh table = wheel(24);
  table.vertices *= 0.09;
  write_mesh(folder / "table.obj", table);
  write_mesh(folder / "pyramid.obj",
             mesh_of({{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}, {0, 0, 0.1}},
                     {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}));
}

const std::string cube_on_its_corner = ": box, size: [0.1, 0.1, 0.1], rotate: [45, 35.26, 0]";
const std::string as_mesh = "meshed_shape", as_shape = "shape";

struct HeldCloth {
  std::string how, scene, friction = "0.6";
};

const std::vector<HeldCloth> held_cloths = {
    {"by two bodies", standing + stood_up + "contact: ipc\n" + jaws(as_mesh, "0.0503")},
    {"by two shapes", standing + stood_up + "contact: shapes\n" + jaws(as_shape, "0.0503")},
    {"by bodies that have moved",
     standing + stood_up + "contact: ipc\n" + jaws(as_mesh, "0.0503") + rising()},
    {"by shapes that have moved",
     standing + stood_up + "contact: shapes\n" + jaws(as_shape, "0.0503") + rising()},
    {"by parallel edges", standing + stood_up + "contact: ipc\n" +
                              jaws(as_mesh, "0.07101", ", rotate: [45, 0, 0]", ", rotate: [45, 0, 0]")},
    {"by crossed edges",
     standing + stood_up + "contact: ipc\n" +
         jaws(as_mesh, "0.07101", ", rotate: [45, 0, 0]", ", rotate: [45, 20, 0]"),
     "1.5"},
    {"with another layer",
     "cloth: {shape: file, file: layers.obj}\nstart: {translate: [0, -0.0003, 0]}\ncontact: ipc\n" +
         jaws(as_mesh, "0.0506")},
    {"in a stack on a slope",
     "cloth: {shape: file, file: stack.obj}\nstart: {rotate: [0, 15, 0], translate: [0, 0, 0.001]}\n"
     "contact: [ipc, shapes]\nobstacles: [{shape: half_space, normal: [0.258819, 0, 0.9659258]}]\n"},
    {"in a fold on itself",
     "cloth: {shape: file, file: strip.obj}\nstart: {file: folded.obj}\ncontact: [ipc, shapes]\n"
     "obstacles: [{shape: half_space}, {shape: half_space, normal: [0, 0, -1], translate: [0, 0, 0.006]}]\n"},
    {"in a heap",
     "cloth: {shape: rectangle, size: [0.02, 0.2], columns: 3, rows: 21}\n"
     "start: {rotate: [88, 0, 0], translate: [0, 0, 0.01], perturbation: 1e-3}\n"
     "contact: [ipc, shapes]\nobstacles: [{shape: half_space}]\n"},
    {"over a rim", fallen_on("ipc", "mesh: table.obj", "0.002")},
    {"on a tip", fallen_on("ipc", "mesh: pyramid.obj", "0.102")},
    {"on a corner", fallen_on("ipc", as_mesh + cube_on_its_corner, "0.09")},
    {"on a shape's corner", fallen_on("shapes", as_shape + cube_on_its_corner, "0.09")},
    {"over a rod",
     fallen_on("[ipc, shapes]", "shape: capsule, radius: 0.02, height: 0.4, rotate: [90, 0, 0]", "0.021")},
    {"by a floor that drags it, with friction's lag damped",
     "cloth: {shape: rectangle, size: [0.2, 0.04], columns: 11, rows: 3, triangulation: one_way}\n"
     "start: {rotate: [0, 80, 0], translate: [0, 0, 0.197562]}\n"
     "pins: [{region: box, lower: [-0.001, -1, -1], upper: [0.001, 1, 1]}]\n"
     "contact: shapes\nobstacles: [{name: floor, shape: half_space}]\n"
     "schedule: {steps: 4, keys: [{parameter: obstacles.floor.translate, times: [0, 1], values: [[0, 0, 0], "
     "[0.1, 0, 0]]}]}\n",
     "1.5"}};

constexpr double audit_tolerance = 1e-4;

std::string experiment_of(const std::string& scene, const std::string& friction) {
  return "name: held\nlevels: 1\n"
         "material: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e5, bending_modulus: 8e5}\n"
         "energies: [neo_hookean, hinge, gravity]\nnewton: {force_tolerance: 1e-4}\n"
         "methods: {newton: {}}\nfriction: " +
         friction + "\n" + scene;
}

Solved scene_in(const Scratch& folder, const std::string& text) {
  folder.write("e.yaml", text);
  Solved s{experiment_in(folder / "e.yaml"), nullptr, {}};
  s.scene = scene_of(s.experiment);
  return s;
}

/// The vertices of the contact with the largest friction, moved apart by `part` of the smallest gap.
Positions parted(const LevelModel& model, const Positions& x, double part) {
  FrictionContact strongest;
  double gap = std::numeric_limits<double>::infinity();
  for (const auto& contact : model.contacts()) {
    const auto collisions = collisions_at(*contact, x);
    gap = std::min(gap, collisions->smallest_gap());
    for (const auto& group : friction_contacts(*collisions))
      for (const FrictionContact& c : group)
        if (c.force > strongest.force) strongest = c;
  }
  REQUIRE(strongest.force > 0);
  Positions y = x;
  for (int k = 0; k < 4; ++k)
    if (const int v = strongest.vertices[k]; v >= 0)
      y.row(v) += part * gap * strongest.c[k] * strongest.normal.transpose();
  return y;
}

}  // namespace

TEST_CASE("a cloth at rest is at rest however contact holds it, and no cloth that is not") {
  const Scratch folder;
  write_meshes(folder);
  for (const HeldCloth& cloth : held_cloths) {
    INFO("held " << cloth.how);
    const Solved s = [&] {
      Solved solved = scene_in(folder, experiment_of(cloth.scene, cloth.friction));
      run_method(solved);
      return converged(std::move(solved));
    }();
    const LevelResult& end = s.levels.back();
    const LevelResult said = audited(*s.scene, end, audit_tolerance);
    INFO(said.message);
    CHECK(said.outcome == Outcome::converged);
    const auto outcome_at = [&](const Positions& x, const Scene& scene) {
      LevelResult claimed = end;
      claimed.x = x;
      claimed.force_residual = 1;  // admitted, which is no excuse
      const Outcome outcome = audited(scene, claimed, audit_tolerance).outcome;
      claimed.outcome = Outcome::converged_to_rounding;
      const Outcome to_rounding = audited(scene, claimed, audit_tolerance).outcome;
      CHECK((outcome == Outcome::converged ? to_rounding == Outcome::converged_to_rounding
                                           : to_rounding == outcome));
      return outcome;
    };
    CHECK(outcome_at(end.x, *s.scene) == Outcome::converged);
    CHECK(outcome_at(s.scene->starts[0], *s.scene) == Outcome::stalled);
    // A vertex that touches something is pressed too much or too little.
    const LevelModel model = s.model().with_stiffness(end.contact_stiffness);
    for (const double part : {-0.3, 0.3})
      CHECK(outcome_at(parted(model, end.x, part), *s.scene) == Outcome::stalled);
    // Under less friction, or none, the same cloth would slide.
    for (const std::string less : {"0.01", "0"}) {
      INFO("with friction " << less);
      const Solved slippery = scene_in(folder, experiment_of(cloth.scene, less));
      if (slippery.scene->load_stepping) slippery.scene->load_stepping->restore(0, end.load_stepping);
      CHECK(outcome_at(end.x, *slippery.scene) == Outcome::stalled);
    }
  }
}
