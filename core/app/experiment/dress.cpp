#include "core/app/experiment/dress.h"

#include <algorithm>
#include <cmath>

#include "core/app/experiment/experiment.h"
#include "core/app/experiment/experiment_path.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/placement.h"

namespace drape {

namespace {

/// Keys of `dress` that are the obstacle's.
constexpr const char* placement_keys[] = {"unit", "up", "scale", "rotate", "translate"};
/// The name of a body that `dress` reads.
constexpr const char* body_name = "body";
/// The weight of the placed metric at the start, where a triangle without area still rests as one with some,
/// and in the last increment of sewing but one.
constexpr double first_weight = 0.99, least_weight = 1e-4;
/// A strain limit that limits nothing, where it begins, and the increments in which it comes down.
constexpr double loosest_limit = 100;
constexpr int limit_increments = 12;

}  // namespace

void DressParameters::declare(Declaration<DressParameters>& d) {
  d.add("body", &DressParameters::body,
        "mesh of the body (OBJ, OFF, PLY or STL), closed or open, relative to this file; it becomes the "
        "obstacle `body`")
      .path();
  declare_file_coordinates(d);
  declare_scale(d);
  declare_placement(d);
  for (Parameter& p : d.schema.parameters)
    if (p.name != "body") ParameterHandle(p).only_with("body");
  d.add("obstacle", &DressParameters::obstacle,
        "instead of `body`: the name of the obstacle that is the body, for one with keys of its own");
  d.add("growth", &DressParameters::growth,
        "increments in which the body grows to its size inside the garment")
      .between(1, 1000)
      .only_with("obstacle");
  d.add("sewing", &DressParameters::sewing,
        "increments in which the pieces go from the shape that they were placed in to their own")
      .between(1, 500)
      .only_with("obstacle");
  d.add("largest_stretch", &DressParameters::largest_stretch,
        "a garment is too tight, and refused, if more than a tenth of the area of one of its pieces is "
        "stretched beyond this once it is sewn; 0.5 is by half")
      .between(0.01, 10)
      .only_with("obstacle");
}

void apply_dress(ConfigNode& experiment, ConfigErrors& errors) {
  ConfigNode* section = experiment.find("dress");
  if (!section) return;
  ConfigNode dress = section->as_map("body");
  for (auto& [key, value] : dress.entries)
    if (key == "type") key = "body";  // of a shorthand that set_path has made a map
  const ConfigNode* written = dress.find("body");
  if (!written || written->scalar.empty()) return;
  const ConfigNode file = *written;
  if (const ConfigNode* other = dress.find("obstacle"); other && !other->scalar.empty())
    errors.push_back(
        {other->where, "\"dress\" takes either a \"body\" or the \"obstacle\" that is one, not both"});
  ConfigNode body;
  body.where = file.where;
  body.add("name", ConfigNode::of(body_name)).where = file.where;
  body.add("mesh", file);
  for (const char* key : placement_keys)
    if (const ConfigNode* own = dress.find(key)) {
      body.add(key, *own);
      dress.remove(key);
    }
  dress.remove("body");
  dress.remove("obstacle");
  dress.add("obstacle", ConfigNode::of(body_name));
  *section = dress;
  ConfigNode* obstacles = experiment.find("obstacles");
  if (!obstacles) {
    obstacles = &experiment.add("obstacles", ConfigNode(ConfigNode::Kind::list));
    obstacles->where = experiment.key_locations.back() = file.where;
  }
  obstacles->items.push_back(body);
}

void make_dressing_schedule(Experiment& e, ConfigErrors& errors) {
  ExperimentParameters& p = e.parameters;
  DressParameters& dress = p.dress;
  if (!dress.is_asked()) return;
  const auto refuse = [&](const std::string& key, const std::string& why) {
    errors.push_back({e.location_of(key), "\"dress\" " + why});
  };
  if (p.cloth.rest != "uv" && p.cloth.shape != "pattern")
    refuse("cloth", "needs a cloth of flat pieces, as of \"rest: uv\"");
  if (!p.schedule.keys.empty())
    refuse("schedule",
           "makes the schedule itself; leave \"schedule\" out, and move what is dressed in a second run: "
           "drape run --resume FOLDER --out OTHER --set dress={} --set schedule=…");
  if (!errors.empty()) return;
  const auto is_limit = [](const NamedEnergy& energy) { return energy.energy->role() == EnergyRole::limit; };
  dress.tightening = std::ranges::any_of(e.energies, is_limit) ? limit_increments : 0;
  const double grown = dress.growth, sewn = grown + dress.sewing, whole = sewn + dress.tightening + 1;
  const std::string body = "obstacles." + dress.obstacle;
  const auto add = [&](const std::string& parameter, const std::vector<double>& times,
                       const std::vector<double>& values,
                       KeyInterpolation interpolation = KeyInterpolation::linear) {
    ConfigNode written = parameter_detail::to_node(values);
    written.where = e.location_of("dress");
    p.schedule.keys.push_back({parameter, times, std::move(written), interpolation, {}, {}, 0});
  };
  add(body + ".contraction", {0}, {0});
  add(body + ".grown", {0, grown}, {0, 1});
  std::vector<double> times = {0}, weights = {first_weight};
  for (int k = 0; k <= dress.sewing; ++k) {
    times.push_back(grown + k);
    weights.push_back(
        k == dress.sewing ? 0 : first_weight * std::pow(least_weight, k / std::max(1.0, dress.sewing - 1.0)));
  }
  add("dress.placed", times, weights);
  add("dress.loads", {0, whole}, {0, 1}, KeyInterpolation::step);
  if (p.friction > 0) add("friction", {0, whole}, {0, p.friction}, KeyInterpolation::step);
  for (std::size_t k = 0; k < e.energies.size(); ++k) {
    if (!is_limit(e.energies[k])) continue;
    const std::string path = "energies." + std::to_string(k) + ".limit";
    const double limit = value_at(e.resolved, path)->number;
    std::vector<double> limit_times = {0}, limits = {loosest_limit};  // geometric above 1
    for (int i = 0; i <= dress.tightening; ++i) {
      limit_times.push_back(sewn + i);
      limits.push_back(1 + (loosest_limit - 1) *
                               std::pow((limit - 1) / (loosest_limit - 1), double(i) / dress.tightening));
    }
    limits.back() = limit;
    add(path, limit_times, limits);
  }
  p.schedule.steps = static_cast<int>(whole);
}

std::string dressing_phase(const DressParameters& dress, int increment) {
  if (increment == 0) return "start";
  if (increment <= dress.growth) return "growth";
  if (increment <= dress.growth + dress.sewing) return "sewing";
  if (increment <= dress.growth + dress.sewing + dress.tightening) return "limit";
  return increment == dress.growth + dress.sewing + dress.tightening + 1 ? "weight" : "";
}

}  // namespace drape
