#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/app/experiment/cloth.h"
#include "core/app/experiment/declared_metrics.h"
#include "core/app/experiment/read_experiment.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/registry.h"

namespace drape {

namespace {

/// Whether a solver has the experiment's `newton`, or another of its own.
bool has_newton(const Schema& solver) {
  static const Schema common = schema_of<NewtonParameters>();
  const Parameter* newton = parameter_named(solver, "newton");
  return newton && newton->section &&
         std::ranges::equal(newton->section->parameters, common.parameters, {}, &Parameter::name,
                            &Parameter::name);
}

/// Gives a solver's `newton` what the experiment's own sets and the solver's does not.
void take_newton(const ConfigNode& common, ConfigNode& solver) {
  ConfigNode* own = solver.find("newton");
  ConfigNode& newton = own ? *own : solver.add("newton", {});
  if (newton.kind != ConfigNode::Kind::map && newton.kind != ConfigNode::Kind::null) return;  // is refused
  for (const auto& [key, value] : common.entries)
    if (!newton.find(key)) newton.add(key, value);
}

/// Leaves out of a resolved solver's `newton` what it shares with the experiment's, so that a change of the
/// latter in a saved experiment reaches the solver.
void leave_out_shared(const ConfigNode& common, ConfigNode& solver) {
  ConfigNode own = *solver.find("newton");
  for (const auto& [key, value] : common.entries)
    if (const ConfigNode* same = own.find(key); same && same->one_line() == value.one_line()) own.remove(key);
  solver.remove("newton");
  if (!own.entries.empty()) solver.add("newton", own);
}

/// The name that a plugin gives itself, else its type.
std::string label_of(const ConfigNode& node) {
  const ConfigNode* name = node.find("name");
  return name && name->is_scalar() ? name->scalar : node.plugin_name();
}

/// Sets `coarsen` by the number of vertices that the coarsest level should have.
void set_coarsen(Experiment& e, ConfigErrors& errors) {
  HierarchyParameters& hierarchy = e.parameters.hierarchy;
  if (hierarchy.coarsest == 0) return;
  const int asked = std::exchange(hierarchy.coarsen, 0);
  const std::vector<double> vertices = estimated_vertices(e.parameters);
  if (vertices.empty()) return;  // checked_cloth reports what is wrong
  hierarchy.coarsen =
      std::clamp(static_cast<int>(std::lround(std::log2(vertices[0] / hierarchy.coarsest) / 2)), 0, 8);
  if (asked > 0 && asked != hierarchy.coarsen)
    errors.push_back({e.location_of("hierarchy"), "\"hierarchy\" asks for " + std::to_string(asked) +
                                                      " coarser levels by \"coarsen\", and for " +
                                                      std::to_string(hierarchy.coarsen) +
                                                      " by \"coarsest\"; give one of them"});
  set_path(e.resolved, "hierarchy.coarsen", ConfigNode::of(hierarchy.coarsen));
}

void make_refiner(Experiment& e, ConfigErrors& errors) {
  set_coarsen(e, errors);
  ConfigNode& node = e.parameters.refiner;
  const HierarchyParameters& hierarchy = e.parameters.hierarchy;
  const bool coarsens = hierarchy.coarsen > 0 || hierarchy.multigrid || hierarchy.coarsest > 0;
  // Flat pieces are refined at edge midpoints.
  if (node.kind == ConfigNode::Kind::null)
    node = ConfigNode::of(coarsens ? "coarsen" : e.parameters.cloth.is_sewn() ? "midpoint" : default_refiner);
  if ((hierarchy.coarsen > 0 || hierarchy.coarsest > 0) && !e.source.find("levels")) {
    e.parameters.levels = 1;
    set_path(e.resolved, "levels", ConfigNode::of(e.parameters.levels));
  }
  ConfigNode resolved;
  e.refiner = make_from<Refiner>(*e.registry, node, errors, &resolved);
  set_path(e.resolved, "refiner", resolved);
}

void check_metrics(const Experiment& e, ConfigErrors& errors) {
  const Location where = e.location_of("metrics");
  try {
    check_declarations(declared_metrics(e.metrics), where, errors);
  } catch (...) {
    errors.push_back({where, "a metric's declaration: " + message_in_flight()});
  }
}

void check_reference(const Experiment& e, const std::set<std::string>& methods, ConfigErrors& errors) {
  const ReferenceParameters& reference = e.parameters.reference;
  const auto refuse = [&](const std::string& what) {
    errors.push_back({e.location_of("reference"), "\"reference\" " + what});
  };
  const bool lowest = reference.method == ReferenceParameters::lowest;
  if (!reference.method.empty() && !reference.file.empty())
    refuse("takes either a method or a file, not both");
  else if (lowest && methods.count(reference.method))
    refuse("takes the word lowest for the lowest state of all methods; give the method of that name another");
  else if (!reference.method.empty() && !lowest && !methods.count(reference.method))
    refuse("must be one of the methods, or lowest, not \"" + excerpt(reference.method) + "\"");
  else if (reference.method.empty() && reference.force_tolerance > 0)
    refuse("needs the method whose finest state is solved further, as in {method: " +
           (methods.empty() ? "newton" : *methods.rbegin()) + ", force_tolerance: 1e-5}");
}

void make_methods(Experiment& e, ConfigErrors& errors) {
  const ConfigNode& methods = e.parameters.methods;
  const ConfigNode* common = e.source.find("newton");
  ConfigErrors faults;  // reported with the experiment's own keys
  NewtonParameters read;
  if (common) schema_of<NewtonParameters>().read(&read, *common, faults);
  const bool common_is_valid = common && faults.empty();
  if (methods.kind != ConfigNode::Kind::map || methods.entries.empty()) {
    if (e.source.find("methods"))
      errors.push_back({methods.where,
                        "\"methods\" must be a map of at least one method, as in "
                        "\"methods: {pcs: {}, newton: {}}\""});
    return;
  }
  ConfigNode resolved_map;
  std::set<std::string> names;
  for (const auto& [name, written] : methods.entries) {
    ConfigNode node = written.as_map("type");
    const bool is_map = node.kind == ConfigNode::Kind::map || node.kind == ConfigNode::Kind::null;
    if (is_map && !node.find("type")) {
      ConfigNode type = ConfigNode::of(name);
      type.where = written.where;
      node.add("type", type);
    }
    ConfigNode resolved;
    check_name("method", name, written.where, errors);
    if (name == all_methods)
      errors.push_back({written.where,
                        "\"all\" cannot name a method, since --method all runs every one; "
                        "rename it"});
    if (!names.insert(name).second)
      errors.push_back(
          {written.where, "method \"" + excerpt(name) + "\" is given twice; rename one of them"});
    const RegistryEntry* solver_entry = e.registry->find("solver", node.plugin_name());
    if (common_is_valid && solver_entry && has_newton(solver_entry->schema)) take_newton(*common, node);
    if (auto solver = make_from<Solver>(*e.registry, node, errors, &resolved)) {
      if (has_newton(solver_entry->schema)) leave_out_shared(*e.resolved.find("newton"), resolved);
      e.methods.emplace_back(name, std::move(solver));
    }
    resolved_map.add(name, resolved);
  }
  set_path(e.resolved, "methods", resolved_map);
  check_reference(e, names, errors);
}

}  // namespace

void make_plugins(Experiment& e, ConfigErrors& errors) {
  ConfigNode energies(ConfigNode::Kind::list), metrics(ConfigNode::Kind::list);
  constexpr std::size_t most_energies = 50;
  if (const std::size_t count = e.parameters.energies.size(); count > most_energies)
    return errors.push_back(
        {e.location_of("energies"), "\"energies\" has " + std::to_string(count) + " entries, of at most " +
                                        std::to_string(most_energies) +
                                        "; one constant_load can have the forces of many \"points\""});
  for (const ConfigNode& node : e.parameters.energies) {
    if (auto energy = make_from<Energy>(*e.registry, node, errors, &energies.items.emplace_back()))
      e.energies.push_back({label_of(node), std::move(energy)});
  }
  set_path(e.resolved, "energies", energies);
  const ConfigNode* written = e.source.find("energies");
  if (written && written->kind == ConfigNode::Kind::list && written->items.empty())
    errors.push_back({written->where,
                      "\"energies\" must name at least one energy, as in "
                      "\"energies: [neo_hookean, hinge, gravity]\""});

  make_refiner(e, errors);
  make_contacts(e, errors);

  if (!e.source.find("metrics"))
    for (const std::string& name : default_metrics(*e.registry))
      e.parameters.metrics.push_back(ConfigNode::of(name));
  std::set<std::string> measured;
  for (const ConfigNode& node : e.parameters.metrics) {
    if (!measured.insert(node.plugin_name()).second)
      errors.push_back({node.where, "\"metrics\" lists " + excerpt(node.plugin_name()) +
                                        " twice, whose values have one place in the results"});
    if (auto metric = make_from<Metric>(*e.registry, node, errors, &metrics.items.emplace_back()))
      e.metrics.emplace_back(node.plugin_name(), metric);
  }
  check_metrics(e, errors);
  set_path(e.resolved, "metrics", metrics);
  make_methods(e, errors);
}

}  // namespace drape
