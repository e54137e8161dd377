#include <algorithm>
#include <cmath>

#include "core/kernel/files/message_text.h"
#include "core/numerics/sewing/panel_meshes.h"

namespace drape {

namespace {

using Divisions = std::vector<std::vector<EdgeDivision>>;

long edges_along(double length, double edge_length) {
  return std::max(1L, std::lround(length / edge_length));
}

/// A chain of edges, one behind the other, by the length along all of them.
struct Chain {
  const Pattern& pattern;
  const std::vector<EdgeIndex>& edges;
  bool against = false;        ///< each edge runs against the chain
  std::vector<double> breaks;  ///< lengths at which its edges begin and end

  Chain(const Pattern& p, const Seam& seam, int side)
      : pattern(p), edges(seam.sides[side]), against(side == 1 && !seam.right_wrong), breaks{0} {
    for (const EdgeIndex& e : edges) breaks.push_back(breaks.back() + p.edge(e).curve.length());
  }
  double length() const { return breaks.back(); }

  /// Adds a stitch between two lengths of the chain to the edge that has both, at a part of the way.
  void add(double from, double to, double part, int stitch, Divisions& divisions) const {
    const double middle = (from + to) / 2;
    std::size_t k = 0;
    while (k + 2 < breaks.size() && breaks[k + 1] < middle) ++k;
    const double own = breaks[k + 1] - breaks[k];
    double s = std::clamp(from + part * (to - from) - breaks[k], 0.0, own);
    if (against) s = own - s;
    EdgeDivision& division = divisions[edges[k].panel][edges[k].edge];
    if (!division.stitches.empty() && division.stitches.back() == stitch) return;
    division.lengths.push_back(s), division.stitches.push_back(stitch);
  }
};

/// A place of a seam: its length along both chains.
struct Knot {
  double first, second;
};

/// The places where an edge of either chain ends. Ends of the two that are near to each other are one place,
/// so that no edge becomes short for the difference; other ends lie in proportion between those.
std::vector<Knot> knots_of(const Chain& first, const Chain& second, double edge_length) {
  const double near = edge_length / 2;
  std::vector<Knot> common;
  std::size_t next = 1;
  for (std::size_t i = 0; i < first.breaks.size(); ++i) {
    const bool end = i == 0 || i + 1 == first.breaks.size();
    if (end) {
      common.push_back({first.breaks[i], i == 0 ? 0 : second.length()});
      continue;
    }
    for (std::size_t j = next; j + 1 < second.breaks.size(); ++j)
      if (std::abs(first.breaks[i] / first.length() - second.breaks[j] / second.length()) *
              std::max(first.length(), second.length()) <
          near) {
        common.push_back({first.breaks[i], second.breaks[j]});
        next = j + 1;
        break;
      }
  }
  std::vector<Knot> all = common;
  const auto add_others = [&](const std::vector<double>& breaks, double Knot::*own, double Knot::*other) {
    for (const double at : breaks) {
      if (std::ranges::any_of(common, [&](const Knot& k) { return k.*own == at; })) continue;
      std::size_t k = 0;
      while (common[k + 1].*own < at) ++k;
      const Knot &before = common[k], &after = common[k + 1];
      Knot knot{};
      knot.*own = at;
      knot.*other =
          before.*other + (at - before.*own) / (after.*own - before.*own) * (after.*other - before.*other);
      all.push_back(knot);
    }
  };
  add_others(first.breaks, &Knot::first, &Knot::second);
  add_others(second.breaks, &Knot::second, &Knot::first);
  std::ranges::sort(all, {}, &Knot::first);
  return all;
}

void divide_seam(const Pattern& pattern, const Seam& seam, double edge_length, int& stitch,
                 Divisions& divisions, ConfigErrors& errors) {
  const Chain first(pattern, seam, 0), second(pattern, seam, 1);
  constexpr double usual = 0.8;  // gathers are drawn up to 5 to 1
  const double difference = pattern.gathered(seam);
  if (difference > seam.ease.value_or(usual) &&
      (seam.ease || std::abs(first.length() - second.length()) > 2 * edge_length))
    errors.push_back(
        {seam.where,
         "the sides of seam " + seam.name + " are " + three_digits(first.length() / pattern.unit) + " and " +
             three_digits(second.length() / pattern.unit) + " long in the file's unit, which differ by " +
             three_digits(100 * difference) + " % of the longer one; an ease of at most " +
             three_digits(100 * seam.ease.value_or(usual)) + " % is " + (seam.ease ? "declared" : "usual") +
             ": draw them alike, or write \"ease\" at the seam, or in cloth for all"});
  const std::vector<Knot> knots = knots_of(first, second, edge_length);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const Knot &a = knots[k], &b = knots[k + 1];
    const long count = edges_along(std::max(b.first - a.first, b.second - a.second), edge_length);
    for (long i = 0; i <= count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count);
      first.add(a.first, b.first, part, stitch + static_cast<int>(i), divisions);
      second.add(a.second, b.second, part, stitch + static_cast<int>(i), divisions);
    }
    stitch += static_cast<int>(count);
  }
  ++stitch;
}

}  // namespace

std::vector<std::vector<EdgeDivision>> divide_edges(const Pattern& pattern, double edge_length,
                                                    ConfigErrors& errors) {
  Divisions divisions;
  std::vector<std::vector<const Seam*>> seam_of;
  for (const Panel& panel : pattern.panels) {
    divisions.emplace_back(panel.edges.size());
    seam_of.emplace_back(panel.edges.size(), nullptr);
  }
  int stitch = 0;
  for (const Seam& seam : pattern.seams) {
    bool sewn_before = false;
    for (const auto& side : seam.sides)
      for (const EdgeIndex& e : side) {
        const Seam*& other = seam_of[e.panel][e.edge];
        if (other) {
          errors.push_back(
              {seam.where, "edge " + pattern.edge(e).name + " of panel " + pattern.panels[e.panel].name +
                               " is in seam " + seam.name +
                               (other == &seam ? " twice" : " and in seam " + other->name) +
                               "; an edge is sewn to one other: take one of them out, or make two "
                               "edges of it"});
          sewn_before = true;
        }
        other = &seam;
      }
    if (!sewn_before) divide_seam(pattern, seam, edge_length, stitch, divisions, errors);
  }
  for (std::size_t p = 0; p < divisions.size(); ++p)
    for (std::size_t e = 0; e < divisions[p].size(); ++e) {
      EdgeDivision& division = divisions[p][e];
      if (division.lengths.empty()) {
        const EdgeCurve& curve = pattern.panels[p].edges[e].curve;
        const long count = std::max(curve.is_line() ? 1L : 2L, edges_along(curve.length(), edge_length));
        for (long i = 0; i <= count; ++i)
          division.lengths.push_back(curve.length() * static_cast<double>(i) / static_cast<double>(count));
        division.stitches.assign(division.lengths.size(), -1);
      } else if (division.lengths.front() > division.lengths.back()) {
        std::ranges::reverse(division.lengths);
        std::ranges::reverse(division.stitches);
      }
    }
  return divisions;
}

}  // namespace drape
