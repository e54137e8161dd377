#include "core/app/experiment/cloth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/app/experiment/sewn_cloth.h"
#include "core/app/files/machine.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/bounds.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/grain.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh/unjoined_borders.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/delaunay.h"

namespace drape {

namespace {

Eigen::Vector2d size_of(const ClothParameters& c) {
  return c.shape == "square" ? Eigen::Vector2d(c.side, c.side) : c.size;
}

TriangleMesh read_cloth(const ClothParameters& c) {
  TriangleMesh mesh = read_mesh(c.file);
  Positions none, &warp = c.rest == "uv" ? none : mesh.warp;  // that of flat pieces is in their plane
  c.convert(mesh.vertices);
  c.convert(warp);
  mesh.vertices *= c.scale;
  if (!c.rotate.isZero(0))
    for (Positions* rows : {&mesh.vertices, &warp}) *rows *= rotation_matrix(c.rotate).transpose();
  join_vertices(mesh, c.join);
  sew(mesh, c);
  return mesh;
}

/// Gives the cloth its warp; returns the faults of its grain.
std::vector<std::string> cut(TriangleMesh& cloth, const ClothParameters& c) {
  if (cloth.warp.rows() > 0) cloth.warp = projected_warp(cloth.warp, cloth);
  const bool along_file = c.grain_along != GrainAxis::x;  // was asked for, so that `grain` is 0 if it is null
  const bool everywhere = c.grain || along_file;
  if (!everywhere && c.grain_regions.empty()) return {};
  std::vector<char> asked(cloth.triangles.rows(), everywhere);  // where grain is counted from the axis
  Eigen::VectorXd degrees = Eigen::VectorXd::Constant(cloth.triangles.rows(), c.grain.value_or(0));
  constexpr double rounding = 1e-12;  // [m]; a flat pattern that was rotated is flat but for round-off
  Eigen::Array3Xd centroids(3, cloth.triangles.rows());
  for (Eigen::Index t = 0; t < centroids.cols(); ++t)
    centroids.col(t) = cloth.vertices(cloth.triangles.row(t), Eigen::all).colwise().mean().transpose();
  constexpr std::size_t most_regions = 1000;  // each looks at every triangle
  if (c.grain_regions.size() > most_regions)
    return {"\"grain_regions\" has " + std::to_string(c.grain_regions.size()) + " entries, of at most " +
            std::to_string(most_regions) + "; a file's faces may have their own warp_x, warp_y and warp_z"};
  for (std::size_t i = 0; i < c.grain_regions.size(); ++i) {
    const GrainRegionParameters& region = c.grain_regions[i];
    bool any = false;
    for (Eigen::Index t = 0; t < degrees.size(); ++t)
      if ((centroids.col(t) >= region.lower.array() - rounding).all() &&
          (centroids.col(t) <= region.upper.array() + rounding).all())
        degrees[t] = region.grain, asked[t] = any = true;
    if (!any)
      return {"\"grain_regions\": entry " + std::to_string(i) + " has no triangle's centroid; widen its box"};
  }
  std::vector<std::string> faults = grain_faults(cloth, c.grain_along, asked);
  if (!faults.empty()) return faults;
  const Positions counted = cut_directions(cloth, c.grain_along, degrees);
  Positions warp = everywhere ? counted : warp_directions(cloth);
  for (Eigen::Index t = 0; t < warp.rows(); ++t)
    if (asked[t]) warp.row(t) = counted.row(t);
  cloth.warp = warp;
  return faults;
}

std::string about(double number) { return number < 1e6 ? fixed_text(number, 0) : general_text(number, 2); }

/// A polygon's outline and holes, in its unit.
std::vector<Polygon> loops_of(const ClothParameters& c) {
  std::vector<Polygon> loops;
  for (std::size_t k = 0; k < c.loops.size(); ++k) {
    const auto& p = c.loops[k].points;
    if (p.size() % 2 != 0)
      throw std::runtime_error("loop " + std::to_string(k) +
                               " has an odd number of coordinates; give x and y of each point");
    auto& loop = loops.emplace_back();
    for (std::size_t i = 0; i + 1 < p.size(); i += 2) loop.emplace_back(p[i], p[i + 1]);
  }
  if (loops.empty()) throw std::runtime_error("\"shape: polygon\" needs \"loops\", its outline and holes");
  return loops;
}

/// Area and border of a disc or a polygon.
OutlineSize outline_of(const ClothParameters& c) {
  if (c.shape == "disc") return {M_PI * c.radius * c.radius, 2 * M_PI * c.radius};
  Positions metre = Eigen::RowVector3d::UnitX();
  c.convert(metre);
  OutlineSize outline;
  for (const Polygon& loop : loops_of(c)) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      outline.border += metre(0, 0) * (loop[(i + 1) % loop.size()] - loop[i]).norm();
    const double area = metre(0, 0) * metre(0, 0) * std::abs(area_of(loop));
    outline.area = std::abs(outline.area - area);  // less that of holes
  }
  return outline;
}

/// The number of vertices of a generated cloth but a grid.
int vertices_of(const ClothParameters& c) {
  return c.edge_length ? vertices_within(outline_of(c), *c.edge_length) : c.vertex_count();
}

double vertices_of_file(const ClothParameters& c) {
  if (c.shape == "pattern") {
    const double about = vertices_in_outlines(c).value();
    ConfigErrors errors;
    return estimated_memory(about) > machine_memory()
               ? about
               : static_cast<double>(cloth_of_pattern(c, errors).value().vertices.rows());
  }
  const TriangleMesh mesh = read_cloth(c);
  return c.edge_length ? vertices_within(OutlineSize::of(mesh), *c.edge_length)
                       : c.vertices.value_or(static_cast<int>(mesh.vertices.rows()));
}

/// A file's mesh, or, where that is asked for, a mesh within its outline. A faulty one stays as it is.
TriangleMesh cloth_of_file(const ClothParameters& c) {
  if (c.file.empty()) throw std::runtime_error("\"shape: file\" needs \"file\", the mesh to read");
  TriangleMesh mesh = read_cloth(c);
  if (!c.is_meshed_anew() || !check_mesh(mesh).empty()) return mesh;
  const OutlineSize outline = OutlineSize::of(mesh);
  if (c.edge_length) vertices_within(outline, *c.edge_length);
  const double edge_length =
      c.edge_length.value_or(even_spacing(outline.area, outline.border, c.vertex_count()));
  return with_name(c.file, [&] { return mesh_outline(mesh, edge_length, c.seed); });
}

TriangleMesh make_cloth(const ClothParameters& c) {
  if (c.shape == "file") return cloth_of_file(c);
  if (c.shape == "disc") return disc(c.radius, vertices_of(c));
  if (c.shape == "polygon") try {
      TriangleMesh mesh = delaunay_polygon(loops_of(c), vertices_of(c), c.seed);
      c.convert(mesh.vertices);
      return mesh;
    } catch (const ImpossibleCount& fault) {
      if (!c.edge_length) throw;
      throw std::runtime_error("\"edge_length\" of " + three_digits(*c.edge_length) + " m: " + fault.what());
    }
  if (c.triangulation == "random") return random_triangulation(size_of(c), c.vertex_count(), c.seed);
  const Eigen::Vector2i counts = grid_counts(c);
  if (c.triangulation == "equilateral") return equilateral(size_of(c), counts.x(), counts.y());
  return grid(size_of(c), counts.x(), counts.y(),
              c.triangulation == "one_way" ? Diagonals::one_way : Diagonals::criss_cross);
}

/// A hinge's Hessian takes 16 blocks and a vertex has 3 hinges: their numbers must fit an int.
constexpr double max_finest_vertices = 4e7;
/// A grid is refused if its number of vertices differs from the requested one by more than this factor.
constexpr double max_vertex_ratio = 2;

// Peak memory is 0.1 GB for the program and then grows as n log₂ n, as factors of plane meshes do. The
// constant is that of the cube with a factor in double precision, which any solve may fall back on. The runs
// in benchmarks/results/table1.json (peak_memory_bytes) and scale.json (peak_bytes) take 500 to 1300 bytes.
constexpr double program = 1e8, bytes_each = 2000;

std::string levels_text(std::ptrdiff_t count) {
  return std::to_string(count) + (count == 1 ? " level" : " levels");
}

bool is_of_file(const ClothParameters& c) { return c.shape == "file" || c.shape == "pattern"; }

bool is_grid(const ClothParameters& c) {
  return (c.shape == "square" || c.shape == "rectangle") && c.triangulation != "random";
}

}  // namespace

