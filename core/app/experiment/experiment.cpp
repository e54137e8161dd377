#include "core/app/experiment/experiment.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <tuple>

#include "core/app/experiment/cloth.h"
#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/fabrics.h"
#include "core/app/experiment/read_experiment.h"
#include "core/app/experiment/sewn_cloth.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/registry.h"
#include "core/numerics/elements/orthotropic_stiffness.h"

namespace drape {

namespace {

/// Refuses what the cloth would not read: a seed without random numbers, and one of `vertices` and `columns`
/// with `rows`, which count the same. A default, which a saved config has, stays.
void check_cloth_keys(const Experiment& e, ConfigErrors& errors) {
  const ClothParameters& c = e.parameters.cloth;
  const ConfigNode* cloth = e.source.find("cloth");
  if (!cloth) return;
  const auto refuse = [&](const std::string& key, const std::string& why) {
    if (const ConfigNode* written = cloth->find(key))
      errors.push_back({written->where, "\"" + key + "\" in cloth is not read " + why});
  };
  const bool grid = c.shape == "square" || c.shape == "rectangle",
             random = grid && c.triangulation == "random";
  if (c.seed != ClothParameters().seed && c.shape != "polygon" && !random && !c.is_meshed_anew())
    refuse("seed",
           "by this cloth; it is that of \"triangulation: random\", of a polygon or of a file that "
           "\"vertices\" or \"edge_length\" mesh anew");
  if (c.vertices && c.edge_length) refuse("edge_length", "beside \"vertices\"; leave one out");
  if (!c.is_sewn() && (c.seams.angle != 0 || c.seams.stiffness != 1))
    refuse("seams", "by this cloth; only flat pieces have them (\"rest: uv\" or \"shape: pattern\")");
  if (!grid) return;
  if (random) {
    const std::string why = "with \"triangulation: random\"; \"vertices\" counts them";
    if (c.columns > 0) refuse("columns", why);
    if (c.rows > 0) refuse("rows", why);
  } else if ((c.triangulation == "equilateral" ? c.columns > 0 || c.rows > 0 : c.columns > 0 && c.rows > 0) &&
             c.vertex_count() != ClothParameters().vertex_count()) {
    refuse("vertices", "beside \"columns\" and \"rows\"; leave it out, or set them to 0");
  }
}

/// `unit` and `up` of a start without a file would not be read.
void check_start_coordinates(const Experiment& e, ConfigErrors& errors) {
  const StartParameters& start = e.parameters.start;
  if (!start.file.empty() || (!start.unit && !start.up)) return;
  const std::string key = start.unit ? "unit" : "up";
  errors.push_back({e.source.find("start")->find(key)->where,
                    "\"" + key +
                        "\" in start says how its \"file\" is read, and it has none; leave it out, "
                        "or set it in cloth if the cloth is of a file"});
}

/// A schedule without keys would not be read.
void check_schedule(const Experiment& e, ConfigErrors& errors) {
  const ScheduleParameters& s = e.parameters.schedule;
  if (s.keys.empty() && (s.duration > 0 || s.steps > 1 || s.equilibrate))
    errors.push_back(
        {e.location_of("schedule"),
         "\"schedule\" has no \"keys\", so that nothing would change; give it some, or leave it out"});
}

}  // namespace

void check_material(const Experiment& e, ConfigErrors& errors) {
  const Material &m = e.parameters.material, plain;
  const ConfigNode* material = e.source.find("material");
  const auto refuse = [&](bool fault, const char* key, const std::string& message) {
    if (fault && material)
      errors.push_back({material->where_of(key), "\"" + std::string(key) + "\" " + message});
  };
  // A schedule's first value may be the default.
  const auto is_set = [&](const char* key, double value, double initial) {
    return value != initial || std::ranges::any_of(e.parameters.schedule.keys, [&](const ScheduleKey& k) {
             return k.parameter == "material." + std::string(key);
           });
  };
  refuse(m.warp_stiffness && is_set("membrane_modulus", m.membrane_modulus, plain.membrane_modulus),
         "membrane_modulus", "is not read beside \"warp_stiffness\"; leave one out");
  refuse(m.warp_bending && is_set("bending_modulus", m.bending_modulus, plain.bending_modulus),
         "bending_modulus", "is not read beside \"warp_bending\"; leave one out");
  try {
    plate_stiffness(m);
  } catch (const std::exception& error) {
    errors.push_back({e.location_of("material"), error.what()});
  }
}

void check_name(const std::string& what, const std::string& name, const Location& where,
                ConfigErrors& errors) {
  const bool usable = !name.empty() && name[0] != '.' && name[0] != '-' &&
                      printable(name, SIZE_MAX) == name && std::ranges::all_of(name, [](unsigned char c) {
                        return c >= 0x80 || std::isalnum(c) || c == '_' || c == '-' || c == '.';
                      });
  const std::string fault = fault_of_file_name(name);
  if (!usable || !fault.empty())
    errors.push_back({where, what + " \"" + excerpt(name) + "\" names files: " +
                                 (usable ? "it " + fault
                                         : "write it with letters, digits, \"_\", \"-\" and \".\", not "
                                           "beginning with \".\" or \"-\"")});
}

void sort_by_place(ConfigErrors& errors, const std::string& file) {
  std::stable_sort(errors.begin(), errors.end(), [&](const ConfigError& a, const ConfigError& b) {
    const auto order = [&](const Location& l) { return std::tuple(l.file != file, l.line, l.column); };
    return order(a.where) < order(b.where);
  });
}

bool is_sweep_source(const ConfigNode& source) {
  return source.find("base") || source.find("experiments") || source.find("ablation");
}

std::optional<Experiment> read_experiment(const std::filesystem::path& file, const Overrides& overrides,
                                          const Registry& registry, ConfigErrors& errors, LargeMemory large) {
  ConfigNode source = read_yaml(file, errors);
  if (errors.empty() && is_sweep_source(source))
    errors.push_back({{file.string(), 0, 0}, "is a sweep: `drape sweep` runs it, `drape check` checks it"});
  if (!errors.empty()) return std::nullopt;
  for (const Override& o : overrides) set_parameter(source, o.key, o.value, o.option, errors);
  for (const Override& o : overrides) refuse_scheduled(source, o.key, o.option, errors);
  return read_experiment(std::move(source), registry, errors, large);
}

std::optional<Experiment> read_experiment(ConfigNode source, const Registry& registry, ConfigErrors& errors,
                                          LargeMemory large) {
  Experiment e;
  e.source = std::move(source);
  e.source.name_keys();
  e.registry = &registry;
  set_first_keys(e.source);
  apply_fabric(e.source, errors);
  apply_dress(e.source, errors);
  e.parameters = parameters_of(e.source, errors);
  ConfigErrors size;
  if (e.parameters.cloth.shape == "pattern")
    refuse_too_large(e, LargeMemory::refused, size, vertices_in_outlines(e.parameters.cloth));
  if (size.empty() || large == LargeMemory::allowed)
    find_label_edges(e.source, e.parameters, errors);
  else
    errors.insert(errors.end(), size.begin(), size.end());
  e.resolved = node_of(e.parameters);
  if (const ConfigNode* name = e.source.find("name"); name && name->is_scalar())
    check_name("name", e.parameters.name, name->where, errors);
  check_cloth_keys(e, errors);
  check_start_coordinates(e, errors);
  check_schedule(e, errors);
  check_material(e, errors);
  make_plugins(e, errors);
  check_dress(e, errors);
  read_keys(e, errors);
  if (errors.empty()) return e;
  // The scene, which would append the faults of mesh files, cannot be built.
  if (!e.parameters.cloth.file.empty() && size.empty()) checked_cloth(e, errors);
  if (!e.parameters.start.file.empty()) start_mesh(e, errors);
  sort_by_place(errors, e.source.where.file);
  return std::nullopt;
}

std::vector<std::string> Experiment::method_names() const {
  std::vector<std::string> names;
  for (const auto& [name, solver] : methods) names.push_back(name);
  return names;
}

const Solver& Experiment::solver_of(const std::string& method) const {
  for (const auto& [name, solver] : methods)
    if (name == method) return *solver;
  throw std::logic_error("no method " + method);
}

std::string Experiment::solver_type(const std::string& method) const {
  return resolved.find("methods")->find(method)->plugin_name();
}

double Experiment::force_tolerance(const std::string& method) const {
  return newton_number(resolved, method, "force_tolerance").value_or(parameters.newton.force_tolerance);
}

std::optional<double> newton_number(const ConfigNode& config, const std::string& method, const char* key) {
  const ConfigNode* own = config.find("methods");
  for (const char* part : {method.c_str(), "newton", key}) own = own ? own->find(part) : own;
  const ConfigNode* common = config.find("newton");  // a method has what differs from it alone
  const ConfigNode* node = own ? own : common ? common->find(key) : nullptr;
  return node && node->is_number() ? std::optional(node->number) : std::nullopt;
}

std::vector<std::size_t> Experiment::obstacle_order() const {
  std::vector<std::size_t> order;
  for (const std::vector<std::size_t>& own : obstacles_of) order.insert(order.end(), own.begin(), own.end());
  return order;
}

std::vector<std::string> Experiment::obstacle_names() const {
  std::vector<std::string> names;
  for (const std::size_t i : obstacle_order()) {
    const ConfigNode* name = parameters.obstacles[i].find("name");
    names.push_back(name ? name->scalar : "");
  }
  return names;
}

std::string default_method(const std::vector<std::string>& methods) {
  if (is_one_of("pcs", methods)) return "pcs";
  return methods.size() == 1 ? methods[0] : "";
}

std::vector<std::string> chosen_methods(const Experiment& experiment, const std::vector<std::string>& asked) {
  std::vector<std::string> known = experiment.method_names();
  for (const std::string& name : asked)
    if (name != all_methods && !is_one_of(name, known))
      throw std::runtime_error("--method " + name + ": the experiment's methods are " + listed(known));
  if (is_one_of(all_methods, asked)) return known;
  if (asked.empty()) {
    const std::string name = default_method(known);
    if (name.empty())
      throw std::runtime_error("the experiment has no method pcs, which runs by default; name some of " +
                               joined(known) + " with --method, or run them all with --method all");
    return {name};
  }
  std::erase_if(known, [&](const std::string& name) { return !is_one_of(name, asked); });
  return known;
}

}  // namespace drape
