#include <algorithm>
#include <cmath>
#include <functional>

#include "core/app/scene/scene_summary.h"
#include "core/app/scene/vertex_search.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/solve/start_fault.h"

namespace drape {

namespace {

// What no fabric and no scene with one exceeds, by a wide margin: a warning has to be a mistake.
constexpr double smallest_cloth = 5e-3, largest_cloth = 50;     // diagonal [m]
constexpr double least_garment = 0.3, largest_garment = 3;      // longest extent of most garments [m]
constexpr double least_weight = 3e-3, largest_weight = 10;      // [kg/m²]
constexpr double thinnest = 1e-5, thickest = 0.02;              // [m]
constexpr double shortest_bending = 2e-4, longest_bending = 2;  // bending length [m]
constexpr double fewest_edges = 0.02, most_edges = 1000;        // bending length over an edge
constexpr double fewest_of_outline = 0.1;                       // the same of a file's pieces or a polygon
constexpr double least_height = 1e-6;                           // of a triangle over its longest edge
constexpr double least_edge = 1e-3;                             // over most edges
constexpr double largest_dhat = 1.5;                            // d̂ over an edge
constexpr double largest_obstacle = 100;                        // diagonal [m]
constexpr double largest_ratio = 50;                            // of that to the cloth's
constexpr double largest_stretch = 2;                           // of the start, or its inverse

/// Warns of the value at a key.
using Warn = std::function<void(const std::string& key, const std::string& message)>;

/// Whether a cloth's shape comes from another program or from a list of points.
bool is_drawn(const ClothParameters& cloth) { return cloth.shape == "file" || cloth.shape == "polygon"; }

/// The units in which the numbers of a cloth with this longest extent [m] would be those of a garment, each
/// with what to do; "" if there is none.
std::string other_units(const ClothParameters& cloth, double longest) {
  struct Unit {
    const char *name, *key;
    double metres;
    const char* conversion;
  };
  static constexpr Unit units[] = {{"centimetres", "cm", 1e-2, "divide every length by 100"},
                                   {"millimetres", "mm", 1e-3, "divide every length by 1000"},
                                   {"inches", "inch", 0.0254, "multiply every length by 0.0254"}};
  const bool has_unit = is_drawn(cloth);
  double own = 1;
  for (const Unit& unit : units)
    if (has_unit && cloth.unit == unit.key) own = unit.metres;
  std::string text;
  for (const Unit& unit : units) {
    const double length = longest / own * unit.metres;
    if (unit.metres == own || length < least_garment || length > largest_garment) continue;
    text += (text.empty() ? "if its lengths are in " : "; if in ") + std::string(unit.name) + ", " +
            (has_unit ? "write \"unit: " + std::string(unit.key) + "\"" : unit.conversion);
  }
  return text;
}

void check_size(const ExperimentParameters& p, const SceneSummary& s, const Warn& warn) {
  const double size = s.size.norm();
  if (size >= smallest_cloth && size <= largest_cloth) return;
  std::string remedy = p.cloth.shape == "pattern" ? "check \"units_in_meter\" in the pattern's file"
                       : size > largest_cloth     ? other_units(p.cloth, s.size.maxCoeff())
                                                  : "";
  if (remedy.empty())
    remedy = p.cloth.shape == "file" ? "choose the file's \"unit\" or \"scale\""
             : size > largest_cloth  ? "choose a smaller size"
                                     : "choose a larger size";
  warn("cloth", "the cloth is " + size_text(s.size) +
                    "; fabric is usually between 0.05 and 10 m wide, and lengths are in metres; " + remedy);
}

void check_material(const ExperimentParameters& p, const SceneSummary& s, const Warn& warn) {
  const double weight = p.material.area_density();
  if (weight < least_weight || weight > largest_weight)
    warn("material", "a square metre of the cloth has " + rounded_text(weight, 2) +
                         " kg (density × thickness); fabric usually has 0.02 to 2 kg; density is in "
                         "kg/m³, and thickness in metres: 0.3 mm is 3e-4");
  if (const double t = p.material.thickness; t < thinnest || t > thickest)
    warn("material",
         "the cloth is " + length_text(t) +
             " thick; fabric is usually 0.1 to 3 mm; \"thickness\" is in metres, also in a table of "
             "fabrics: 0.3 mm is 3e-4");
  if (!s.bending_length) return;
  const double length = *s.bending_length, edges = length / s.median_edge;
  const std::string on = " of level " + std::to_string(s.level);
  const std::string moduli = "\"bending_modulus\" (in Pa) and \"thickness\" (in metres, to the third power)";
  if (length < shortest_bending || length > longest_bending)
    warn("material", "weight bends this cloth over a length of " + length_text(length) +
                         "; the bending length of fabric is usually 5 to 100 mm; check " + moduli);
  else if (edges > most_edges)
    warn("material", "the bending length of " + length_text(length) + " is " + rounded_text(edges, 2) +
                         " edges" + on + "; 2 to 20 are usual; take fewer vertices or levels, or check " +
                         moduli);
  else if (edges < (is_drawn(p.cloth) ? fewest_of_outline : fewest_edges) && s.size.norm() <= largest_cloth)
    warn("cloth",
         "the bending length of " + length_text(length) + " is " + rounded_text(edges, 2) + " edges" + on +
             ", so no fold of the cloth can form; 2 to 20 are usual; take more vertices or "
             "levels, or check " +
             moduli + (is_drawn(p.cloth) ? "; \"edge_length\" in cloth meshes flat pieces anew" : ""));
}

/// Obstacles that the cloth will hardly meet, slide off, or that do not lie as they should.
void check_obstacles(const Experiment& e, const Scene& scene, const SceneSummary& s, const Warn& warn) {
  const auto moves = [](const ScheduleKey& key) {
    return key.section != "material" && key.section != "energies";
  };
  if (s.obstacles.empty() || scene.garment || std::ranges::any_of(e.parameters.schedule.keys, moves)) return;
  const ObstacleGap& nearest = s.nearest()->gap;
  if (const double length = s.size.maxCoeff(); nearest.gap > length)
    warn("start", "the cloth starts " + length_text(nearest.gap) + " from the nearest obstacle, " +
                      nearest.obstacle + ", farther than it is long (" + length_text(length) +
                      "); move one of them by \"translate\", or check \"unit\" and \"up\" of their "
                      "files");
  if (s.bending_length && s.nearest()->drop >= 0 && !s.is_centre_over && !scene.models[0]->is_held())
    warn("start", "the cloth's centre is over no obstacle, but " + length_text(s.nearest()->beside) +
                      " beside that of " + nearest.obstacle +
                      ": it will slide off, as nothing else holds it; move one of them by \"translate\"");
  for (const auto& [gap, size, drop, beside, over] : s.obstacles) {
    const double length = size.head<2>().maxCoeff(), height = size.z();
    // A plate lies as it should; what would not reach up to the cloth need not stand.
    if (height < 0.05 * length || length < 2 * height || drop < height || drop + height > 1.25 * length)
      continue;
    warn("obstacles", "the obstacle " + gap.obstacle + " is " + length_text(length) + " long and " +
                          length_text(height) + " high, and the cloth starts " + length_text(drop) +
                          " above it: does it lie on its side? Then add \"up: y\", or turn it by "
                          "\"rotate\"");
  }
}

void check_contact(const SceneSummary& s, const Warn& warn) {
  if (s.dhat > largest_dhat * s.median_edge)
    warn("contact", "the contact distance dhat of " + length_text(s.dhat) +
                        " is longer than most edges of level " + std::to_string(s.level) + " (" +
                        length_text(s.median_edge) +
                        "); a tenth to a half of an edge is usual; lower \"dhat\", or take fewer "
                        "vertices or levels");
  for (const auto& [gap, size, drop, beside, over] : s.obstacles)
    if (size.norm() > largest_obstacle && size.norm() > largest_ratio * s.size.norm())
      warn("obstacles", "the obstacle " + gap.obstacle + " is " + size_text(size) + " and the cloth " +
                            size_text(s.size) +
                            "; lengths are in metres: if its file is in millimetres or centimetres, "
                            "add \"unit: mm\" or \"unit: cm\"");
}

void check_membrane(const Experiment& e, const Warn& warn) {
  const auto is_membrane = [](const NamedEnergy& named) {
    return named.energy->role() == EnergyRole::membrane;
  };
  if (std::ranges::none_of(e.energies, is_membrane))
    warn("energies",
         "no energy resists stretching, so that the cloth may stretch without end; add neo_hookean");
}

void check_start(const Experiment& e, const SceneSummary& s, const Warn& warn) {
  if (!s.enclosing.empty())
    warn("start", "the cloth starts inside the obstacle " + s.enclosing +
                      "; if it should lie on it, move it by \"translate\"");
  const double stretch = s.start_stretch;
  if (stretch <= largest_stretch && stretch >= 1 / largest_stretch) return;
  const StartParameters& start = e.parameters.start;
  warn("start",
       "the start has " + rounded_text(stretch, 2) +
           " times the lengths of the rest shape, so the cloth begins strained; 1 is usual; " +
           (e.parameters.cloth.rest == "uv" ? "check \"uv_unit\", the unit of the texture coordinates"
            : start.file.empty()            ? "\"scale\" of a mesh file belongs to cloth, which scales the "
                                              "rest shape too"
                                            : "give the \"unit\" of the start's file, or its \"scale\""));
}

/// A pin or handle "nearest" to a point that lies far from the cloth's rest shape.
template <class Selections>
void check_nearest(const Experiment& e, const std::string& key, const Selections& selections,
                   const Level& coarsest, double edge, ConfigErrors& warnings) {
  const VertexSearch search(coarsest, coarsest, selections.size());
  for (std::size_t k = 0; k < selections.size(); ++k) {
    const VertexSelection& selection = selections[k];
    if (selection.region != "nearest") continue;
    const int v = search.selected(selection).front();
    const Eigen::Vector3d at = coarsest.rest.vertices.row(v);
    const double distance = (at - selection.point).norm();
    if (distance > 2 * edge)
      warnings.push_back({e.source.find(key)->items[k].where,
                          "the vertex nearest to \"point\" is " + length_text(distance) +
                              " away from it, at " + point_text(at) + " of the rest shape; points of " + key +
                              " are those of the cloth as it is made, before \"start\" places it"});
  }
}

/// Triangles whose stiffness hides that of the others: low ones, and tiny ones.
void check_triangles(const Level& cloth, const Warn& warn) {
  const TriangleMesh& mesh = cloth.rest;
  const double usual = median_rest_edge(cloth);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const auto corners = rest_corners(mesh, t);
    std::string fault;
    if (relative_height(corners) < least_height) fault = "is lower than a millionth of its longest edge";
    for (int k = 0; k < 3 && fault.empty(); ++k)
      if (const double edge = (corners.col(k) - corners.col((k + 1) % 3)).norm(); edge < least_edge * usual)
        fault = "has an edge of " + length_text(edge) + " at " + point_text(corners.col(k)) +
                ", and most have " + length_text(usual);
    if (!fault.empty())
      return warn("cloth", "triangle " + std::to_string(t) + " (counted from 0) " + fault +
                               ", so that solvers may not reach an equilibrium; move its vertices apart, or "
                               "mesh the cloth anew there");
  }
}

/// Panels of a file that nothing joins.
void check_joined(const Experiment& e, const Level& cloth, const Warn& warn) {
  if (const std::string unwelded = unwelded_fault(e, cloth); !unwelded.empty()) warn("cloth", unwelded);
  const int lines = e.parameters.cloth.shape == "file" ? line_elements_in(e.parameters.cloth.file) : 0;
  if (lines > 0)
    warn("cloth", std::to_string(lines) + (lines == 1 ? " line" : " lines") +
                      " between vertices (`l` in an OBJ file, `edge` in a PLY) " +
                      (lines == 1 ? "is" : "are") +
                      " ignored: drape sews nothing; to join panels, have "
                      "them share the vertices of the seam");
}

}  // namespace

