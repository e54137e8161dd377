#include "core/app/experiment/experiment_parameters.h"

#include "core/app/experiment/material_parameters.h"
#include "core/kernel/plugin/parameters.h"
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

/// The parameters that pins and handles share.
template <class Condition>
void declare_selection(Declaration<Condition>& d) {
  d.add("region", &VertexSelection::region,
        "selects vertices by their rest positions: the coarsest level's nearest to `point`, a ball, a box, "
        "the boundary, indices, a piece, the seams of flat pieces, or a pattern's edges by their label")
      .choices({"nearest", "ball", "box", "border", "vertices", "piece", "seam", "label"});
  coordinate(
      d.add("point", &VertexSelection::point, "point of `nearest`, centre of `ball`, in the rest shape"))
      .only_with("region", {"nearest", "ball"});
  d.add("radius", &VertexSelection::radius, "radius of `ball`")
      .unit("m")
      .between(0, bounds::largest_coordinate)
      .only_with("region", {"ball"});
  coordinate(d.add("lower", &VertexSelection::lower, "lower corner of `box`, in the rest shape"))
      .only_with("region", {"box"});
  coordinate(d.add("upper", &VertexSelection::upper, "upper corner of `box`, in the rest shape"))
      .only_with("region", {"box"});
  natural(d.add("vertices", &VertexSelection::vertices,
                "indices of the cloth's own mesh, from 0; on levels that `hierarchy` puts below it, those "
                "that stand for them"))
      .only_with("region", {"vertices"});
  d.add("piece", &VertexSelection::piece,
        "name of a piece, a group or material of the cloth's OBJ file; with `border` or `seam`, only those "
        "of that piece")
      .only_with("region", {"piece", "border", "seam"});
  d.add("label", &VertexSelection::label, "label of edges of the cloth's sewing pattern")
      .only_with("region", {"label"});
  natural(d.add("label_edges", &VertexSelection::label_edges,
                "written by drape to a run's config, whose cloth is no pattern: the ends of the label's "
                "edges on the coarsest level, two by two"))
      .only_with("region", {"label"});
  coordinate(d.add("translate", &VertexSelection::translate,
                   "translation from the rest position to the target, applied after `rotate`; without both, "
                   "the target is the position at the start, without its noise"));
  angle(d.add("rotate", &VertexSelection::rotate,
              "rotation of the rest position about x, then y, then z through `centre`"));
  coordinate(d.add("centre", &VertexSelection::centre, "centre of `rotate`, in the rest shape"))
      .only_with("rotate");
}

}  // namespace

void LoopParameters::declare(Declaration<LoopParameters>& d) {
  d.add("points", &LoopParameters::points, "x0, y0, x1, y1, … around the outline")
      .unit("m")
      .between(-bounds::largest_length, bounds::largest_length)
      .required();
}

void MaterialParameters::declare(Declaration<MaterialParameters>& d) {
  declare_material(d);
  d.add("fabric", &MaterialParameters::fabric,
        "a fabric whose figures stand for the keys that are not written here: a name (`drape fabric` lists "
        "them), or {file: fabrics.csv, row: NAME}");
  d.add("from_fabric", &MaterialParameters::from_fabric,
        "written by drape to a run's config: the `fabric` that gave numbers of this material, which all "
        "stand there");
}

void GrainRegionParameters::declare(Declaration<GrainRegionParameters>& d) {
  coordinate(d.add("lower", &GrainRegionParameters::lower,
                   "lower corner of a box of the rest shape; triangles belong to it by their centroids"))
      .required();
  coordinate(d.add("upper", &GrainRegionParameters::upper, "upper corner of the box")).required();
  angle(d.add("grain", &GrainRegionParameters::grain, "direction of warp there, as `cloth.grain`"))
      .required();
}

void AsReadParameters::declare(Declaration<AsReadParameters>& d) {
  d.add("file", &AsReadParameters::file, "the file");
  declare_file_coordinates(d);
  declare_scale(d);
  declare_rotate(d);
  d.add("join", &AsReadParameters::join, "as `cloth.join`").unit("m").between(0, 0.1);
}

