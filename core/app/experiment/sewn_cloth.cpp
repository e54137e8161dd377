#include "core/app/experiment/sewn_cloth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/app/experiment/cloth.h"
#include "core/app/experiment/pattern_file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/sewing/sew_pattern.h"

namespace drape {

namespace {

struct UvUnit {
  const char* name;
  double length;  // [m]
};
constexpr UvUnit uv_units[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"inch", 0.0254}, {"m", 1}};

/// The unit that texture coordinates seem to have, by the areas in space.
std::string guessed_unit(double length) {
  constexpr double near = 1.3;
  for (const UvUnit& unit : uv_units)
    if (length < near * unit.length && unit.length < near * length) return unit.name;
  return "normalised";
}

/// Refuses texture coordinates that no single length makes flat pieces of, such as those of which u and v
/// were each scaled to 0 … 1.
double normalised_length(const TriangleMesh& cloth) {
  const std::vector<char> all(cloth.triangles.rows(), 1);
  const UvLength length = UvLength::of(cloth, all);
  const std::string remedy =
      "; export the texture coordinates in a unit of length, and write that as \"uv_unit\"";
  if (!std::isfinite(length.along_u) || !std::isfinite(length.along_v))
    throw std::runtime_error("the texture coordinates enclose no area" + remedy);
  if (!similar_lengths(length.along_u, length.along_v))
    throw std::runtime_error(
        "\"uv_unit: normalised\" needs one length for u and v, but by the areas in space u has " +
        three_digits(length.along_u) + " m and v " + three_digits(length.along_v) + " m: the aspect is lost" +
        remedy);
  for (std::size_t p = 0; p < cloth.piece_names.size(); ++p) {
    std::vector<char> own(all.size());
    for (std::size_t t = 0; t < own.size(); ++t) own[t] = cloth.piece[t] == static_cast<int>(p);
    const double piece = UvLength::of(cloth, own).whole;
    if (std::isfinite(piece) && !similar_lengths(piece, length.whole))
      throw std::runtime_error(
          "\"uv_unit: normalised\" needs one length for all pieces, but by the areas in space " +
          cloth.piece_names[p] + " has " + three_digits(piece) + " m and all have " +
          three_digits(length.whole) + " m" + remedy);
  }
  return length.whole;
}

Sewing sewing_of(const ClothParameters& c) {
  return {1, c.seams.angle * std::numbers::pi / 180, c.seams.stiffness};
}

/// As asked for, or by the number of vertices; 2 cm without either. Throws std::runtime_error for too many
/// vertices.
double edge_length_of(const Pattern& pattern, const ClothParameters& c) {
  const OutlineSize size = outline_size(pattern);
  const double length = c.edge_length || !c.vertices ? c.edge_length.value_or(0.02)
                                                     : even_spacing(size.area, size.border, *c.vertices);
  vertices_within(size, length);
  return length;
}

/// The pattern of the cloth, its seams eased as the cloth says where they do not; none for a faulty one.
std::optional<Pattern> eased_pattern(const ClothParameters& c, ConfigErrors& errors) {
  std::optional<Pattern> pattern = read_pattern(c.file, errors);
  if (pattern)
    for (Seam& seam : pattern->seams)
      if (!seam.ease) seam.ease = c.ease;
  return pattern;
}

/// Whether the second edge begins where the first one ends, and in its direction.
bool go_straight_on(const Panel& panel, int first, int second) {
  constexpr double straight = 0.985, part = 0.01;  // cosine of 10°; of an edge, for its direction
  const auto follows = [&](const std::vector<int>& loop) {
    const auto at = std::ranges::find(loop, first);
    return at != loop.end() && (at + 1 == loop.end() ? loop.front() : at[1]) == second;
  };
  const EdgeCurve &a = panel.edges[first].curve, &b = panel.edges[second].curve;
  const Eigen::Vector2d in = a.at(1) - a.at(1 - part), out = b.at(part) - b.at(0);
  return std::ranges::any_of(panel.loops, follows) && in.dot(out) > straight * in.norm() * out.norm();
}

}  // namespace

void sew(TriangleMesh& cloth, const ClothParameters& c) {
  cloth.sewing.reset();  // a run's own mesh has one
  if (c.rest != "uv") return;
  if (cloth.uv.rows() == 0)
    throw std::runtime_error(
        c.file +
        ": \"rest: uv\" needs texture coordinates, which the file has not; unwrap it, or leave out "
        "\"rest\"");
  cloth.sewing = sewing_of(c);
  if (cloth.piece.empty()) {
    cloth.piece =
        flat_pieces(cloth, Topology::of_any(cloth.triangles, static_cast<int>(cloth.vertices.rows())));
    for (int p = 0; p <= *std::ranges::max_element(cloth.piece); ++p)
      cloth.piece_names.push_back("piece_" + std::to_string(p));
  }
  if (c.uv_unit == "normalised") {
    cloth.sewing->uv_length = normalised_length(cloth);
    return;
  }
  const auto unit = std::ranges::find_if(uv_units, [&](const UvUnit& u) { return c.uv_unit == u.name; });
  if (unit == std::end(uv_units)) {
    const double length = UvLength::of(cloth, std::vector<char>(cloth.triangles.rows(), 1)).whole;
    throw std::runtime_error(
        "\"rest: uv\" needs \"uv_unit\", the unit of the texture coordinates; by the areas "
        "in space one is " +
        three_digits(length) + " m: \"uv_unit: " + guessed_unit(length) + "\"?");
  }
  cloth.sewing->uv_length = unit->length;
}

