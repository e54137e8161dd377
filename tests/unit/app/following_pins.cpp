// Pins that follow an obstacle, by a mesh, an animation or a shape.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/refusal.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

/// A sheet above an obstacle, the middle of which follows it.
std::string sheet_on(const std::string& obstacle, const std::string& key, const std::string& follow,
                     const std::string& contact = "ipc", const std::string& more = "") {
  return R"(name: follower
cloth: {shape: square, side: 0.2, columns: 9, rows: 9}
levels: 2
start: {translate: [-0.1, -0.1, 0.104]}
pins: [{region: ball, point: [0.1, 0.1, 0], radius: 0.03, follow: )" +
         follow + R"(}]
energies: [neo_hookean, hinge, gravity]
contact: {type: )" +
         contact + R"(, dhat: 2e-3}
obstacles: [)" +
         obstacle +
         R"(]
newton: {force_tolerance: 1e-2}
methods: {newton: {}}
schedule:
  steps: 5
  keys: [{)" +
         key + "}" + more + "]\n";
}

const std::string ball = "{name: body, meshed_shape: sphere, radius: 0.1, subdivisions: 3}";
const std::string turn = "parameter: obstacles.body.rotate, times: [0, 1], values: [[0, 0, 0], [10, 0, 60]]";
const std::string shift =
    ", {parameter: obstacles.body.translate, times: [0, 1], values: [[0, 0, 0], [0.03, 0, 0.01]]}";

/// Looks at the state of every increment, with the obstacles where they are then.
struct IncrementObserver : Observer {
  explicit IncrementObserver(Solved& s) : scene(*s.scene) {}
  void increment_finished(const IncrementRow& row, const Positions& x) override {
    const LevelModel& model = *scene.load_stepping->model(row.level);
    ++increments;
    most_violated = std::max(most_violated, row.max_constraint_violation);
    for (const auto& contact : model.contacts()) intersections += contact->intersections(x).size();
    const TriangleMesh obstacle = obstacles_of(model.contacts())[0];
    for (const FollowingVertex& f : scene.following[row.level]) {
      const Eigen::Matrix3d corners = obstacle.vertices(f.corners, Eigen::all).transpose();
      const Eigen::Vector3d p = x.row(f.vertex);
      most_changed = std::max(most_changed, std::abs((p - corners * f.weights).norm() - f.offset.norm()));
      most_moved = std::max(most_moved, (p - scene.starts[row.level].row(f.vertex).transpose()).norm());
      if (!rigid) continue;
      const Eigen::Vector3d start = scene.starts[row.level].row(f.vertex);
      for (int v = 0; v < first.rows(); v += 37)
        most_changed = std::max(most_changed, std::abs((p - obstacle.vertices.row(v).transpose()).norm() -
                                                       (start - first.row(v).transpose()).norm()));
    }
  }
  const Scene& scene;
  Positions first = obstacles_of(scene.models[0]->contacts())[0].vertices;
  bool rigid = true;
  int increments = 0;
  std::size_t intersections = 0;
  double most_changed = 0, most_moved = 0, most_violated = 0;
};

void check_distances_are_kept(Solved& s, bool rigid) {
  IncrementObserver observer(s);
  observer.rigid = rigid;
  s.levels = s.experiment.methods[0].second->solve(*s.scene, observer);
  for (const LevelResult& level : s.levels) {
    INFO("level " << level.level << ": " << level.message);
    CHECK(has_converged(level.outcome));
  }
  CHECK(observer.increments >= 2 * 5);  // both levels begin from the start
  CHECK(observer.intersections == 0);
  CHECK(observer.most_violated == 0);
  CHECK(observer.most_changed < 1e-12);
  CHECK(observer.most_moved > 0.02);
}

/// The first error of an experiment that is refused.
std::string refusal(const std::string& text) {
  return refusal_of([&] { scene_from(text); });
}

}  // namespace

TEST_CASE("a patch that follows a turning mesh or shape keeps its distances from it at every increment") {
  const std::string shape = "{name: body, shape: sphere, radius: 0.1}";
  for (const bool meshed : {true, false}) {
    INFO(meshed);
    Solved s = scene_from(sheet_on(meshed ? ball : shape, turn, "body", meshed ? "ipc" : "shapes", shift));
    CHECK(s.scene->following[0].size() >= 4);
    CHECK(s.scene->following[1].size() > s.scene->following[0].size());
    check_distances_are_kept(s, true);
  }
}

TEST_CASE("a patch that follows an animation keeps its distance from the same points of the surface") {
  const Scratch folder;
  const TriangleMesh sphere = unit_sphere(3);
  std::string files;
  for (int k = 0; k < 3; ++k) {
    TriangleMesh frame = sphere;
    for (Eigen::Index i = 0; i < frame.vertices.rows(); ++i) {
      Eigen::Vector3d p = 0.1 * frame.vertices.row(i).transpose();
      p = Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d::UnitZ()) * p;
      p.x() *= 1 + 0.1 * k;
      p.x() += 0.02 * k + 0.1 * k * p.z();
      frame.vertices.row(i) = p;
    }
    const std::string file = (folder / ("pose" + std::to_string(k) + ".obj")).string();
    write_mesh(file, frame);
    files += (k ? ", " : "") + file;
  }
  Solved s =
      scene_from(sheet_on("{name: body, animation: [" + files + "]}",
                          "parameter: obstacles.body.frame, times: [0, 1], values: [0, 2]", "{obstacle: 0}"));
  check_distances_are_kept(s, false);
}