void SeamParameters::declare(Declaration<SeamParameters>& d) {
  d.add("angle", &SeamParameters::angle,
        "dihedral angle of the fold along a seam at rest, positive where the cloth's front is outside")
      .unit("degree")
      .between(-180, 180);
  d.add("stiffness", &SeamParameters::stiffness, "factor on the stiffness of the fold along a seam")
      .between(0, bounds::largest_scale);
}

void ClothParameters::declare(Declaration<ClothParameters>& d) {
  d.add("shape", &ClothParameters::shape,
        "flat pattern in z = 0 with a corner (of a disc, the centre) at the origin, a mesh file, or a sewing "
        "pattern's file")
      .choices({"square", "rectangle", "disc", "polygon", "file", "pattern"});
  extent(d.add("side", &ClothParameters::side, "side of a square")).only_with("shape", {"square"});
  extent(d.add("size", &ClothParameters::size, "width and height of a rectangle"))
      .only_with("shape", {"rectangle"});
  extent(d.add("radius", &ClothParameters::radius, "radius of a disc")).only_with("shape", {"disc"});
  d.add_sections("loops", &ClothParameters::loops, "outline of a polygon, then its holes")
      .only_with("shape", {"polygon"});
  d.add("file", &ClothParameters::file,
        "mesh of the rest shape (OBJ, OFF, PLY or STL), or a sewing pattern (GarmentCode's JSON, or YAML), "
        "relative to this file")
      .path()
      .only_with("shape", {"file", "pattern"});
  declare_file_coordinates(d);
  d.declared("unit")
      .only_with("shape", {"file", "polygon"})
      .description("unit of the file's coordinates, or of a polygon's points");
  d.declared("up").only_with("shape", {"file"});
  declare_scale(d)
      .only_with("shape", {"file"})
      .description("scale factor on the file's mesh, and so on the rest shape, applied before `rotate`");
  declare_rotate(d)
      .only_with("shape", {"file", "pattern"})
      .description(
          "rotation of the file's mesh, or of a pattern's placement, about the x, then y, then z axis; "
          "regions of pins count from the result");
  d.add("rest", &ClothParameters::rest,
        "the rest shape: the file's surface in space, or flat pieces, sewn where the file's texture "
        "coordinates differ on the two sides of an edge; the surface then only places them")
      .choices({"space", "uv"})
      .only_with("shape", {"file"});
  d.add("uv_unit", &ClothParameters::uv_unit,
        "unit of the texture coordinates of flat pieces; normalised finds one length for all from the areas "
        "in space")
      .choices({"mm", "cm", "m", "inch", "normalised"})
      .only_with("rest", {"uv"});
  d.add("join", &ClothParameters::join, "vertices nearer to each other than this become one; 0 joins none")
      .unit("m")
      .between(0, 0.1)
      .only_with("shape", {"file"});
  d.add_section("seams", &ClothParameters::seams, "the folds along the seams of flat pieces");
  d.add("ease", &ClothParameters::ease,
        "largest difference of the lengths of a seam's sides, as a part of the longer one, where the "
        "pattern's "
        "seam has none; null: 0.8, or two edges of the mesh if that is more")
      .between(0, 1)
      .only_with("shape", {"pattern"});
  d.add_section(
      "as_read", &ClothParameters::as_read,
      "written by drape to a run's config, for `drape export --as-read`: how the cloth's file was read");
  d.add("triangulation", &ClothParameters::triangulation,
        "triangulation of a square or rectangle; discs and polygons are Delaunay meshes")
      .choices({"one_way", "criss_cross", "equilateral", "random"})
      .only_with("shape", {"square", "rectangle"});
  d.add("vertices", &ClothParameters::vertices,
        "approximate number of vertices of the coarsest level, 1024 by default; not beside `columns` and "
        "`rows`; a file's flat pieces are then meshed anew within their outlines")
      .between(3, bounds::most_vertices);
  d.add("edge_length", &ClothParameters::edge_length,
        "length of the coarsest level's edges, in place of `vertices`; 0.02 for a sewing pattern that has "
        "neither")
      .unit("m")
      .between(bounds::smallest_length, bounds::largest_length)
      .only_with("shape", {"disc", "polygon", "file", "pattern"});
  natural(d.add("columns", &ClothParameters::columns,
                "number of vertices along the width of a grid; 0 derives it from `vertices`"),
          bounds::most_vertices)
      .only_with("shape", {"square", "rectangle"});
  natural(d.add("rows", &ClothParameters::rows,
                "number of vertices along the height of a grid; 0 derives it from `vertices`"),
          bounds::most_vertices)
      .only_with("shape", {"square", "rectangle"});
  natural(d.add("seed", &ClothParameters::seed,
                "seed of a random triangulation, a polygon's, or a file's that is meshed anew"));
  angle(d.add(
      "grain", &ClothParameters::grain,
      "direction of warp on the rest shape, from `grain_along` counter-clockwise seen from the "
      "cloth's front; null: 0 if `grain_along` is u or file, otherwise that of the file's faces, or along x, "
      "neither exported nor drawn"));
  d.add_choice("grain_along", &ClothParameters::grain_along,
               {{"x", GrainAxis::x}, {"u", GrainAxis::u}, {"file", GrainAxis::file}},
               "what `grain` counts from: the x axis, projected into each triangle, or the y axis of flat "
               "pieces; the texture coordinate u of the file, where that is the pattern; or the faces' "
               "`warp_x`, `warp_y`, `warp_z` of a PLY file")
      .only_with("shape", {"file"});
  d.add_sections("grain_regions", &ClothParameters::grain_regions,
                 "parts of the cloth that were cut at another angle; later ones take precedence");
}

