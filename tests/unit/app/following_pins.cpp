// Pins that follow an obstacle, by a mesh, an animation or a shape.

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// A sheet above an obstacle, the middle of which follows it, with these keys of a schedule.
std::string sheet_on(const std::string& obstacle, const std::string& keys, const std::string& follow,
                     const std::string& contact = "ipc") {
  return R"(name: follower
cloth: {shape: square, side: 0.2, columns: 9, rows: 9}
levels: 2
start: {translate: [-0.1, -0.1, 0.104]}
pins: [{region: ball, point: [0.1, 0.1, 0], radius: 0.03, follow: )" +
         follow + "}]\nenergies: [neo_hookean, hinge, gravity]\ncontact: {type: " + contact +
         ", dhat: 2e-3}\nobstacles: [" + obstacle +
         "]\nnewton: {force_tolerance: 1e-2}\nmethods: {newton: {}}\nschedule: {steps: 5, keys: [" + keys +
         "]}\n";
}

const std::string ball = "{name: body, meshed_shape: sphere, radius: 0.1, subdivisions: 3}";
const std::string turn =
    "{parameter: obstacles.body.rotate, times: [0, 1], values: [[0, 0, 0], [10, 0, 60]]}";
const std::string shift =
    "{parameter: obstacles.body.translate, times: [0, 1], values: [[0, 0, 0], [0.03, 0, 0.01]]}";

/// Looks at the state of every increment, with the obstacles where they are then.
struct IncrementObserver : Observer {
  explicit IncrementObserver(Solved& s) : scene(*s.scene) {}
  void increment_finished(const IncrementRow& row, const Positions& x) override {
    const LevelModel& model = *scene.load_stepping->model(row.level);
    ++increments;
    most_violated = std::max(most_violated, row.max_constraint_violation);
    for (const auto& contact : model.contacts()) intersections += contact->intersections(x).size();
    const TriangleMesh obstacle = model.obstacles()[0];
    for (const FollowingVertex& f : scene.following[row.level]) {
      const Eigen::Matrix3d corners = obstacle.vertices(f.corners, Eigen::all).transpose();
      const Eigen::Vector3d p = x.row(f.vertex), start = scene.starts[row.level].row(f.vertex);
      most_changed = std::max(most_changed, std::abs((p - corners * f.weights).norm() - f.offset.norm()));
      most_moved = std::max(most_moved, (p - start).norm());
      if (!rigid) continue;
      for (int v = 0; v < first.rows(); v += 37)
        most_changed = std::max(most_changed, std::abs((p - obstacle.vertices.row(v).transpose()).norm() -
                                                       (start - first.row(v).transpose()).norm()));
    }
  }
  const Scene& scene;
  Positions first = scene.models[0]->obstacles()[0].vertices;
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

}  // namespace

TEST_CASE("a patch that follows a turning mesh or shape keeps its distances from it at every increment") {
  const std::string shape = "{name: body, shape: sphere, radius: 0.1}";
  for (const bool meshed : {true, false}) {
    INFO(meshed);
    Solved s =
        scene_from(sheet_on(meshed ? ball : shape, turn + ", " + shift, "body", meshed ? "ipc" : "shapes"));
    CHECK(s.scene->following[0].size() >= 4);
    CHECK(s.scene->following[1].size() > s.scene->following[0].size());
    check_distances_are_kept(s, true);
  }
}

TEST_CASE("a patch that follows an animation keeps its distance from the same points of the surface") {
  const Scratch folder;
  std::string files;
  for (int k = 0; k < 3; ++k) {
    TriangleMesh frame = unit_sphere(3);
    for (auto vertex : frame.vertices.rowwise()) {
      Eigen::Vector3d p = 0.1 * vertex.transpose();
      p = Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d::UnitZ()) * p;
      p.x() *= 1 + 0.1 * k;
      p.x() += 0.02 * k + 0.1 * k * p.z();
      vertex = p;
    }
    const std::string file = (folder / ("pose" + std::to_string(k) + ".obj")).string();
    write_mesh(file, frame);
    files += (k ? ", " : "") + file;
  }
  Solved s = scene_from(sheet_on("{name: body, animation: [" + files + "]}",
                                 "{parameter: obstacles.body.frame, times: [0, 1], values: [0, 2]}",
                                 "{obstacle: 0}"));
  check_distances_are_kept(s, false);
}

TEST_CASE("where the obstacle is as at the start the targets are too, and a state has them again") {
  const Solved s = scene_from(sheet_on(ball, turn, "body"));
  LoadStepping& schedule = *s.scene->load_stepping;
  const auto targets_of = [&](const LevelModel& model) {
    Positions all = Positions::Zero(model.level().vertex_count(), 3);
    model.set_dirichlet(all);
    return all;
  };
  const auto targets = [&] { return targets_of(*schedule.model(1)); };
  schedule.begin(1, true);
  const Positions first = targets_of(*s.scene->models[1]);
  CHECK(targets() == first);
  for (int k = 0; k < 2; ++k) REQUIRE(schedule.advance(1, s.scene->starts[1]).fraction == 1);
  const Positions moved = targets();
  CHECK((moved - first).norm() > 0.01);
  const LoadSteppingState state = schedule.state();
  schedule.begin(1, true);
  CHECK(targets() == first);
  schedule.restore(1, state);
  CHECK(targets() == moved);
}

TEST_CASE(
    "vertices of the obstacle choose the triangles that a pin is attached to, unless contact drops some") {
  const std::string follow = "{obstacle: body, vertices: [5, 17]}";
  const Scratch folder;
  TriangleMesh sphere = unit_sphere(3), loose = sphere;
  loose.vertices.conservativeResize(sphere.vertices.rows() + 1, 3);
  loose.vertices.bottomRows(1) << 9, 9, 9;
  write_mesh(folder / "sphere.obj", sphere);
  write_mesh(folder / "loose.obj", loose);
  const std::string file = (folder / "sphere.obj").string(), loose_file = (folder / "loose.obj").string();
  const auto on_body = [&](const std::string& source) {
    return sheet_on("{name: body, scale: 0.1, " + source + "}", turn, follow);
  };
  for (const std::string& sheet : {sheet_on(ball, turn, follow), on_body("mesh: " + file)}) {
    const Solved s = scene_from(sheet);
    for (const FollowingVertices& level : s.scene->following) {
      CHECK(level.size() >= 4);
      for (const FollowingVertex& f : level)
        CHECK(((f.corners.array() == 5).any() || (f.corners.array() == 17).any()));
    }
  }
  for (const std::string& source :
       {"mesh: " + loose_file, "animation: [" + loose_file + ", " + loose_file + "]"})
    CHECK_THROWS_WITH(scene_from(on_body(source)),
                      Catch::Contains("loses vertices of its file that are in no triangle"));
}
