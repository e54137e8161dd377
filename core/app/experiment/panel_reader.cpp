#include "core/app/experiment/panel_reader.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <cmath>
#include <set>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

using Kind = ConfigNode::Kind;
using Eigen::Vector2d;

/// `count` finite numbers; true and false count as 1 and 0. Nothing for another node.
std::optional<std::vector<double>> numbers(const ConfigNode& node, std::size_t count) {
  std::vector<double> all;
  for (const ConfigNode& item : node.items)
    if (item.scalar == "true" || item.scalar == "false")
      all.push_back(item.scalar == "true");
    else if (const auto number = number_of(item.scalar);
             number && std::abs(*number) <= bounds::largest_coordinate)
      all.push_back(*number);
  if (node.items.size() != count || all.size() != count) return std::nullopt;
  return all;
}

class PanelReader {
 public:
  PanelReader(const std::string& name, const ConfigNode& node, const PatternUnits& units,
              ConfigErrors& errors)
      : node_(node), units_(units), errors_(errors), before_(errors.size()) {
    own_ = "panel " + excerpt(name) + ": ";
    read_.panel.name = name;
    read_.panel.where = node.where;
  }

  std::optional<ReadPanel> read() {
    refuse_absent_keys();
    if (failed()) return std::nullopt;
    Schema schema = schema_of<PanelParameters>("panel " + excerpt(read_.panel.name));
    schema.read(&p_, node_, errors_);
    if (const std::string& name = read_.panel.name; name.empty() || printable(boost::trim_copy(name)) != name)
      refuse(node_.where, "a panel's name needs letters, without control characters or blanks around them");
    if (failed()) return std::nullopt;
    read_.panel.translation = units_.length * p_.translation;
    read_.panel.rotation = p_.rotation;
    read_.panel.grain = p_.grain;
    read_vertices();
    if (!failed()) read_edges();
    if (!failed()) find_loops();
    if (!failed()) cut_darts();
    if (!failed()) check_lengths();
    return failed() ? std::nullopt : std::optional(std::move(read_));
  }

 private:
  bool failed() const { return errors_.size() > before_; }
  void refuse(const Location& where, const std::string& what) { errors_.push_back({where, own_ + what}); }

  /// Keys that people try, with what there is instead.
  void refuse_absent_keys() {
    static const std::map<std::string, std::string> instead = {
        {"fabric", "all panels are of one fabric, that of \"material\" in the experiment"},
        {"buttons", "sew the edges that buttons would hold together by a seam, or pin them by a \"label\""},
        {"pleats",
         "nothing folds a panel: gather its edge by the \"ease\" of a seam, or take cloth away by \"darts\""},
        {"mirror", "write the mirrored panel out: x of its vertices with the other sign, the rest as it is"}};
    for (std::size_t k = 0; k < node_.entries.size(); ++k)
      if (const auto found = instead.find(node_.entries[k].first); found != instead.end())
        refuse(node_.key_locations[k], "there is no \"" + found->first + "\"; " + found->second);
  }

  void read_vertices() {
    for (const NamedNode& vertex : named_nodes(p_.vertices, own_, errors_)) {
      const auto place = numbers(*vertex.node, 2);
      if (!place)
        return refuse(vertex.where, "a vertex is [x, y], two numbers of at most " +
                                        three_digits(bounds::largest_coordinate) + ", not " +
                                        excerpt(vertex.node->one_line()));
      vertices_.push_back(units_.length * Vector2d((*place)[0], (*place)[1]));
      if (!vertex.name.empty())
        named_vertices_.try_emplace(vertex.name, static_cast<int>(vertex_names_.size()));
      vertex_names_.push_back(vertex.name);
    }
    if (!failed() && vertices_.size() < 3)
      refuse(p_.vertices.kind == Kind::null ? node_.where : p_.vertices.where,
             "it is empty: it has " + std::to_string(vertices_.size()) + " vertices, and needs three");
  }

