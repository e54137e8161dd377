#include "core/app/experiment/pattern_parameters.h"

#include "core/app/experiment/describe.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

void DartParameters::declare(Declaration<DartParameters>& d) {
  d.add("edge", &DartParameters::edge, "name or number of the edge that the dart opens to").required();
  d.add("at", &DartParameters::at, "its middle, as a part of the edge's length").above(0).below(1);
  d.add("width", &DartParameters::width, "length that the edge loses, in the file's unit")
      .above(0)
      .at_most(bounds::largest_length)
      .required();
  d.add("depth", &DartParameters::depth, "distance of its tip from the edge, in the file's unit")
      .above(0)
      .at_most(bounds::largest_length)
      .required();
}

void CurvatureParameters::declare(Declaration<CurvatureParameters>& d) {
  d.add("type", &CurvatureParameters::type, "kind of curve")
      .choices({"quadratic", "cubic", "circle"})
      .required();
  d.add("params", &CurvatureParameters::params,
        "control points of a Bézier curve, as in [[0.5, 0.1]]: part of the edge from its start to its end, "
        "and to its left; of a circle the radius in the file's unit, 1 for the arc of more than half a turn, "
        "and 1 for an arc that runs counter-clockwise")
      .required();
}

void PanelEdgeParameters::declare(Declaration<PanelEdgeParameters>& d) {
  d.add("endpoints", &PanelEdgeParameters::endpoints, "the two vertices, by number from 0 or by name")
      .required();
  d.add(
      "curvature", &PanelEdgeParameters::curvature,
      "the curve of the edge; without it, a line. A bare [x, y] is a quadratic Bézier curve's control point");
  d.add("name", &PanelEdgeParameters::name,
        "what seams, darts and messages call the edge, beside its number");
  d.add("label", &PanelEdgeParameters::label, "selects the edge's vertices for pins");
}

void PanelParameters::declare(Declaration<PanelParameters>& d) {
  d.add("translation", &PanelParameters::translation,
        "where the panel's origin is placed, in the file's unit")
      .between(-bounds::largest_coordinate, bounds::largest_coordinate);
  d.add("rotation", &PanelParameters::rotation, "rotation about x, then y, then z, before the translation")
      .unit("degree")
      .between(-bounds::largest_angle, bounds::largest_angle);
  d.add("vertices", &PanelParameters::vertices,
        "list of [x, y], or a map from names to them, in the file's unit")
      .required();
  d.add("edges", &PanelParameters::edges,
        "list of edges, or a map from names to them, in their order around the panel; a bare [a, b] is a "
        "line. Edges after the outline has closed are holes")
      .required();
  d.add("grain", &PanelParameters::grain,
        "direction of warp, from the panel's y axis counter-clockwise as it is drawn; `cloth.grain` replaces "
        "it")
      .unit("degree")
      .between(-bounds::largest_angle, bounds::largest_angle);
  d.add_sections("darts", &PanelParameters::darts, "darts that open to an edge");
  d.add("label", &PanelParameters::label, "part of the body that the panel covers; not read");
}

void PatternSeamParameters::declare(Declaration<PatternSeamParameters>& d) {
  d.add("name", &PatternSeamParameters::name, "what messages call the seam, beside its number");
  d.add("sides", &PatternSeamParameters::sides,
        "its two sides, each an edge, as in front.hem or {panel: front, edge: 2}, or a list of edges one "
        "behind the other along the seam")
      .required();
  d.add("ease", &PatternSeamParameters::ease,
        "largest difference of the sides' lengths, as a part of the longer one, which is gathered; null: "
        "`cloth.ease`")
      .between(0, 1);
  d.add(
      "right_wrong", &PatternSeamParameters::right_wrong,
      "true for a seam that lays the right side of one panel on the wrong side of the other, whose edges run "
      "along each other");
}

void PatternParameters::declare(Declaration<PatternParameters>& d) {
  d.add("panels", &PatternParameters::panels, "map from names to panels").required();
  d.add("stitches", &PatternParameters::stitches,
        "seams: a list, or a map from names to them; a bare [a, b] or [a, b, right_wrong] has these sides");
  d.add("panel_order", &PatternParameters::panel_order, "not read");
}

void PatternPropertyParameters::declare(Declaration<PatternPropertyParameters>& d) {
  d.add("units_in_meter", &PatternPropertyParameters::units_in_meter,
        "how many of the file's units make a metre")
      .between(1e-6, 1e6)
      .required();
  d.add("curvature_coords", &PatternPropertyParameters::curvature_coords,
        "control points relative to their edge, or as the vertices are")
      .choices({"relative", "absolute"});
  d.add("up", &PatternPropertyParameters::up, "axis of the placement that points up").choices({"y", "z"});
  for (const char* name : {"normalize_panel_translation", "normalized_edge_loops", "original_units_in_meter"})
    d.add(name, &PatternPropertyParameters::unread, "not read");
}

void PatternFileParameters::declare(Declaration<PatternFileParameters>& d) {
  d.add_section("properties", &PatternFileParameters::properties, "unit and conventions").required();
  d.add_section("pattern", &PatternFileParameters::pattern, "panels and seams").required();
  d.add("parameters", &PatternFileParameters::unread, "of a template; not read");
  for (const char* name : {"parameter_order", "constraints", "constraint_order"})
    d.add(name, &PatternFileParameters::unread, "not read");
}

std::string describe_pattern_markdown() {
  return "The file of `cloth: {shape: pattern}`, as JSON or YAML ([how to write "
         "one](../guide/patterns.md)).\n\n" +
         describe_markdown(schema_of<PatternFileParameters>()) + "\n### A panel\n\n" +
         describe_markdown(schema_of<PanelParameters>()) + "\n### An edge of a panel\n\n" +
         describe_markdown(schema_of<PanelEdgeParameters>()) + "\n### Its curvature\n\n" +
         describe_markdown(schema_of<CurvatureParameters>()) + "\n### A seam\n\n" +
         describe_markdown(schema_of<PatternSeamParameters>());
}

}  // namespace drape