int vertices_within(const OutlineSize& outline, double edge_length) {
  const double count = outline.vertices(edge_length);
  if (!(count <= bounds::most_vertices))  // nor NaN
    throw std::runtime_error(
        "\"edge_length\" of " + three_digits(edge_length) + " m would give about " + about(count) +
        " vertices within " + three_digits(outline.area) + " m²; a coarsest level has at most " +
        about(bounds::most_vertices) + ": take " +
        three_digits(1.01 * even_spacing(outline.area, outline.border, bounds::most_vertices)) +
        " m or more, if the unit is right");
  return static_cast<int>(std::lround(std::max(count, 3.0)));
}

Positions AsReadParameters::in_file(Positions x) const {
  if (!rotate.isZero(0)) x *= rotation_matrix(rotate);
  x /= scale;
  restore(x);
  return x;
}

std::optional<TriangleMesh> checked_cloth(const Experiment& e, ConfigErrors& errors) {
  const ClothParameters& c = e.parameters.cloth;
  try {
    std::optional<TriangleMesh> cloth = c.shape == "pattern" ? cloth_of_pattern(c, errors) : make_cloth(c);
    if (!cloth) return std::nullopt;
    std::vector<std::string> faults = check_mesh(*cloth);
    if (faults.empty() && cloth->sewing) faults = check_pieces(*cloth);
    if (faults.empty()) faults = cut(*cloth, c);
    const bool placed = c.shape == "pattern";
    if (placed && !faults.empty())
      if (const ConfigErrors tucks = tucks_in(c); !tucks.empty()) {
        errors.insert(errors.end(), tucks.begin(), tucks.end());
        return std::nullopt;
      }
    for (const std::string& fault : faults)
      errors.push_back({e.location_of("cloth"),
                        (c.file.empty() ? "" : c.file + ": ") + (placed ? "as the panels are placed, " : "") +
                            fault +
                            (placed ? "; where two panels lie face to face, seams twist the cloth unless one "
                                      "is turned over, as by \"rotation: [0, 180, 0]\""
                                    : "")});
    if (faults.empty()) return cloth;
  } catch (const std::exception& error) {
    errors.push_back({e.location_of("cloth"), reason_of(error)});
  }
  return std::nullopt;
}