  std::optional<int> vertex_of(const ConfigNode& node, const std::string& edge) {
    if (const auto named = named_vertices_.find(node.scalar); named != named_vertices_.end())
      return named->second;
    const auto number = parse_integer(node.scalar);
    if (number && *number >= 0 && *number < std::ssize(vertices_)) return *number;
    const bool has_names = !vertex_names_[0].empty();
    refuse(node.where, "edge " + edge + " ends at vertex " + node.shown() + ", which is not there; " +
                           (has_names ? "it has " + listed(vertex_names_)
                                      : "vertices go from 0 to " + std::to_string(vertices_.size() - 1)));
    return std::nullopt;
  }

  /// The curve of an edge; nothing, with an error, if its curvature is not one.
  std::optional<EdgeCurve> curve_of(const ConfigNode& node, const std::string& edge, const Vector2d& a,
                                    const Vector2d& b) {
    if (node.kind == Kind::null) return EdgeCurve::bezier({a, b});
    const auto control = [&](const std::vector<double>& q) -> Vector2d {
      if (!units_.relative_curvature) return units_.length * Vector2d(q[0], q[1]);
      const Vector2d along = b - a;
      return a + q[0] * along + q[1] * Vector2d(-along.y(), along.x());
    };
    if (node.kind == Kind::list)  // as PyGarment wrote it first
      if (const auto q = numbers(node, 2)) return EdgeCurve::bezier({a, control(*q), b});
    CurvatureParameters c;
    const std::size_t before = errors_.size();
    schema_of<CurvatureParameters>("the curvature of edge " + edge + " of panel " + excerpt(read_.panel.name))
        .read(&c, node, errors_);
    if (errors_.size() > before) return std::nullopt;
    if (c.type == "circle") {
      const auto q = numbers(c.params, 3);
      const double distance = (b - a).norm(), rounding = 1e-3;
      if (q && (*q)[0] * units_.length * 2 >= distance * (1 - rounding))
        return EdgeCurve::arc(a, b, (*q)[0] * units_.length, (*q)[1] != 0, (*q)[2] != 0);
      refuse(c.params.where, "edge " + edge +
                                 (q ? ": no circle of that radius has both of its ends; at least " +
                                          three_digits(distance / 2 / units_.length)
                                    : ": \"params\" of a circle are [radius, 0 or 1, 0 or 1]"));
      return std::nullopt;
    }
    const std::size_t count = c.type == "cubic" ? 2 : 1;
    std::vector<Vector2d> points = {a};
    for (const ConfigNode& item : c.params.items)
      if (const auto q = numbers(item, 2)) points.push_back(control(*q));
    if (points.size() == count + 1 && c.params.items.size() == count) {
      points.push_back(b);
      return EdgeCurve::bezier(points);
    }
    refuse(c.params.where, "edge " + edge + ": \"params\" of a " + c.type + " curve are " +
                               (count == 1 ? "one control point, as in [[0.5, 0.1]]"
                                           : "two control points, as in [[0.3, 0.1], [0.7, 0.1]]"));
    return std::nullopt;
  }