TEST_CASE("where the obstacle is as at the start the targets are too, and a state has them again") {
  const Solved s = scene_from(sheet_on(ball, turn, "body"));
  LoadStepping& schedule = *s.scene->load_stepping;
  const auto targets = [&] {
    Positions all = Positions::Zero(s.scene->hierarchy.levels[1].vertex_count(), 3);
    schedule.model(1)->set_dirichlet(all);
    return all;
  };
  schedule.begin(1, true);
  Positions first = Positions::Zero(s.scene->hierarchy.levels[1].vertex_count(), 3);
  s.scene->models[1]->set_dirichlet(first);
  CHECK(targets() == first);
  REQUIRE(schedule.advance(1, s.scene->starts[1]).fraction == 1);
  REQUIRE(schedule.advance(1, s.scene->starts[1]).fraction == 1);
  const Positions moved = targets();
  CHECK((moved - first).norm() > 0.01);
  const LoadSteppingState state = schedule.state();
  schedule.begin(1, true);
  CHECK(targets() == first);
  schedule.restore(1, state);
  CHECK(targets() == moved);
}

TEST_CASE("vertices of the obstacle choose the triangles that a pin is attached to") {
  const Solved s = scene_from(sheet_on(ball, turn, "{obstacle: body, vertices: [5, 17]}"));
  for (const FollowingVertices& level : s.scene->following) {
    CHECK_FALSE(level.empty());
    for (const FollowingVertex& f : level)
      CHECK(((f.corners.array() == 5).any() || (f.corners.array() == 17).any()));
  }
}

TEST_CASE("vertices of an obstacle that contact numbers anew are refused") {
  const Scratch folder;
  TriangleMesh sphere = unit_sphere(3), loose = sphere;
  loose.vertices.conservativeResize(sphere.vertices.rows() + 1, 3);
  loose.vertices.bottomRows(1) << 9, 9, 9;
  write_mesh(folder / "sphere.obj", sphere);
  write_mesh(folder / "loose.obj", loose);
  const auto following = [&](const std::string& file) {
    return sheet_on("{name: body, scale: 0.1, mesh: " + (folder / file).string() + "}", turn,
                    "{obstacle: body, vertices: [5, 17]}");
  };
  CHECK(scene_from(following("sphere.obj")).scene->following[0].size() >= 4);
  const std::string reason = "loses vertices of its file that are in no triangle";
  CHECK_THAT(refusal(following("loose.obj")), Contains(reason));
  const std::string loose_file = (folder / "loose.obj").string();
  CHECK_THAT(refusal(sheet_on("{name: body, scale: 0.1, animation: [" + loose_file + ", " + loose_file + "]}",
                              turn, "{obstacle: body, vertices: [5, 17]}")),
             Contains(reason));
}

TEST_CASE("a pin that cannot follow is refused with the reason") {
  const std::string other = ball + ", {name: floor, meshed_shape: box, translate: [0, 0, -2]}";
  CHECK_THAT(refusal(sheet_on(other, turn, "bdy")),
             Contains(":5:67: pin 0 follows obstacle \"bdy\", which does not exist; did you mean \"body\"?"));
  CHECK_THAT(refusal(sheet_on(other, turn, "{obstacle: 2}")),
             Contains("which does not exist; the names are body, floor"));
  CHECK_THAT(refusal(sheet_on(other, turn, "floor")),
             Contains("pin 0 follows obstacle \"floor\", which is 1.6 m away from vertex "));
  CHECK_THAT(refusal(sheet_on(other, turn, "{obstacle: body, vertices: [3, 642]}")),
             Contains("pin 0 follows obstacle \"body\", which has no vertex 642; they go from 0 to 641"));
  CHECK_THAT(
      refusal(sheet_on(ball, turn, "body", "ipc",
                       ", {parameter: pins.0.translate, times: [0, 1], values: [[0, 0, 0], [0, 0, 1]]}")),
      Contains(
          "key \"pins.0.translate\" changes pin 0, which follows obstacle \"body\"; move the obstacle, or "
          "remove \"follow\""));
  std::string two_pins = sheet_on(other, turn, "body");
  two_pins.insert(two_pins.find("]\nenergies"), ", {region: nearest, point: [0.1, 0.1, 0]}");
  CHECK_THAT(
      refusal(two_pins),
      Contains("pin 0 follows obstacle \"body\", which pin 1 does not follow, but both select vertex 40 "
               "of level 0; let their regions share no vertex"));
  std::string other_vertices = sheet_on(ball, turn, "body");
  other_vertices.insert(
      other_vertices.find("]\nenergies"),
      ", {region: nearest, point: [0.1, 0.1, 0], follow: {obstacle: body, vertices: [5, 17]}}");
  CHECK_THAT(refusal(other_vertices),
             Contains("which pin 1 follows by other vertices, but both select vertex 40"));
  std::string unnamed = sheet_on("{meshed_shape: sphere, radius: 0.1, subdivisions: 3}",
                                 replaced(turn, "body", "0"), "{obstacle: 0}");
  unnamed.insert(unnamed.find("]\nenergies"), ", {region: nearest, point: [0.1, 0.1, 0]}");
  CHECK_THAT(refusal(unnamed), Contains("which pin 1 does not follow"));
  CHECK_THAT(refusal(R"(name: alone
pins: [{region: nearest, follow: body}]
energies: [neo_hookean]
methods: {newton: {}}
)"),
             Contains("which does not exist; give an obstacle a \"name\", or follow it by its index from 0"));
}