std::optional<TriangleMesh> cloth_of_pattern(const ClothParameters& c, ConfigErrors& errors,
                                             LabelEdges* labels) {
  if (c.file.empty()) throw std::runtime_error("\"shape: pattern\" needs \"file\", the pattern to read");
  const std::optional<Pattern> pattern = eased_pattern(c, errors);
  if (!pattern) return std::nullopt;
  std::optional<TriangleMesh> cloth = sew_pattern(*pattern, edge_length_of(*pattern, c), errors, labels);
  if (!cloth) return std::nullopt;
  if (!c.rotate.isZero(0)) cloth->vertices *= rotation_matrix(c.rotate).transpose();
  cloth->sewing = sewing_of(c);
  return cloth;
}

ConfigErrors tucks_in(const ClothParameters& c) {
  ConfigErrors tucks, of_pattern;
  const std::optional<Pattern> pattern = read_pattern(c.file, of_pattern);
  if (!pattern) return tucks;
  for (const Seam& seam : pattern->seams) {
    if (seam.sides[0].size() != 1 || seam.sides[1].size() != 1) continue;
    const EdgeIndex &a = seam.sides[0][0], &b = seam.sides[1][0];
    const Panel& panel = pattern->panels[a.panel];
    if (a.panel == b.panel &&
        (go_straight_on(panel, a.edge, b.edge) || go_straight_on(panel, b.edge, a.edge)))
      tucks.push_back(
          {seam.where, "seam " + seam.name + " sews the neighbouring edges " + panel.edges[a.edge].name +
                           " and " + panel.edges[b.edge].name + " of panel " + panel.name +
                           " to each other, which would fold a tuck; there are no tucks and pleats: "
                           "gather the edge by the \"ease\" of a seam, or take cloth away by \"darts\""});
  }
  return tucks;
}

std::vector<std::string> gather_remarks(const ClothParameters& c) {
  std::vector<std::string> remarks;
  ConfigErrors of_pattern;
  const std::optional<Pattern> pattern =
      c.shape == "pattern" ? read_pattern(c.file, of_pattern) : std::nullopt;
  if (!pattern) return remarks;
  constexpr double much = 0.3;
  for (const Seam& seam : pattern->seams)
    if (pattern->gathered(seam) > much) {
      const auto [shorter, longer] =
          std::minmax({pattern->length(seam.sides[0]), pattern->length(seam.sides[1])});
      remarks.push_back("cloth: seam " + seam.name + " gathers a length of " +
                        three_digits(longer / pattern->unit) + " to " +
                        three_digits(shorter / pattern->unit) + ", in the file's unit");
    }
  return remarks;
}

std::optional<double> vertices_in_outlines(const ClothParameters& c) try {
  ConfigErrors of_pattern;  // which the check of the cloth reports
  const std::optional<Pattern> pattern = read_pattern(c.file, of_pattern);
  if (!pattern) return std::nullopt;
  return outline_size(*pattern).vertices(edge_length_of(*pattern, c));
} catch (const std::runtime_error&) {
  return std::nullopt;  // as well
}

void find_label_edges(const ConfigNode& source, ExperimentParameters& p, ConfigErrors& errors) {
  std::vector<std::pair<VertexSelection*, const Location*>> asked;
  const auto add = [&](auto& selections, const char* key) {
    for (std::size_t k = 0; k < selections.size(); ++k)
      if (selections[k].label && selections[k].label_edges.empty())
        asked.emplace_back(&selections[k], &source.find(key)->items[k].where);
  };
  add(p.pins, "pins");
  add(p.handles, "handles");
  if (asked.empty()) return;
  LabelEdges labels;
  const bool is_pattern = p.cloth.shape == "pattern";
  try {
    ConfigErrors of_cloth;  // which the check of the cloth reports
    if (is_pattern && !cloth_of_pattern(p.cloth, of_cloth, &labels)) return;
  } catch (const std::runtime_error&) {
    return;  // as well
  }
  std::vector<std::string> names;
  for (const auto& [name, edges] : labels) names.push_back(name);
  constexpr std::size_t most_ends = 100'000;  // config.yaml names them
  std::size_t ends = 0;
  for (const auto& [selection, where] : asked) {
    const std::vector<int>& own = labels[*selection->label];
    if (ends += own.size(); ends > most_ends)
      return errors.push_back({*where, "the labels of pins and handles have more than " +
                                           std::to_string(most_ends / 2) +
                                           " edges of the mesh together; let fewer select the same"});
    selection->label_edges = own;
    if (selection->label_edges.empty())
      errors.push_back({*where, "no edge of the cloth has the label \"" + excerpt(*selection->label) +
                                    "\"; " +
                                    (!is_pattern     ? "only edges of a sewing pattern have labels"
                                     : names.empty() ? "the pattern has no labels"
                                                     : "the pattern has " + listed(names))});
  }
}

std::string sewing_text(const Level& coarsest) {
  const TriangleMesh& cloth = coarsest.rest;
  if (!cloth.sewing) return "";
  double seams = 0, least = 1;
  for (const int e : seam_edges(cloth, coarsest.topology)) {
    const RestSide a = rest_side(cloth, coarsest.topology, e, 0),
                   b = rest_side(cloth, coarsest.topology, e, 1);
    const double one = (a.to - a.from).norm(), other = (b.to - b.from).norm();
    seams += rest_length(cloth, coarsest.topology, e);
    least = std::min({least, one / other, other / one});
  }
  const std::vector<int> pieces = flat_pieces(cloth, coarsest.topology);
  const int count = *std::ranges::max_element(pieces) + 1;
  std::string text = std::to_string(count) + (count == 1 ? " flat piece, " : " flat pieces, ") +
                     three_digits(seams) + " m of seams";
  if (least < 0.999) text += ", eased by up to " + three_digits(100 * (1 - least)) + " %";
  return text + "; 1 unit of the texture coordinates is " + three_digits(cloth.sewing->uv_length) + " m";
}

}  // namespace drape