  void read_edges() {
    for (const NamedNode& written : named_nodes(p_.edges, own_, errors_)) {
      PanelEdgeParameters e;
      const std::string number = std::to_string(ends_.size());
      schema_of<PanelEdgeParameters>("edge " + (written.name.empty() ? number : excerpt(written.name)) +
                                     " of panel " + excerpt(read_.panel.name))
          .read(&e, with_key("endpoints", *written.node), errors_);
      if (failed()) return;
      const std::string own = e.name.value_or(written.name), name = own.empty() ? number : excerpt(own);
      if (e.endpoints.items.size() != 2)
        return refuse(e.endpoints.where,
                      "edge " + name + " needs two endpoints, not " + e.endpoints.one_line());
      const auto a = vertex_of(e.endpoints.items[0], name), b = vertex_of(e.endpoints.items[1], name);
      if (!a || !b) return;
      if (vertices_[*a] == vertices_[*b])
        return refuse(written.where,
                      "edge " + name + " begins and ends at one place; make two edges of a closed curve");
      const auto curve = curve_of(e.curvature, name, vertices_[*a], vertices_[*b]);
      if (!curve) return;
      if (!own.empty() &&
          !read_.named_edges.try_emplace(own, static_cast<int>(read_.edge_names.size())).second)
        return refuse(written.where, "edge " + name + " is given twice; rename one");
      read_.edge_names.push_back(own);
      read_.parts.push_back({static_cast<int>(read_.parts.size())});
      read_.panel.edges.push_back({name, *curve, e.label, written.where});
      ends_.push_back({*a, *b});
    }
    if (!failed() && ends_.empty())
      refuse(p_.edges.kind == Kind::null ? node_.where : p_.edges.where, "it is empty: it has no edges");
  }

  std::string order_counts() const {
    return p_.edges.kind == Kind::map
               ? "; their order in the map counts, each begins where the one before ends: a "
                 "list keeps it where a program sorts keys"
               : "; their order counts, each begins where the one before ends";
  }

  void find_loops() {
    const auto vertex_text = [&](int v) {
      return vertex_names_[v].empty() ? std::to_string(v) : vertex_names_[v];
    };
    std::vector<int> loop;
    for (int e = 0; e < std::ssize(ends_); ++e) {
      if (!loop.empty() && ends_[e].first != ends_[loop.back()].second)
        return refuse(read_.panel.edges[e].where, "edge " + read_.panel.edges[e].name + " begins at vertex " +
                                                      vertex_text(ends_[e].first) +
                                                      ", but the one before ends at " +
                                                      vertex_text(ends_[loop.back()].second) +
                                                      ": the edges do not close a loop" + order_counts());
      loop.push_back(e);
      if (ends_[e].second != ends_[loop[0]].first) continue;
      read_.panel.loops.push_back(std::exchange(loop, {}));
    }
    if (!loop.empty())
      refuse(read_.panel.edges[loop.back()].where,
             "edge " + read_.panel.edges[loop.back()].name + " ends at vertex " +
                 vertex_text(ends_[loop.back()].second) + ", but its loop began at " +
                 vertex_text(ends_[loop[0]].first) + ": the edges do not close a loop" + order_counts());
  }

  /// Opens edges for their darts: each dart divides an edge, and adds its two legs between the parts.
  void cut_darts() {
    std::vector<std::vector<const DartParameters*>> of_edge(read_.parts.size());
    for (const DartParameters& dart : p_.darts) {
      const auto e = read_.edge_of(dart.edge, "a dart", errors_);
      if (!e) return;
      of_edge[*e].push_back(&dart);
    }
    const std::vector<PanelEdge> written = std::exchange(read_.panel.edges, {});
    for (std::vector<int>& loop : read_.panel.loops) {
      // Seen along an edge, a panel is on the left of an outline that runs counter-clockwise, and of its
      // holes'.
      const double left = (&loop == &read_.panel.loops[0]) == (area_of(loop, written) < 0) ? -1 : 1;
      std::vector<int> whole;
      for (const int e : loop) {
        std::vector<const DartParameters*>& darts = of_edge[e];
        std::ranges::stable_sort(darts, {}, &DartParameters::at);
        read_.parts[e].clear();
        const double length = written[e].curve.length();
        double begin = 0;
        const auto add = [&](std::string name, EdgeCurve curve, bool is_part) {
          if (is_part) read_.parts[e].push_back(static_cast<int>(read_.panel.edges.size()));
          whole.push_back(static_cast<int>(read_.panel.edges.size()));
          read_.panel.edges.push_back({std::move(name), std::move(curve),
                                       is_part ? written[e].label : std::nullopt, written[e].where});
        };
        for (const DartParameters* dart : darts) {
          const double half = units_.length * dart->width / 2, middle = dart->at * length;
          if (middle - half <= begin || middle + half >= length)
            return refuse(dart->edge.where, "a dart of edge " + written[e].name +
                                                " leaves no edge beside it; make it narrower, or move it");
          const Vector2d a = written[e].curve.at_length(middle - half),
                         b = written[e].curve.at_length(middle + half);
          const Vector2d along = (b - a).normalized();
          const Vector2d tip =
              (a + b) / 2 + left * units_.length * dart->depth * Vector2d(-along.y(), along.x());
          add(written[e].name, written[e].curve.between(begin, middle - half), true);
          const int leg = static_cast<int>(read_.panel.edges.size());
          const std::string name = "dart of " + written[e].name;
          add(name, EdgeCurve::bezier({a, tip}), false);
          add(name, EdgeCurve::bezier({tip, b}), false);
          read_.darts.push_back({leg, leg + 1});
          begin = middle + half;
        }
        add(written[e].name, darts.empty() ? written[e].curve : written[e].curve.between(begin, length),
            true);
      }
      loop = std::move(whole);
    }
  }

