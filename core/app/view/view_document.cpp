#include "core/app/view/view_document.h"

#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>

#include "core/kernel/files/file.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/elements/vertex_fields.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/mesh/texture_coordinates.h"
#include "core/numerics/mesh_files/base64.h"

namespace drape {

namespace {

/// Where arrows along warp are, evenly over the rest shape: the corners' indices of triangles, then a and b
/// [1/m] of warp's image a e₁ + b e₂ by the triangle's edges.
Json warp_arrows(const Level& level) {
  const double cell = bounding_box_diagonal(level.rest.vertices) / 16;
  std::set<std::array<double, 3>> taken;  // cells of a grid that have an arrow
  const std::vector<MaterialTriangle> triangles = material_triangles(level);
  Json arrows = Json::array();
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const Eigen::RowVector3d place = level.rest.vertices(v, Eigen::all).colwise().mean() / cell;
    if (!taken.insert({std::floor(place[0]), std::floor(place[1]), std::floor(place[2])}).second) continue;
    arrows.push_back({v[0], v[1], v[2], triangles[t][0], triangles[t][1]});
  }
  return arrows;
}

constexpr double steps = 65535;

}  // namespace

ViewDocument::ViewDocument(const std::vector<Level>& levels, const Obstacles& obstacles, bool with_gaps,
                           Keep keep, const std::vector<FieldKind>& further)
    : levels_(levels),
      with_gaps_(with_gaps),
      gap_range_(2e-3 * bounding_box_diagonal(levels.front().rest.vertices)),
      obstacles_(obstacles),
      keep_(std::move(keep)),
      kinds_(field_kinds(levels.front().rest.sewing.has_value())) {
  kinds_.insert(kinds_.end(), further.begin(), further.end());
  for (const Level& level : levels_) {
    const std::string name = "l" + std::to_string(level.index);
    keep_(name, encode_triangles(level.rest.triangles));
    level_entries_.push_back(
        {{"vertices", level.vertex_count()}, {"triangles", level.triangle_count()}, {"block", name}});
    if (level.rest.warp.rows() > 0) level_entries_.back()["warp"] = warp_arrows(level);
    if (level.rest.sewing)
      add_sewing(level, level_entries_.back());
    else if (const auto planar = PlanarUv::of(level.rest)) {
      Positions rest = Positions::Zero(level.vertex_count(), 3);
      rest.col(0) = level.rest.vertices * planar->axes.row(0).normalized().transpose();
      rest.col(2) = level.rest.vertices * planar->axes.row(1).normalized().transpose();
      keep_(name + "-rest", encode_positions(rest));
      level_entries_.back()["rest"] = name + "-rest";
    }
  }
  for (std::size_t k = 0; k < obstacles_.size(); ++k)
    obstacle_entries_.push_back(
        mesh_entry("obstacle" + std::to_string(k), obstacles_[k].vertices, obstacles_[k].triangles));
}

Json ViewDocument::mesh_entry(const std::string& name, const Positions& x, const Triangles& triangles) {
  keep_(name + "-x", encode_positions(x));
  keep_(name, encode_triangles(triangles));
  return {{"vertices", x.rows()}, {"triangles", triangles.rows()}, {"x", name + "-x"}, {"block", name}};
}

/// Adds the seams, as ends of edges, and the flat pieces: their vertices are those of the level, then others,
/// `copies`, where a seam or a dart divides one.
void ViewDocument::add_sewing(const Level& level, Json& entry) {
  for (const int e : seam_edges(level.rest, level.topology))
    for (int k = 0; k < 2; ++k) entry["seams"].push_back(level.topology.edges(e, k));
  const UvVertices flat = laid_out(level.rest);
  Positions x = Positions::Zero(flat.uv.rows(), 3);
  x.col(0) = flat.uv.col(0), x.col(2) = flat.uv.col(1);
  entry["flat"] = mesh_entry(entry["block"].get<std::string>() + "-flat", x, flat.triangles);
  entry["flat"]["copies"] = std::vector<int>(flat.vertex.begin() + level.vertex_count(), flat.vertex.end());
}

