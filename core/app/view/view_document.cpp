#include "core/app/view/view_document.h"

#include <algorithm>
#include <tuple>

#include "core/app/view/view_blocks.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/elements/vertex_fields.h"
#include "core/numerics/mesh_files/base64.h"

namespace drape {

namespace {

/// Where arrows along warp are, on some 150 triangles: the corners' indices, then a and b [1/m] of warp's
/// image a e₁ + b e₂ by the triangle's edges.
ViewDocument::Json warp_arrows(const Level& level) {
  constexpr int most = 150;
  const std::vector<MaterialTriangle> triangles = material_triangles(level);
  ViewDocument::Json arrows = ViewDocument::Json::array();
  for (int t = 0; t < level.triangle_count(); t += (level.triangle_count() - 1) / most + 1) {
    const auto v = level.rest.triangles.row(t);
    arrows.push_back({v[0], v[1], v[2], triangles[t][0], triangles[t][1]});
  }
  return arrows;
}

}  // namespace

ViewDocument::ViewDocument(const std::vector<Level>& levels, const Obstacles& obstacles, bool with_gaps,
                           Keep keep, const std::vector<FieldKind>& further)
    : levels_(levels),
      with_gaps_(with_gaps),
      obstacles_(obstacles),
      keep_(std::move(keep)),
      kinds_(surface_fields()) {
  kinds_.insert(kinds_.end(), further.begin(), further.end());
  for (const Level& level : levels_) {
    const std::string name = "l" + std::to_string(level.index);
    keep_(name, encode_triangles(level.rest.triangles));
    level_entries_.push_back(
        {{"vertices", level.vertex_count()}, {"triangles", level.triangle_count()}, {"block", name}});
    if (level.rest.warp.rows() > 0) level_entries_.back()["warp"] = warp_arrows(level);
  }
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const std::string name = "obstacle" + std::to_string(k);
    keep_(name + "-x", encode_positions(obstacles_[k].vertices));
    keep_(name, encode_triangles(obstacles_[k].triangles));
    obstacle_entries_.push_back({{"vertices", obstacles_[k].vertices.rows()},
                                 {"triangles", obstacles_[k].triangles.rows()},
                                 {"x", name + "-x"},
                                 {"block", name}});
  }
}

SurfaceFields ViewDocument::fields(int level, const Positions& x, const Obstacles* moved) const {
  const Level& l = levels_[level];
  SurfaceFields all = {{"mean_curvature", mean_curvature(x, l.rest.triangles, l.hinges)},
                       {"stretch", largest_stretch(l, x)}};
  if (with_gaps_)
    all.emplace("gap", contact_gap(l, x, moved ? *moved : obstacles_, shown_gap(levels_.front())));
  return all;
}

void ViewDocument::set_ranges(const std::vector<const SurfaceFields*>& states) {
  for (FieldKind& kind : kinds_) {
    std::vector<const Eigen::VectorXd*> values;
    for (const SurfaceFields* state : states)
      if (const auto field = state->find(kind.name); field != state->end() && !field->second.isZero(0))
        values.push_back(&field->second);  // the finest level's difference from itself is zero
    if (!values.empty())
      std::tie(kind.low, kind.high) = field_range(kind, values, shown_gap(levels_.front()));
  }
}

ViewDocument::Json ViewDocument::state(const std::string& name, const Positions& x,
                                       const SurfaceFields& fields, const Obstacles* moved) {
  keep_(name, encode_positions(x));
  Json entry = {{"x", name}, {"fields", Json::object()}};
  for (const FieldKind& kind : kinds_) {
    const auto values = fields.find(kind.name);
    if (values == fields.end()) continue;
    const std::string block = name + "-" + kind.name;
    keep_(block, encode_scalars(values->second, kind.low, kind.high));
    entry["fields"][kind.name] = block;
  }
  for (std::size_t k = 0; moved && k < obstacles_.size(); ++k) {
    if ((*moved)[k].vertices == obstacles_[k].vertices) continue;
    const std::string block = name + "-obstacle" + std::to_string(k);
    keep_(block, encode_positions((*moved)[k].vertices));
    entry["obstacles"][std::to_string(k)] = block;
  }
  return entry;
}

std::size_t ViewDocument::state_bytes(int level) const {
  return levels_[level].vertex_count() * (6 + surface_fields().size());
}

ViewDocument::Json ViewDocument::document(const std::string& title, Json methods) const {
  Json fields = Json::array();
  for (const FieldKind& kind : kinds_)
    if (kind.high > kind.low)
      fields.push_back({{"name", kind.name},
                        {"label", kind.label},
                        {"unit", kind.unit},
                        {"map", kind.map},
                        {"note", kind.note},
                        {"low", kind.low},
                        {"high", kind.high}});
  return {{"title", title},
          {"levels", level_entries_},
          {"obstacles", obstacle_entries_},
          {"fields", fields},
          {"methods", std::move(methods)}};
}

std::string block_element(const std::string& name, const std::string& bytes) {
  return "<script type=\"application/octet-stream\" id=\"viewer-" + name + "\">" + base64(deflated(bytes)) +
         "</script>\n";
}

}  // namespace drape
