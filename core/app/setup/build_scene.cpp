#include "core/app/setup/build_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/app/dressing/dressing.h"
#include "core/app/experiment/sewn_cloth.h"
#include "core/app/scene/boundary_conditions.h"
#include "core/app/scene/load_schedule.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/dressing/implicit_smoothing.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/multigrid/multigrid.h"
#include "core/numerics/patterns/delaunay.h"

namespace drape {

namespace {

/// Smooth noise with values about ±1, a sum of plane waves that depends on position and seed alone.
auto noise_of(double wavelength, int seed) {
  struct Wave {
    double kx, ky, phase;
  };
  std::array<Wave, 8> waves;
  Random random(static_cast<unsigned>(seed));
  for (Wave& w : waves) {
    const double angle = 2 * M_PI * random.unit(), k = 2 * M_PI / (wavelength * (0.75 + 0.5 * random.unit()));
    w = {k * std::cos(angle), k * std::sin(angle), 2 * M_PI * random.unit()};
  }
  return [waves](double x, double y) {
    double sum = 0;
    for (const Wave& w : waves) sum += std::sin(w.kx * x + w.ky * y + w.phase);
    return sum / std::sqrt(8.0);  // 8 is the number of waves
  };
}

Positions read_start(const Experiment& e, const Level& cloth, ConfigErrors& errors) {
  const std::optional<TriangleMesh> mesh = start_mesh(e, errors);
  if (!mesh) return cloth.rest.vertices;
  if (mesh->vertices.rows() == cloth.vertex_count() && same_entries(mesh->triangles, cloth.rest.triangles))
    return mesh->vertices;
  errors.push_back({e.location_of("start"),
                    "\"start\": " + e.parameters.start.file + " has other vertices or triangles than " +
                        (cloth.index == 0 ? "the coarsest level" : "the cloth's mesh") +
                        "; take a mesh like rest/l" + std::to_string(cloth.index) +
                        ".ply of a run's folder"});
  return cloth.rest.vertices;
}

/// The untransformed initial shape of every level: the rest shape, or that of the file, which finer levels
/// follow as states do, and coarser ones where they have its vertices. Edge midpoints would strain the cloth
/// where the refiner moves rest positions.
std::vector<Positions> start_shapes(const Experiment& e, const Hierarchy& hierarchy, ConfigErrors& errors) {
  std::vector<Positions> shapes;
  for (const Level& level : hierarchy.levels) shapes.push_back(level.rest.vertices);
  if (e.parameters.start.file.empty()) return shapes;
  const int cloth = hierarchy.cloth;
  shapes[cloth] = read_start(e, hierarchy.levels[cloth], errors);
  for (const Level& level : hierarchy.levels)
    if (level.index < cloth)
      shapes[level.index] = shapes[cloth](level.cloth_vertices, Eigen::all);
    else if (level.index > cloth)
      shapes[level.index] =
          hierarchy.prolong(shapes[level.index - 1], level.index - 1, level.index, hierarchy.linear);
  return shapes;
}

/// The start of a level: its shape, transformed, with noise that depends on the rest positions.
Positions make_start(const Positions& rest, const Positions& shape, const StartParameters& s,
                     double perturbation) {
  const auto noise = noise_of(s.perturbation_wavelength, s.seed);
  Positions x(rest.rows(), 3);
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const double across = perturbation > 0 ? perturbation * noise(rest(i, 0), rest(i, 1)) : 0;
    x.row(i) = s.transformed(shape.row(i), across).transpose();
  }
  return x;
}

/// The start of a level. Where so few vertices make panels cut through each other that the cloth's own mesh
/// keeps apart, the level below it starts smoothed, with pinned vertices in their places, by as little as
/// leaves nothing that intersects.
Positions uncrossed_start(const LevelModel& model, Positions start) {
  const auto is_free = [&](const Positions& x) {
    return std::ranges::all_of(model.contacts(),
                               [&](const auto& contact) { return contact->intersections(x).empty(); });
  };
  if (model.level().cloth_vertices.empty() || is_free(start)) return start;
  for (const double time : {0.03, 0.1, 0.3, 1.0, 2.0, 4.0})
    if (Positions x = smoothed(model.level().rest.triangles, start, time, model.fixed()); is_free(x))
      return x;
  return start;
}

/// The state in the file that the experiment's `reference` names: a mesh, or the reference.ply of a run's
/// folder. Empty without such a file, and, with an error appended, if it does not fit the finest level.
std::optional<Positions> read_reference(const Experiment& experiment, const Hierarchy& hierarchy,
                                        ConfigErrors& errors) {
  const std::string& named = experiment.parameters.reference.file;
  if (named.empty()) return std::nullopt;
  const auto refuse = [&](const std::string& why) {
    errors.push_back({experiment.location_of("reference"), "\"reference\": " + why});
    return std::nullopt;
  };
  std::filesystem::path file = named;
  if (std::filesystem::is_directory(file)) {
    file /= "reference.ply";
    if (!std::filesystem::is_regular_file(file))
      return refuse(named + " holds no reference.ply; name a mesh, as in " + named +
                    "/levels/newton_l3.ply, or run that experiment with a reference of its own");
  }
  try {
    const TriangleMesh mesh = read_mesh(file);
    const Level& finest = hierarchy.levels.back();
    if (mesh.vertices.rows() != finest.vertex_count())
      return refuse(file.string() + " has " + std::to_string(mesh.vertices.rows()) +
                    " vertices, but the finest level has " + std::to_string(finest.vertex_count()) +
                    "; take a state of that level");
    if (!same_entries(mesh.triangles, finest.rest.triangles))
      return refuse(file.string() + " has other triangles than the finest level; take a state of that level");
    return mesh.vertices;
  } catch (const std::exception& problem) {
    return refuse(problem.what());
  }
}

}  // namespace

