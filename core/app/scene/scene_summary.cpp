#include "core/app/scene/scene_summary.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/kernel/files/number_text.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/model/required.h"

namespace drape {

namespace {

Eigen::Vector3d extents(const Positions& x) { return x.colwise().maxCoeff() - x.colwise().minCoeff(); }

/// The acceleration that energies give to all masses alike [m/s²]; 0 without one.
double gravity_of(const LevelModel& model, const std::vector<NamedEnergy>& energies) {
  const Positions origin = Positions::Zero(model.level().vertex_count(), 3);
  double gravity = 0;
  for (const NamedEnergy& named : energies) {
    if (named.energy->role() != EnergyRole::external) continue;
    const auto energy = bound_energy(*named.energy, model.level(), model.material());
    if (energy->stencils().rows() > 0) continue;  // it depends on the state
    Positions force = Positions::Zero(origin.rows(), 3);
    energy->add_gradient(origin, force);
    const Positions each = model.masses().cwiseInverse().asDiagonal() * force;
    const double first = each.row(0).norm();
    if ((each.rowwise() - each.row(0)).rowwise().norm().maxCoeff() <= 1e-6 * first)
      gravity = std::max(gravity, first);
  }
  return gravity;
}

/// The lengths of a level's edges with its vertices at x [m].
Eigen::VectorXd edge_lengths(const Level& level, const Positions& x) {
  const auto& edges = level.topology.edges;
  return (x(edges.col(0), Eigen::all) - x(edges.col(1), Eigen::all)).rowwise().norm();
}

double median(Eigen::VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Lengths of a level's edges in its rest shape [m].
Eigen::VectorXd rest_lengths(const Level& level) {
  Eigen::VectorXd lengths(level.topology.edges.rows());
  for (int e = 0; e < lengths.size(); ++e) lengths[e] = rest_length(level.rest, level.topology, e);
  return lengths;
}

void add_edges(const Level& level, SceneSummary& summary) {
  const Eigen::VectorXd lengths = rest_lengths(level);
  summary.shortest_edge = lengths.minCoeff();
  summary.median_edge = median(lengths);
  summary.longest_edge = lengths.maxCoeff();
  summary.level = level.index;
}

/// Seen from above, the bounding box of an obstacle.
Eigen::AlignedBox2d plan_of(const TriangleMesh& mesh) {
  return {mesh.vertices.colwise().minCoeff().head<2>().transpose(),
          mesh.vertices.colwise().maxCoeff().head<2>().transpose()};
}

/// How the masses lie over a bounded obstacle.
void add_place(const Positions& start, const Eigen::VectorXd& masses, const Eigen::Vector2d& centre,
               const Eigen::AlignedBox2d& plan, ObstacleSummary& obstacle) {
  obstacle.beside = (centre - plan.center()).norm();
  for (Eigen::Index v = 0; v < start.rows(); ++v)
    if (plan.contains(start.row(v).head<2>().transpose())) obstacle.over += masses[v] / masses.sum();
}

void add_contacts(const LevelModel& model, const Positions& start, SceneSummary& summary) {
  const Eigen::VectorXd& masses = model.masses();
  const Eigen::Vector2d centre = start.leftCols<2>().transpose() * masses / masses.sum();
  Eigen::AlignedBox2d all;
  const Positions points = start(components(model.level().topology), Eigen::all);
  for (const auto& contact : model.contacts()) {
    summary.dhat = std::max(summary.dhat, contact->dhat());
    std::vector<ObstacleGap> gaps = contact->obstacle_gaps(start);
    if (gaps.empty()) continue;
    const std::vector<TriangleMesh> meshes = contact->obstacles();
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      summary.obstacle_triangles += static_cast<double>(meshes[k].triangles.rows());
      if (is_inside(points, meshes[k])) summary.enclosing = gaps[k].obstacle;
      summary.obstacles.push_back({std::move(gaps[k]), extents(meshes[k].vertices),
                                   start.col(2).minCoeff() - meshes[k].vertices.col(2).maxCoeff()});
      ObstacleSummary& obstacle = summary.obstacles.back();
      if (!obstacle.gap.is_bounded) {
        obstacle.over = 1;
        summary.is_centre_over = true;
        continue;
      }
      const Eigen::AlignedBox2d plan = plan_of(meshes[k]);
      add_place(start, masses, centre, plan, obstacle);
      all.extend(plan);
    }
  }
  summary.is_centre_over = summary.is_centre_over || all.contains(centre);
}

std::string edges_text(double length, const SceneSummary& s) {
  return length_text(length) + " (" + rounded_text(length / s.median_edge, 2) + " edges)";
}

/// Two lengths of one unit: "8–31 mm".
std::string range_text(double from, double to) {
  const bool small = to < 0.1;
  const std::string low = rounded_text(small ? 1e3 * from : from, 2),
                    high = rounded_text(small ? 1e3 * to : to, 2);
  return (low == high ? low : low + "–" + high) + (small ? " mm" : " m");
}

/// Where a cloth lies that is above its obstacle, but not over its middle; "" for another.
std::string place_text(const ObstacleSummary& obstacle, const SceneSummary& s) {
  constexpr double near = 0.05;  // of the cloth
  if (obstacle.drop < 0 || obstacle.beside < near * s.size.maxCoeff() || obstacle.over > 0.999) return "";
  return ", " + fixed_text(100 * obstacle.over, 0) + " % of the cloth over its bounding box, its centre " +
         length_text(obstacle.beside) + " beside the middle of that";
}

std::string mass_text(double mass) {
  return mass < 0.01 ? rounded_text(1e3 * mass, 2) + " g" : rounded_text(mass, 2) + " kg";
}

}  // namespace

SceneSummary summary_of(const Scene& scene) {
  const LevelModel& coarsest = *scene.model(0);
  const Material& material = coarsest.material();
  SceneSummary summary;
  summary.size = extents(coarsest.level().rest.vertices);
  summary.parts = static_cast<int>(components(coarsest.level().topology).size());
  summary.mass = coarsest.masses().sum();
  add_edges(scene.hierarchy.levels.back(), summary);
  const Eigen::VectorXd rest = rest_lengths(coarsest.level());
  summary.start_stretch = median(edge_lengths(coarsest.level(), scene.placed[0]).cwiseQuotient(rest));
  double stiffness = 0;
  for (const NamedEnergy& named : scene.energies)
    if (named.energy->role() == EnergyRole::bending) stiffness += named.energy->plate_stiffness(material);
  const double gravity = gravity_of(coarsest, scene.energies);
  if (gravity > 0 && stiffness > 0)
    summary.bending_length = std::cbrt(stiffness / (material.area_density() * gravity));
  add_contacts(coarsest, scene.starts[0], summary);
  return summary;
}

std::optional<double> estimated_seconds(const SceneSummary& s, double vertices) {
  // Soft cloth has more folds, which take more iterations.
  if (!s.bending_length) return std::nullopt;
  constexpr double each = 1.1e-5, with_contact = 2;  // [s], [1]
  return each * vertices * s.size.maxCoeff() / *s.bending_length * (s.dhat > 0 ? with_contact : 1);
}

double median_rest_edge(const Level& level) { return median(rest_lengths(level)); }

double median_edge(const Level& level) { return median(edge_lengths(level, level.rest.vertices)); }

std::string text_of(const SceneSummary& s) {
  std::string text = size_text(s.size) + ", " + std::to_string(s.parts) +
                     (s.parts == 1 ? " part" : " parts") + ", edges " +
                     range_text(s.shortest_edge, s.longest_edge) +
                     (s.level > 0 ? " on level " + std::to_string(s.level) : "") + ", " + mass_text(s.mass);
  if (s.bending_length) text += ", bending length " + edges_text(*s.bending_length, s);
  if (s.dhat > 0) text += ", d̂ " + edges_text(s.dhat, s);
  const auto nearest = s.nearest();
  if (nearest == s.obstacles.end()) return text;
  constexpr double steep = 0.5;  // the sine of 30°
  const double up = nearest->gap.direction.z();
  return text + ", starts " + length_text(nearest->gap.gap) +
         (up > steep    ? " above "
          : up < -steep ? " below "
                        : " beside ") +
         nearest->gap.obstacle + place_text(*nearest, s);
}

std::string size_text(const Eigen::Vector3d& size) {
  const bool small = size.maxCoeff() < 0.1;
  std::string text;
  for (const double extent : size)
    if (extent > 1e-5 * size.maxCoeff())
      text += (text.empty() ? "" : " × ") + rounded_text(small ? 1e3 * extent : extent, 3);
  return text + (small ? " mm" : " m");
}

std::string length_text(double length) {
  return length < 0.1 ? rounded_text(1e3 * length, 2) + " mm" : rounded_text(length, 2) + " m";
}

std::string point_text(const Eigen::Vector3d& p) {
  return "(" + rounded_text(p.x(), 3) + ", " + rounded_text(p.y(), 3) + ", " + rounded_text(p.z(), 3) + ")";
}

std::string rounded_text(double value, int digits) {
  const double size = std::abs(value);
  if (!(size >= std::pow(10.0, digits - 0.5)) || size > 1e15) return general_text(value, digits);
  const double unit = std::pow(10.0, std::floor(std::log10(size)) - digits + 1);
  return fixed_text(unit > 1 ? std::round(value / unit) * unit : value, 0);
}

}  // namespace drape
