#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"

namespace drape {

/// An edge of a panel in its plane: a line, a Bézier curve of degree two or three, or an arc of a circle,
/// over the parameter t from 0 to 1 [m].
class EdgeCurve {
 public:
  /// A Bézier curve of two (a line), three or four control points, the first and last of which are its ends.
  static EdgeCurve bezier(std::vector<Eigen::Vector2d> points);

  /// The arc from one point to another whose angle grows from its start, seen along +z, if it is
  /// `counter_clockwise`; `large` takes that of more than half a turn. A radius below half the distance,
  /// which no arc has, counts as that.
  static EdgeCurve arc(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius, bool large,
                       bool counter_clockwise);

  Eigen::Vector2d at(double t) const;
  double length() const { return lengths_.back(); }
  /// The point after a length along the curve, from 0 to length().
  Eigen::Vector2d at_length(double s) const { return at(parameter(s)); }
  /// The curve between two lengths along it.
  EdgeCurve between(double from, double to) const;
  bool is_line() const { return points_.size() == 2; }

 private:
  EdgeCurve() = default;
  Eigen::Vector2d derivative(double t) const;
  void measure();
  double parameter(double s) const;

  std::vector<Eigen::Vector2d> points_;       // control points; of an arc only its centre
  double radius_ = 0, start_ = 0, turn_ = 0;  // of an arc; angles in radians
  std::vector<double> lengths_;               // from the start to t = k / (size - 1)
};

/// One edge of a panel's outline or of a hole.
struct PanelEdge {
  std::string name;  ///< as messages call it: its name, or its number from 0
  EdgeCurve curve;
  std::optional<std::string> label;  ///< selects its vertices for pins
  Location where;                    ///< in the pattern's file
};

/// A flat piece of cloth that is cut along closed loops of edges, and where it is placed.
struct Panel {
  std::string name;
  std::vector<PanelEdge> edges;
  std::vector<std::vector<int>> loops;   ///< edges, each of which begins where the last ends; then the holes
  Eigen::Vector3d rotation{0, 0, 0};     ///< about x, then y, then z [degree]
  Eigen::Vector3d translation{0, 0, 0};  ///< applied after it [m]
  double grain = 0;  ///< direction of warp, from the panel's y axis counter-clockwise as it is drawn [degree]
  Location where;
};

/// The area that a loop of these edges encloses [m²]; negative where it runs clockwise.
double area_of(const std::vector<int>& loop, const std::vector<PanelEdge>& edges);

/// An edge of a panel, by their indices.
struct EdgeIndex {
  int panel = 0, edge = 0;
};

/// Two chains of edges that are sewn to one another. The first chain's edges run along the seam, those of the
/// second against it, or along it as well if `right_wrong`: then one panel's right side lies on the other's
/// wrong side.
struct Seam {
  std::string name;
  std::array<std::vector<EdgeIndex>, 2> sides;
  bool right_wrong = false;
  /// The largest difference of the sides' lengths, as a part of the longer one. Without it they may differ by
  /// 0.8, five to one, or by two edges of the mesh.
  std::optional<double> ease;
  Location where;
};

/// A garment as it is cut and sewn, in metres; the right side of a panel is seen where its outline runs
/// counter-clockwise.
struct Pattern {
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  double unit = 1;       ///< that of its file [m]
  std::string up = "y";  ///< axis of the placement that points up, "y" or "z"

  const PanelEdge& edge(const EdgeIndex& i) const { return panels[i.panel].edges[i.edge]; }
  /// The length of a chain of edges [m].
  double length(const std::vector<EdgeIndex>& chain) const;
  /// By how much the lengths of a seam's sides differ, as a part of the longer one.
  double gathered(const Seam& seam) const;
};

}  // namespace drape