void StartParameters::declare(Declaration<StartParameters>& d) {
  d.add("file", &StartParameters::file,
        "mesh with the coarsest level's triangles that replaces the rest shape as start; finer levels "
        "interpolate it linearly over the rest shape")
      .path();
  declare_file_coordinates(d);
  d.declared("unit").description("unit of the start's file; null: that of the cloth's file");
  d.declared("up").description("axis of the start's file that points up; null: that of the cloth's file");
  d.add("scale", &StartParameters::scale, "scale factors along x, y, z, applied first")
      .between(-bounds::largest_scale, bounds::largest_scale);
  declare_placement(d);
  d.add("perturbation", &StartParameters::perturbation,
        "amplitude of smooth noise along z, added after `scale` and before `rotate`, so normal to a flat "
        "pattern; a function of the rest shape's x and y, equal on every level; pinned vertices have none")
      .unit("m")
      .between(0, bounds::largest_length);
  d.add("perturbation_wavelength", &StartParameters::perturbation_wavelength, "wavelength of the noise")
      .unit("m")
      .between(bounds::smallest_length, bounds::largest_length);
  natural(d.add("seed", &StartParameters::seed, "seed of the noise"));
}

void FollowParameters::declare(Declaration<FollowParameters>& d) {
  d.add("obstacle", &FollowParameters::obstacle,
        "name of the obstacle, or its index from 0; without one the pin follows none");
  natural(d.add("vertices", &FollowParameters::vertices,
                "vertices of the obstacle, from 0 in the order of its file, at whose triangles the pin may "
                "be attached; all without any"))
      .only_with("obstacle");
}

void PinParameters::declare(Declaration<PinParameters>& d) {
  declare_selection(d);
  d.add_section("follow", &PinParameters::follow,
                "obstacle that the targets move with: each keeps its place in the frame of the obstacle's "
                "triangle that is nearest to it at the start")
      .shorthand("obstacle");
}

void HandleParameters::declare(Declaration<HandleParameters>& d) {
  declare_selection(d);
  d.add("stiffness", &HandleParameters::stiffness,
        "κ_B of the penalty κ_B/2 m ‖x − x̃‖², m the mass on the coarsest level (a departure); by default the "
        "numerical value of the membrane modulus")
      .unit("1/s²")
      .between(0, bounds::largest_modulus)
      .source("supplement, section 4");
}

void ReferenceParameters::declare(Declaration<ReferenceParameters>& d) {
  d.add("method", &ReferenceParameters::method,
        "method whose finest state is the reference; `lowest` chooses the converged finest state of lowest "
        "energy");
  d.add("force_tolerance", &ReferenceParameters::force_tolerance,
        "force tolerance to which the reference is solved after all methods; 0 takes it as it is")
      .between(0, 1e12);
  d.add("file", &ReferenceParameters::file,
        "in place of `method`: a mesh of the finest level, or the folder of a run with a reference")
      .path();
}