std::unique_ptr<Scene> build_scene(const Experiment& e, ConfigErrors& errors, LargeMemory large,
                                   IntersectingStart intersecting) {
  const ExperimentParameters& p = e.parameters;
  const bool is_pattern = p.cloth.shape == "pattern";  // of which the mesh tells more than its outlines
  if (errors.empty())
    refuse_too_large(e, large, errors, is_pattern ? vertices_in_outlines(p.cloth) : std::nullopt);
  if (!errors.empty()) return nullptr;
  std::optional<TriangleMesh> cloth = checked_cloth(e, errors);
  if (cloth && is_pattern) refuse_too_large(e, large, errors, static_cast<double>(cloth->vertices.rows()));
  if (!cloth && !p.start.file.empty()) start_mesh(e, errors);
  if (!errors.empty()) return nullptr;

  std::unique_ptr<Scene> scene;
  try {
    Hierarchy hierarchy = Hierarchy::of(std::move(*cloth), *e.refiner, p.levels, p.hierarchy.coarsen);
    if (p.hierarchy.multigrid) hierarchy.coarsen_below(*e.refiner, Multigrid::small_mesh);
    scene = std::make_unique<Scene>(std::move(hierarchy));
  } catch (...) {
    errors.push_back({e.location_of("cloth"), message_in_flight()});
    return nullptr;
  }
  const Level& coarsest = scene->hierarchy.levels[0];
  check_selections(e, p, scene->hierarchy.levels, errors);
  const std::vector<Positions> shapes = start_shapes(e, scene->hierarchy, errors);
  if (!errors.empty()) return nullptr;
  scene->energies = e.energies;
  for (const Level& level : scene->hierarchy.levels)
    scene->placed.push_back(make_start(level.rest.vertices, shapes[level.index], p.start, 0));
  report(conflicts_of(p, scene->hierarchy.levels, scene->placed), e, scene->hierarchy.levels, errors);
  if (!errors.empty()) return nullptr;
  if (auto handles = handles_energy(p, coarsest, scene->placed))
    scene->energies.push_back({"handles", std::move(handles)});
  for (const Level& level : scene->hierarchy.levels) {
    std::vector<DirichletVertex> dirichlet =
        dirichlet_vertices(p, level, coarsest, scene->placed[level.index]);
    Positions start = make_start(level.rest.vertices, shapes[level.index], p.start, p.start.perturbation);
    for (const DirichletVertex& d : dirichlet) start.row(d.vertex) = d.target.transpose();
    for (const std::string& fault : check_coordinates(start))
      errors.push_back(
          {e.location_of("start"), "the start of level " + std::to_string(level.index) + ": " + fault});
    if (!errors.empty()) return nullptr;
    scene->starts.push_back(std::move(start));
    try {
      scene->models.push_back(std::make_shared<const LevelModel>(level, p.material, scene->energies,
                                                                 std::move(dirichlet), e.contacts));
    } catch (...) {
      errors.push_back({e.location_of("energies"), message_in_flight()});
      return nullptr;
    }
    if (intersecting == IntersectingStart::refused && !p.dress.is_asked()) {
      scene->starts.back() = uncrossed_start(*scene->models.back(), std::move(scene->starts.back()));
      refuse_intersecting_start(e, *scene->models.back(), scene->starts.back(), errors);
    }
    if (!errors.empty()) return nullptr;
  }
  scene->following = following_vertices(e, *scene, errors);
  if (!errors.empty()) return nullptr;
  if (p.dress.is_asked())
    scene->load_stepping = dress(e, *scene, errors);
  else if (!p.schedule.keys.empty())
    scene->load_stepping = load_stepping_of(e, *scene, errors);
  if (!errors.empty()) return nullptr;
  scene->reference = read_reference(e, scene->hierarchy, errors);
  return errors.empty() ? std::move(scene) : nullptr;
}

}  // namespace drape