ConfigErrors plausibility_warnings(const Experiment& e, const Scene& scene, const SceneSummary& s) {
  ConfigErrors all;
  const Warn warn = [&](const std::string& key, const std::string& message) {
    all.push_back({e.location_of(key), message});
  };
  check_size(e.parameters, s, warn);
  const double coarse_edge = std::ldexp(s.median_edge, s.level);
  check_triangles(scene.hierarchy.levels[scene.hierarchy.cloth], warn);
  check_joined(e, scene.hierarchy.levels[scene.hierarchy.cloth], warn);
  check_material(e.parameters, s, warn);
  check_membrane(e, warn);
  for (ConfigError& warning : unread_measures(e, s.median_edge)) all.push_back(std::move(warning));
  check_nearest(e, "pins", e.parameters.pins, scene.hierarchy.levels[0], coarse_edge, all);
  check_nearest(e, "handles", e.parameters.handles, scene.hierarchy.levels[0], coarse_edge, all);
  if (scene.garment)  // whose seams start long
    all.insert(all.end(), scene.garment->warnings.begin(), scene.garment->warnings.end());
  else
    check_start(e, s, warn);
  check_contact(s, warn);
  check_obstacles(e, scene, s, warn);
  return all;
}

void refuse_infinite_energies(const Experiment& e, const Scene& scene, ConfigErrors& errors) {
  for (std::size_t l = 0; l < scene.starts.size(); ++l) {
    const LevelModel& model = *scene.model(static_cast<int>(l));
    Positions gradient;
    const double energy = model.energy_gradient(scene.starts[l], gradient);
    if (!std::isfinite(energy) || !gradient.allFinite())
      errors.push_back({e.location_of("start"),
                        "energy or forces at the start of level " + std::to_string(l) + " are not finite: " +
                            fault_at_start(PlainObjective(model), scene.starts[l], gradient)});
  }
}

}  // namespace drape