void HierarchyParameters::declare(Declaration<HierarchyParameters>& d) {
  d.add(
       "coarsen", &HierarchyParameters::coarsen,
       "number of levels that are coarser than the cloth's mesh, whose vertices they share; each has about a "
       "quarter of the next one's")
      .between(0, 8);
  d.add("coarsest", &HierarchyParameters::coarsest,
        "in place of `coarsen`: about how many vertices the coarsest level has, within a factor of 2; 0: as "
        "`coarsen` says")
      .between(0, bounds::most_vertices);
  d.add("multigrid", &HierarchyParameters::multigrid,
        "whether meshes below the coarsest level are made for `linear_solver: multigrid`, down to 2,000 "
        "vertices; nothing is solved on them");
}

void ExperimentParameters::declare(Declaration<ExperimentParameters>& d) {
  d.add("name", &ExperimentParameters::name, "names the results folder and the report").required();
  d.add("description", &ExperimentParameters::description, "one sentence for the report");
  d.add_section("cloth", &ExperimentParameters::cloth,
                "the coarsest level, but for those that `hierarchy` puts below it");
  d.add("levels", &ExperimentParameters::levels,
        "number of levels from the cloth's mesh on, 1 by default if `hierarchy` puts levels below it; each "
        "splits every triangle of the last into four")
      .between(1, 10);
  d.add_section("hierarchy", &ExperimentParameters::hierarchy,
                "levels under a fine mesh of the user's own, which is the finest level then");
  d.add_section("material", &ExperimentParameters::material, "material of the cloth");
  d.add_section("start", &ExperimentParameters::start,
                "where the cloth begins: the rest shape or a file, transformed");
  d.add_sections("pins", &ExperimentParameters::pins,
                 "Dirichlet boundary conditions: vertices at prescribed positions (hard positions)");
  d.add_sections("handles", &ExperimentParameters::handles,
                 "penalty boundary conditions: vertices on springs to their targets (soft positions)");
  d.add_section("dress", &ExperimentParameters::dress,
                "puts a garment of flat pieces on a body; the name of the body's file is a shorthand")
      .shorthand("body");
  d.add_section(
      "schedule", &ExperimentParameters::schedule,
      "load stepping on a level that begins from `start`; later levels are solved under the final loads");
  d.add("energies", &ExperimentParameters::energies, "energies; their sum is minimised")
      .plugin("energy")
      .required();
  d.add("refiner", &ExperimentParameters::refiner, "refinement scheme; loop by default").plugin("refiner");
  d.add("contact", &ExperimentParameters::contact,
        "contact model or a list of them; without the key, contact is not modelled")
      .plugin("contact");
  d.add("obstacles", &ExperimentParameters::obstacles,
        "what the cloth collides with; each goes to the contact model that takes its keys, which `drape "
        "describe` of the model lists");
  declare_friction(d);
  d.add_section("newton", &ExperimentParameters::newton,
                "Newton parameters of every method; a method's own take precedence");
  d.add("methods", &ExperimentParameters::methods,
        "map from method names to solvers; `type` defaults to the name")
      .required();
  d.add("metrics", &ExperimentParameters::metrics,
        "metrics to evaluate; by default all that need no parameter")
      .plugin("metric");
  d.add_section("reference", &ExperimentParameters::reference,
                "state that errors are measured against, beside each method's own finest one; the name of a "
                "method or `lowest` is a shorthand")
      .shorthand("method");
  d.add("snapshots", &ExperimentParameters::snapshots,
        "largest number of intermediate states per level to record and to measure errors of")
      .between(0, 1000);
  d.add_choice(
      "check_intersections", &ExperimentParameters::check_intersections,
      {{"every_level", IntersectionCheck::every_level}, {"every_step", IntersectionCheck::every_step}},
      "when to count intersections, by exact predicates between meshes");
}

const Schema& experiment_schema() {
  static const Schema schema = schema_of<ExperimentParameters>();
  return schema;
}

ConfigNode node_of(const ExperimentParameters& parameters) { return experiment_schema().write(&parameters); }

ExperimentParameters parameters_of(const ConfigNode& node, ConfigErrors& errors) {
  ExperimentParameters parameters;
  experiment_schema().read(&parameters, node, errors);
  return parameters;
}

}  // namespace drape