std::optional<TriangleMesh> start_mesh(const Experiment& e, ConfigErrors& errors) {
  const std::string& file = e.parameters.start.file;
  try {
    TriangleMesh mesh = read_mesh(file);
    e.parameters.start.file_coordinates(e.parameters.cloth).convert(mesh.vertices);
    const std::vector<std::string> faults = check_coordinates(mesh.vertices);
    for (const std::string& fault : faults) errors.push_back({e.location_of("start"), file + ": " + fault});
    if (faults.empty()) return mesh;
  } catch (const std::exception& problem) {
    errors.push_back({e.location_of("start"), reason_of(problem)});
  }
  return std::nullopt;
}

Eigen::Vector2i grid_counts(const ClothParameters& c) {
  const Eigen::Vector2d size = size_of(c);
  const int vertices = c.vertex_count();
  const double density = std::sqrt(vertices / size.prod());
  const auto along = [&](int set, double length) {
    return set > 0 ? set : std::max(2.0, std::round(density * length));
  };
  Eigen::Vector2d counts(along(c.columns, size.x()), along(c.rows, size.y()));
  if (c.triangulation == "equilateral")
    counts = equilateral_counts(size, vertices, c.columns, c.rows).cast<double>();
  const double all = counts.prod();
  const std::string made = about(counts.x()) + " × " + about(counts.y());
  if (c.columns == 0 && c.rows == 0 &&
      (all > max_vertex_ratio * vertices || max_vertex_ratio * all < vertices))
    throw std::runtime_error(c.shape + ": about " + std::to_string(vertices) +
                             " vertices are asked for, but its grid of even cells has " + made + " = " +
                             about(all) + "; set columns and rows, or ask for another number of vertices");
  if (all > bounds::most_vertices)
    throw std::runtime_error(c.shape + ": a grid of " + made +
                             " vertices is too large; a coarsest level has at most " +
                             about(bounds::most_vertices));
  return counts.cast<int>();
}

