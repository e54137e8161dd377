#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/app/scene/scene.h"
#include "core/kernel/interfaces/contact_model.h"

namespace drape {

/// An obstacle, and its gap at the coarsest level's start.
struct ObstacleSummary {
  ObstacleGap gap;
  Eigen::Vector3d size;  ///< of its bounding box [m]
  double drop = 0;       ///< how high the cloth's lowest vertex is above it [m]
  double beside = 0;     ///< horizontal distance of the cloth's centre of mass from the middle of its box [m]
  double over = 0;       ///< part of the cloth's mass that is above or below its box [1]
};

/// The quantities of a scene that a person can judge, and that a wrong unit or axis changes.
struct SceneSummary {
  Eigen::Vector3d size;           ///< of the rest shape's bounding box on the coarsest level [m]
  int parts = 0;                  ///< number of connected parts
  double obstacle_triangles = 0;  ///< of all obstacles' meshes
  int level = 0;                  ///< the finest, whose edges at rest these are [m]:
  double shortest_edge = 0, median_edge = 0, longest_edge = 0;
  double mass = 0;  ///< [kg]
  /// (D/(ρ d g))^⅓ [m], D the sum of Energy::plate_stiffness; none without it or uniform gravity
  std::optional<double> bending_length;
  double start_stretch = 1;  ///< median of start over rest length of the coarsest level's edges [1]
  double dhat = 0;           ///< the largest d̂ of the contact models [m]; 0 without one
  std::vector<ObstacleSummary> obstacles;
  /// The obstacle with the smallest gap; the end without any.
  std::vector<ObstacleSummary>::const_iterator nearest() const {
    return std::ranges::min_element(obstacles, {}, [](const ObstacleSummary& o) { return o.gap.gap; });
  }
  bool is_centre_over = false;  ///< the centre of mass is over or below the box around all obstacles
  std::string enclosing;        ///< an obstacle inside which a part of the cloth starts; "" without one
};

SceneSummary summary_of(const Scene& scene);

/// Seconds that PCS takes to bring the scene's cloth to rest on a mesh of `vertices` vertices, those of
/// coarser levels included, on one core of `estimate_processor`; none without a bending length. A fit to
/// docs/results/speed.md's record of every scene, which it meets within a factor of 3.
std::optional<double> estimated_seconds(const SceneSummary& summary, double vertices);
inline constexpr const char* estimate_processor = "an AMD EPYC (AVX-512)";

/// The median length of a level's edges [m], of flat pieces as they are placed.
double median_edge(const Level& level);
/// The median length of a level's edges at rest [m].
double median_rest_edge(const Level& level);

/// One line such as "0.62 × 0.7 m, 1 part, edges 8–31 mm, 0.19 kg, bending length 12 mm (2.1 edges), d̂ 1 mm
/// (0.04 edges), starts 20 mm above body". Leaves out what the scene does not have.
std::string text_of(const SceneSummary& summary);

/// The extents of a bounding box; without the third, if it is flat: "0.62 × 0.7 m".
std::string size_text(const Eigen::Vector3d& size);

/// A length with two significant digits, in millimetres below 0.1 m: "31 mm", "0.25 m".
std::string length_text(double length);

/// A number with `digits` significant digits and without exponent, from 1e-4 to 1e15.
std::string rounded_text(double value, int digits);
/// "(0.5, 0, 1)"
std::string point_text(const Eigen::Vector3d& p);

/// A warning for every quantity of a scene that is outside any fabric's range, as after a mistake with a
/// unit: where it is set, what is usual, and what to do. None of them keeps an experiment from running.
ConfigErrors plausibility_warnings(const Experiment& experiment, const Scene& scene,
                                   const SceneSummary& summary);

/// A warning for the measured numbers of the material that no energy of the scene reads, with edges of this
/// length [m]: a mistake in the choice of energies.
ConfigErrors unread_measures(const Experiment& experiment, double edge);

/// Appends an error for every level at whose start an energy or a force is not finite.
void refuse_infinite_energies(const Experiment& experiment, const Scene& scene, ConfigErrors& errors);

}  // namespace drape