SurfaceFields ViewDocument::fields(int level, const Positions& x, const Eigen::VectorXd& pressure,
                                   const Obstacles* moved) const {
  const Level& l = levels_[level];
  SurfaceFields all = {{"mean_curvature", mean_curvature(x, l.rest.triangles, l.hinges)},
                       {"stretch", largest_stretch(l, x)}};
  if (with_gaps_) all.emplace("gap", contact_gap(l, x, moved ? *moved : obstacles_, gap_range_));
  if (l.rest.sewing)
    for (VertexField& field : garment_fields_at(l, x, moved ? *moved : obstacles_))
      all.emplace(field.name, std::move(field.values));
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (pressure.size() > 0) all.emplace("contact_pressure", (pressure.array() > 0).select(pressure, none));
  return all;
}

bool ViewDocument::set_ranges(const std::vector<const SurfaceFields*>& states) {
  bool wider = false;
  for (FieldKind& kind : kinds_) {
    std::vector<const Eigen::VectorXd*> values;
    for (const SurfaceFields* state : states)
      if (const auto field = state->find(kind.name); field != state->end() && !field->second.isZero(0))
        values.push_back(&field->second);  // the finest level's difference from itself is zero
    if (values.empty()) continue;
    const auto [low, high] = field_range(kind, values, gap_range_);
    wider = wider || low < kind.low || high > kind.high;
    kind.low = low, kind.high = high;
  }
  return wider;
}

Json ViewDocument::state(const std::string& name, const Positions& x, const SurfaceFields& fields,
                         const Obstacles* moved) {
  keep_(name, encode_positions(x));
  Json entry = {{"x", name}, {"fields", Json::object()}};
  for (std::size_t k = 0; k < kinds_.size(); ++k) {
    const FieldKind& kind = kinds_[k];
    const auto values = fields.find(kind.name);
    if (values == fields.end()) continue;
    const std::string block = name + "-" + std::to_string(k);  // a field's name may hold anything
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

Json ViewDocument::document(const std::string& title, Json methods) const {
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

std::string encode_positions(const Positions& x) {
  Eigen::AlignedBox3d bounds = bounding_box(x);
  if (bounds.isEmpty()) bounds.extend(Eigen::Vector3d::Zero());
  const Eigen::AlignedBox3f box = bounds.cast<float>();
  std::string bytes;
  bytes.reserve(24 + 6 * x.rows());
  for (int k = 0; k < 3; ++k) append_bytes(bytes, box.min()[k]);
  for (int k = 0; k < 3; ++k) append_bytes(bytes, box.sizes()[k]);
  for (int k = 0; k < 3; ++k) {
    const double lower = box.min()[k], size = box.sizes()[k];
    std::uint16_t before = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const double place = size > 0 && std::isfinite(x(i, k)) ? (x(i, k) - lower) / size : 0;
      const auto q = static_cast<std::uint16_t>(std::lround(std::clamp(place, 0.0, 1.0) * steps));
      append_bytes(bytes, static_cast<std::uint16_t>(q - before));
      before = q;
    }
  }
  return bytes;
}

std::string encode_triangles(const Triangles& triangles) {
  std::string bytes;
  bytes.reserve(4 * triangles.size());
  for (int k = 0; k < 3; ++k) {
    std::int32_t before = 0;
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
      append_bytes(bytes, static_cast<std::int32_t>(triangles(t, k) - before));
      before = triangles(t, k);
    }
  }
  return bytes;
}

std::string encode_scalars(const Eigen::VectorXd& values, double low, double high) {
  std::string bytes;
  bytes.reserve(8 + values.size());
  append_bytes(bytes, static_cast<float>(low));
  append_bytes(bytes, static_cast<float>(high));
  for (const double value : values) {
    const double place = std::clamp((value - low) / (high - low), 0.0, 1.0);
    append_bytes(bytes, static_cast<std::uint8_t>(std::isnan(place) ? 255 : std::lround(place * 254)));
  }
  return bytes;
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int code =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                bytes.size(), Z_DEFAULT_COMPRESSION);
  if (code != Z_OK) throw std::runtime_error("zlib cannot compress a block of the viewer");
  packed.resize(size);
  return packed;
}

ViewDocument::Keep embedded_in(std::string& blocks) {
  return [&](const std::string& name, const std::string& bytes) {
    blocks += "<script type=\"application/octet-stream\" id=\"viewer-" + name + "\">" +
              base64(deflated(bytes)) + "</script>\n";
  };
}

}  // namespace drape