std::vector<double> estimated_vertices(const ExperimentParameters& p, std::optional<double> of_pattern) {
  std::vector<double> vertices;
  try {
    const bool grid = is_grid(p.cloth);
    const Eigen::Vector2i counts = grid ? grid_counts(p.cloth) : Eigen::Vector2i(0, 0);
    const double coarsest = of_pattern            ? *of_pattern
                            : is_of_file(p.cloth) ? vertices_of_file(p.cloth)
                                                  : vertices_of(p.cloth);
    for (int l = p.hierarchy.coarsen; l > 0; --l) vertices.push_back(coarsest / std::pow(4.0, l));
    for (int l = 0; l < p.levels; ++l) {
      const double cells = std::pow(2.0, l);  // of the level, along a cell of the coarsest one
      vertices.push_back(grid ? (cells * (counts.x() - 1) + 1) * (cells * (counts.y() - 1) + 1)
                              : cells * cells * coarsest);
    }
  } catch (const std::exception&) {
    vertices.clear();
  }
  return vertices;
}

double estimated_memory(double vertices) {
  return program + bytes_each * vertices * std::log2(std::max(vertices, 2.0));
}

std::string memory_text(double bytes) { return fixed_text(bytes / 1e9, bytes < 9.95e9 ? 1 : 0) + " GB"; }

void refuse_too_large(const Experiment& e, LargeMemory large, ConfigErrors& errors,
                      std::optional<double> of_pattern) {
  const std::vector<double> vertices = estimated_vertices(e.parameters, of_pattern);
  if (vertices.empty()) return;
  const double machine = machine_memory();
  const auto can_be_counted = [&](double n) { return n <= max_finest_vertices; };
  const auto fits = [&](double n) {
    return can_be_counted(n) && (large == LargeMemory::allowed || estimated_memory(n) <= machine);
  };
  const auto fitting = std::find_if_not(vertices.begin(), vertices.end(), fits) - vertices.begin();
  if (fitting == std::ssize(vertices)) return;
  const auto counted = std::find_if_not(vertices.begin(), vertices.end(), can_be_counted) - vertices.begin();
  const double finest = vertices.back();
  std::string why =
      "level " + std::to_string(vertices.size() - 1) + " would have about " + about(finest) + " vertices";
  if (finest > max_finest_vertices)
    why += ", more than the " + about(max_finest_vertices) + " that can be counted";
  else
    why += " and take about " + memory_text(estimated_memory(finest)) +
           " of memory, where this machine has " + memory_text(machine);
  why += fitting > 0 ? "; take at most " + levels_text(fitting) : "; ask for fewer vertices";
  if (can_be_counted(finest))
    why += ", or allow it with --allow-memory";
  else if (fitting < counted)
    why += (fitting > 0 ? ", for which this machine's memory of " + memory_text(machine) + " suffices" : "") +
           ", or up to " + levels_text(counted) + " with --allow-memory";
  errors.push_back({e.location_of(e.source.find("levels") ? "levels" : "cloth"), why});
}

}  // namespace drape
