#include "core/app/experiment/dress.h"

#include "core/app/experiment/experiment.h"
#include "core/app/experiment/experiment_path.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/placement.h"

namespace drape {

namespace {

/// Keys of `dress` that are the obstacle's.
constexpr const char* placement_keys[] = {"unit", "up", "scale", "rotate", "translate"};
/// The name of a body that `dress` reads.
constexpr const char* body_name = "body";

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
  d.add("friction", &DressParameters::friction,
        "friction that acts from the beginning, while the body grows and the garment is sewn, for a cover "
        "that would spring off; without it none acts at first, and a garment that slides off while it is "
        "sewn is sewn again with the experiment's `friction`")
      .between(0, bounds::largest_friction)
      .only_with("obstacle");
  d.add("largest_stretch", &DressParameters::largest_stretch,
        "a garment is too tight, and not solved any further, if more than a tenth of the area of one of its "
        "pieces is stretched beyond this once it is sewn, 0.5 by half; null: it is solved, and its message "
        "says which piece is stretched by more than half")
      .between(0.01, 10)
      .only_with("obstacle");
  d.add("worn", &DressParameters::worn,
        "whether it is an error, and not a warning, if no part of the body passes through one of the "
        "garment's openings, at the start or at the end")
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

void check_dress(const Experiment& e, ConfigErrors& errors) {
  const ExperimentParameters& p = e.parameters;
  if (!p.dress.is_asked()) return;
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
  const std::string body = "obstacles." + p.dress.obstacle;
  if (!value_at(e.resolved, body))
    refuse("dress", "names an obstacle \"" + excerpt(p.dress.obstacle) + "\", and there is none");
  else if (const ConfigNode* own = value_at(e.resolved, body + ".contraction"); !own || !own->is_number())
    refuse("dress", "shrinks its body, and the obstacle \"" + excerpt(p.dress.obstacle) +
                        "\" has no \"contraction\"; take one with a \"mesh\"");
}

}  // namespace drape
