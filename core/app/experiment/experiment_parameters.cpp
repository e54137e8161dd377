#include "core/app/experiment/experiment_parameters.h"

#include "core/kernel/plugin/placement.h"
#include "core/numerics/contact/contact_parameters.h"

namespace drape {

namespace {

ParameterHandle coordinate(ParameterHandle p) {
  return p.unit("m").between(-bounds::largest_coordinate, bounds::largest_coordinate);
}
/// The width, height or radius of a cloth.
ParameterHandle extent(ParameterHandle p) { return p.unit("m").between(1e-6, bounds::largest_length); }
ParameterHandle angle(ParameterHandle p) {
  return p.unit("degree").between(-bounds::largest_angle, bounds::largest_angle);
}
/// A number that counts from 0.
ParameterHandle natural(ParameterHandle p, double most = bounds::largest_int) { return p.between(0, most); }

}  // namespace

void LoopParameters::declare(Declaration<LoopParameters>& d) {
  d.add("points", &LoopParameters::points)
      .unit("m")
      .between(-bounds::largest_length, bounds::largest_length)
      .description("x0, y0, x1, y1, … around the outline")
      .required();
}

void MaterialParameters::declare(Declaration<MaterialParameters>& d) {
  declare_material(d);
  d.add("fabric", &MaterialParameters::fabric)
      .description(
          "a fabric whose figures stand for the keys that are not written here: a name (`drape fabric` lists "
          "them), or {file: fabrics.csv, row: NAME}");
  d.add("from_fabric", &MaterialParameters::from_fabric)
      .description(
          "the `fabric` that gave numbers of this material, which drape writes to the config of a run, where "
          "all of them stand; a record, from which nothing is taken");
}

void GrainRegionParameters::declare(Declaration<GrainRegionParameters>& d) {
  coordinate(d.add("lower", &GrainRegionParameters::lower))
      .required()
      .description("lower corner of a box of the rest shape; triangles belong to it by their centroids");
  coordinate(d.add("upper", &GrainRegionParameters::upper)).required().description("upper corner of the box");
  angle(d.add("grain", &GrainRegionParameters::grain))
      .required()
      .description("direction of warp there, as `cloth.grain`");
}

void ClothParameters::declare(Declaration<ClothParameters>& d) {
  d.add("shape", &ClothParameters::shape)
      .choices({"square", "rectangle", "disc", "polygon", "file"})
      .description(
          "flat pattern in z = 0 with a corner (of a disc, the centre) at the origin, or a mesh file");
  extent(d.add("side", &ClothParameters::side))
      .only_with("shape", {"square"})
      .description("side of a square");
  extent(d.add("size", &ClothParameters::size))
      .only_with("shape", {"rectangle"})
      .description("width and height of a rectangle");
  extent(d.add("radius", &ClothParameters::radius))
      .only_with("shape", {"disc"})
      .description("radius of a disc");
  d.add_sections("loops", &ClothParameters::loops)
      .only_with("shape", {"polygon"})
      .description("outline of a polygon, then its holes");
  d.add("file", &ClothParameters::file)
      .path()
      .only_with("shape", {"file"})
      .description("mesh of the rest shape (OBJ, OFF, PLY or STL), relative to this file");
  declare_file_coordinates(d);
  d.declared("unit")
      .only_with("shape", {"file", "polygon"})
      .description("unit of the file's coordinates, or of a polygon's points");
  d.declared("up").only_with("shape", {"file"});
  declare_scale(d)
      .only_with("shape", {"file"})
      .description("scale factor on the file's mesh, and so on the rest shape, applied before `rotate`");
  declare_rotate(d)
      .only_with("shape", {"file"})
      .description(
          "rotation of the file's mesh about the x, then y, then z axis; regions of pins count from the "
          "result");
  d.add("triangulation", &ClothParameters::triangulation)
      .choices({"one_way", "criss_cross", "equilateral", "random"})
      .only_with("shape", {"square", "rectangle"})
      .description("triangulation of a square or rectangle; discs and polygons are Delaunay meshes");
  d.add("vertices", &ClothParameters::vertices)
      .between(3, bounds::most_vertices)
      .only_with("shape", {"square", "rectangle", "disc", "polygon"})
      .description("approximate number of vertices of the coarsest level; not beside `columns` and `rows`");
  natural(d.add("columns", &ClothParameters::columns), bounds::most_vertices)
      .only_with("shape", {"square", "rectangle"})
      .description("number of vertices along the width of a grid; 0 derives it from `vertices`");
  natural(d.add("rows", &ClothParameters::rows), bounds::most_vertices)
      .only_with("shape", {"square", "rectangle"})
      .description("number of vertices along the height of a grid; 0 derives it from `vertices`");
  natural(d.add("seed", &ClothParameters::seed)).description("seed of a random triangulation");
  angle(d.add("grain", &ClothParameters::grain))
      .description(
          "direction of warp on the rest shape, from `grain_along` counter-clockwise seen from the cloth's "
          "front; null: that of the file's faces, or along x, neither exported nor drawn");
  d.add_choice("grain_along", &ClothParameters::grain_along,
               {{"x", GrainAxis::x}, {"u", GrainAxis::u}, {"file", GrainAxis::file}})
      .only_with("shape", {"file"})
      .description(
          "what `grain` counts from: the x axis, projected into each triangle, the texture coordinate u of "
          "the file, where that is the pattern, or the faces' `warp_x`, `warp_y`, `warp_z` of a PLY file");
  d.add_sections("grain_regions", &ClothParameters::grain_regions)
      .description("parts of the cloth that were cut at another angle; later ones take precedence");
}

void StartParameters::declare(Declaration<StartParameters>& d) {
  d.add("file", &StartParameters::file)
      .path()
      .description(
          "mesh with the coarsest level's triangles that replaces the rest shape as start; finer levels "
          "split it at edge midpoints");
  declare_file_coordinates(d);
  d.declared("unit").description("unit of the start's file; null: that of the cloth's file");
  d.declared("up").description("axis of the start's file that points up; null: that of the cloth's file");
  d.add("scale", &StartParameters::scale)
      .between(-bounds::largest_scale, bounds::largest_scale)
      .description("scale factors along x, y, z, applied first");
  declare_placement(d);
  d.add("perturbation", &StartParameters::perturbation)
      .unit("m")
      .between(0, bounds::largest_length)
      .description(
          "amplitude of smooth noise along z, added after `scale` and before `rotate`, so normal to a flat "
          "pattern; a function of the rest shape's x and y, equal on every level; pinned vertices have none");
  d.add("perturbation_wavelength", &StartParameters::perturbation_wavelength)
      .unit("m")
      .between(bounds::smallest_length, bounds::largest_length)
      .description("wavelength of the noise");
  natural(d.add("seed", &StartParameters::seed)).description("seed of the noise");
}

namespace {

/// The parameters that pins and handles share.
template <class Condition>
void declare_selection(Declaration<Condition>& d) {
  const auto member = [](auto VertexSelection::*m) {
    return static_cast<std::decay_t<decltype(std::declval<Condition>().*m)> Condition::*>(m);
  };
  d.add("region", member(&VertexSelection::region))
      .choices({"nearest", "ball", "box", "border", "vertices"})
      .description(
          "selects vertices by their rest positions: the coarsest level's vertex nearest to `point`, all "
          "within `radius` of `point`, all in a box, the boundary, or coarsest-level indices");
  coordinate(d.add("point", member(&VertexSelection::point)))
      .only_with("region", {"nearest", "ball"})
      .description("point of `nearest`, centre of `ball`, in the rest shape");
  d.add("radius", member(&VertexSelection::radius))
      .unit("m")
      .between(0, bounds::largest_coordinate)
      .only_with("region", {"ball"})
      .description("radius of `ball`");
  coordinate(d.add("lower", member(&VertexSelection::lower)))
      .only_with("region", {"box"})
      .description("lower corner of `box`, in the rest shape");
  coordinate(d.add("upper", member(&VertexSelection::upper)))
      .only_with("region", {"box"})
      .description("upper corner of `box`, in the rest shape");
  natural(d.add("vertices", member(&VertexSelection::vertices)))
      .only_with("region", {"vertices"})
      .description("indices on the coarsest level, from 0");
  coordinate(d.add("translate", member(&VertexSelection::translate)))
      .description(
          "translation from the rest position to the target, applied after `rotate`; without both, the "
          "target is the position at the start, without its noise");
  angle(d.add("rotate", member(&VertexSelection::rotate)))
      .description("rotation of the rest position about x, then y, then z through `centre`");
  coordinate(d.add("centre", member(&VertexSelection::centre)))
      .description("centre of `rotate`, in the rest shape");
}

}  // namespace

void FollowParameters::declare(Declaration<FollowParameters>& d) {
  d.add("obstacle", &FollowParameters::obstacle)
      .description("name of the obstacle, or its index from 0; without one the pin follows none");
  natural(d.add("vertices", &FollowParameters::vertices))
      .description(
          "vertices of the obstacle, from 0 in the order of its file, at whose triangles the pin may be "
          "attached; all without any");
}

void PinParameters::declare(Declaration<PinParameters>& d) {
  declare_selection(d);
  d.add_section("follow", &PinParameters::follow)
      .shorthand("obstacle")
      .description(
          "obstacle that the targets move with: each keeps its place in the frame of the obstacle's triangle "
          "that is nearest to it at the start");
}

void HandleParameters::declare(Declaration<HandleParameters>& d) {
  declare_selection(d);
  d.add("stiffness", &HandleParameters::stiffness)
      .unit("1/s²")
      .between(0, bounds::largest_modulus)
      .description(
          "κ_B of the penalty κ_B/2 m ‖x − x̃‖², m the mass on the coarsest level (a departure); by default "
          "the numerical value of the membrane modulus")
      .source("supplement, section 4");
}

void ReferenceParameters::declare(Declaration<ReferenceParameters>& d) {
  d.add("method", &ReferenceParameters::method)
      .description(
          "method whose finest state is the reference; `lowest` chooses the converged finest state of lowest "
          "energy");
  d.add("force_tolerance", &ReferenceParameters::force_tolerance)
      .between(0, 1e12)
      .description("force tolerance to which the reference is solved after all methods; 0 takes it as it is");
  d.add("file", &ReferenceParameters::file)
      .path()
      .description(
          "in place of `method`: a mesh of the finest level, or the folder of a run with a reference");
}

void ExperimentParameters::declare(Declaration<ExperimentParameters>& d) {
  d.add("name", &ExperimentParameters::name)
      .required()
      .description("names the results folder and the report");
  d.add("description", &ExperimentParameters::description).description("one sentence for the report");
  d.add_section("cloth", &ExperimentParameters::cloth).description("the coarsest level");
  d.add("levels", &ExperimentParameters::levels)
      .between(1, 10)
      .description("number of levels; each splits every triangle of the last into four");
  d.add_section("material", &ExperimentParameters::material).description("material of the cloth");
  d.add_section("start", &ExperimentParameters::start)
      .description("where the cloth begins: the rest shape or a file, transformed");
  d.add_sections("pins", &ExperimentParameters::pins)
      .description("Dirichlet boundary conditions: vertices at prescribed positions (hard positions)");
  d.add_sections("handles", &ExperimentParameters::handles)
      .description("penalty boundary conditions: vertices on springs to their targets (soft positions)");
  d.add_section("schedule", &ExperimentParameters::schedule)
      .description(
          "load stepping on a level that begins from `start`; later levels are solved under the "
          "final loads");
  d.add("energies", &ExperimentParameters::energies)
      .plugin("energy")
      .required()
      .description("energies; their sum is minimised");
  d.add("refiner", &ExperimentParameters::refiner)
      .plugin("refiner")
      .description("refinement scheme; loop by default");
  d.add("contact", &ExperimentParameters::contact)
      .plugin("contact")
      .or_list()
      .description("contact model or a list of them; without the key, contact is not modelled");
  d.add("obstacles", &ExperimentParameters::obstacles)
      .description(
          "what the cloth collides with; each goes to the contact model that takes its keys, which `drape "
          "describe` of the model lists");
  declare_friction(d);
  d.add_section("newton", &ExperimentParameters::newton)
      .description("Newton parameters of every method; a method's own take precedence");
  d.add("methods", &ExperimentParameters::methods)
      .required()
      .description("map from method names to solvers; `type` defaults to the name");
  d.add("metrics", &ExperimentParameters::metrics)
      .plugin("metric")
      .description("metrics to evaluate; by default all that need no parameter");
  d.add_section("reference", &ExperimentParameters::reference)
      .shorthand("method")
      .description(
          "state that errors are measured against, beside each method's own finest one; the name of a method "
          "or `lowest` is a shorthand");
  d.add("snapshots", &ExperimentParameters::snapshots)
      .between(0, 1000)
      .description("largest number of intermediate states per level to record and to measure errors of");
  d.add_choice(
       "check_intersections", &ExperimentParameters::check_intersections,
       {{"every_level", IntersectionCheck::every_level}, {"every_step", IntersectionCheck::every_step}})
      .description("when to count intersections, by exact predicates between meshes");
}

const Schema& experiment_schema() {
  static const Schema schema = schema_of<ExperimentParameters>();
  return schema;
}

}  // namespace drape