  void check_lengths() {
    for (const PanelEdge& edge : read_.panel.edges) {
      const double length = edge.curve.length();
      if (length >= bounds::smallest_length && length <= bounds::largest_length) continue;
      return refuse(edge.where, "edge " + edge.name + " is " + three_digits(length) +
                                    " m long, of at least " + three_digits(bounds::smallest_length) +
                                    " and at most " + three_digits(bounds::largest_length) +
                                    "; check \"units_in_meter\"");
    }
  }

  const ConfigNode& node_;
  std::string own_;  // begins messages
  const PatternUnits& units_;
  ConfigErrors& errors_;
  const std::size_t before_;
  PanelParameters p_;
  ReadPanel read_;
  std::vector<Vector2d> vertices_;
  std::vector<std::string> vertex_names_;
  std::map<std::string, int> named_vertices_;
  std::vector<std::pair<int, int>> ends_;  // vertices of each written edge
};

}  // namespace

std::vector<NamedNode> named_nodes(const ConfigNode& node, const std::string& kind, ConfigErrors& errors) {
  std::vector<NamedNode> all;
  std::set<std::string> names;
  if (node.is_scalar()) errors.push_back({node.where, kind + "must be a list or a map, not " + node.shown()});
  for (const ConfigNode& item : node.items) all.push_back({"", &item, item.where});
  for (std::size_t i = 0; i < node.entries.size(); ++i) {
    const auto& [name, value] = node.entries[i];
    all.push_back({name, &value, node.key_locations[i]});
    if (!name.empty() && !names.insert(name).second)
      errors.push_back({all.back().where, kind + excerpt(name) + " is given twice; rename one"});
  }
  return all;
}

std::optional<int> ReadPanel::edge_of(const ConfigNode& node, const std::string& user,
                                      ConfigErrors& errors) const {
  if (const auto named = named_edges.find(node.scalar); named != named_edges.end()) return named->second;
  const auto number = parse_integer(node.scalar);
  if (number && *number >= 0 && *number < std::ssize(parts)) return *number;
  std::vector<std::string> names;
  for (const std::string& name : edge_names)
    if (!name.empty()) names.push_back(name);
  const std::string range = "edges go from 0 to " + std::to_string(parts.size() - 1);
  errors.push_back(
      {node.where, user + ": panel " + excerpt(panel.name) + " has no edge " + node.shown() + "; " +
                       did_you_mean(node.scalar, names, names.empty() ? range : "it has " + listed(names))});
  return std::nullopt;
}

std::optional<ReadPanel> read_panel(const std::string& name, const ConfigNode& node,
                                    const PatternUnits& units, ConfigErrors& errors) {
  return PanelReader(name, node, units, errors).read();
}

}  // namespace drape
