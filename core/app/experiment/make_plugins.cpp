#include "core/app/experiment/make_plugins.h"

#include <set>

#include "core/app/experiment/contact_configs.h"
#include "core/app/experiment/declared_metrics.h"
#include "core/app/experiment/method_choice.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/parameter_path.h"

namespace drape {

namespace {

ConfigNode scalar_node(const std::string& text) { return ConfigNode::of(text); }

/// Adds the entries of `base` that `over` lacks, also in maps within maps.
void fill_in(ConfigNode& over, const ConfigNode& base) {
  if (over.kind == ConfigNode::Kind::null) {
    const Location where = over.where;
    over = base;
    if (where.line > 0) over.where = where;
    return;
  }
  if (over.kind != ConfigNode::Kind::map || base.kind != ConfigNode::Kind::map) return;
  for (std::size_t i = 0; i < base.entries.size(); ++i) {
    const auto& [key, value] = base.entries[i];
    bool there = false;
    for (auto& [own_key, own_value] : over.entries)
      if (own_key == key) fill_in(own_value, value), there = true;
    if (!there) over.entries.emplace_back(key, value), over.key_locations.push_back(base.key_locations[i]);
  }
}

class PluginMaker {
 public:
  PluginMaker(const Registry& registry, ConfigErrors& errors, Experiment& experiment)
      : registry_(registry), errors_(errors), e_(experiment) {}

  void make_all() {
    ConfigNode energies, metrics;
    energies.kind = metrics.kind = ConfigNode::Kind::list;
    for (const ConfigNode& node : e_.parameters.energies)
      if (auto energy = make<Energy>(node, energies)) e_.energies.push_back({label_of(node), energy});
    set("energies", energies);
    const ConfigNode* written = e_.source.find("energies");
    if (written && written->kind == ConfigNode::Kind::list && written->items.empty())
      errors_.push_back({written->where,
                         "\"energies\" must name at least one energy, as in "
                         "\"energies: [neo_hookean, hinge, gravity]\""});

    make_refiner();
    make_contacts();

    if (!e_.source.find("metrics"))
      for (const RegistryEntry* entry : registry_.of_kind("metric"))
        e_.parameters.metrics.push_back(scalar_node(entry->name));
    for (const ConfigNode& node : e_.parameters.metrics)
      if (auto metric = make<Metric>(node, metrics)) e_.metrics.emplace_back(name_of(node), metric);
    check_metrics();
    set("metrics", metrics);
    make_methods();
  }

 private:
  void check_metrics() {
    const Location where = e_.location_of("metrics");
    try {
      check_declarations(declared_metrics(e_.metrics), where, errors_);
    } catch (const std::exception& error) {
      errors_.push_back({where, "a metric's declaration: " + reason_of(error)});
    }
  }

  static std::string name_of(const ConfigNode& node) {
    const ConfigNode* type = node.kind == ConfigNode::Kind::map ? node.find("type") : &node;
    return type ? type->scalar : "";
  }

  /// The name that a plugin gives itself, else its type.
  static std::string label_of(const ConfigNode& node) {
    const ConfigNode* name = node.kind == ConfigNode::Kind::map ? node.find("name") : nullptr;
    return name && name->kind == ConfigNode::Kind::scalar ? name->scalar : name_of(node);
  }

  /// Whether a solver declares the section that the experiment's own `newton` fills in.
  static bool takes_newton(const RegistryEntry* solver) {
    return solver && parameter_named(solver->schema, "newton");
  }

  template <class Interface>
  std::shared_ptr<Interface> make(const ConfigNode& node, ConfigNode& resolved_list) {
    ConfigNode resolved;
    auto object = make_from<Interface>(registry_, node, errors_, &resolved);
    resolved_list.items.push_back(resolved);
    return object;
  }

  void make_refiner() {
    const ConfigNode& node = e_.parameters.refiner;
    ConfigNode resolved;
    e_.refiner = make_from<Refiner>(registry_,
                                    node.kind == ConfigNode::Kind::null ? scalar_node(default_refiner) : node,
                                    errors_, &resolved);
    set("refiner", resolved);
  }

  void make_contacts() {
    ConfigNode models, obstacles;
    models.kind = obstacles.kind = ConfigNode::Kind::list;
    obstacles.items = e_.parameters.obstacles;
    const std::size_t before = errors_.size();
    const std::vector<ContactConfig> configs = contact_configs(registry_, e_.parameters, errors_);
    for (std::size_t i = before; i < errors_.size(); ++i)  // without "contact" they have only a key
      if (Location& where = errors_[i].where; where.line == 0 && e_.source.find(where.key))
        where = e_.location_of(where.key);
    for (const ContactConfig& config : configs) {
      e_.contacts.push_back(make<ContactModel>(config.node, models));
      split_resolved(registry_, config, models.items.back(), obstacles.items);
    }
    const bool is_list = e_.parameters.contact.kind == ConfigNode::Kind::list;
    set("contact", is_list ? models : models.items[0]);
    set("obstacles", obstacles);
  }

  void make_methods() {
    const ConfigNode& methods = e_.parameters.methods;
    const ConfigNode* common = e_.source.find("newton");
    if (methods.kind != ConfigNode::Kind::map || methods.entries.empty()) {
      if (e_.source.find("methods"))
        errors_.push_back({methods.where,
                           "\"methods\" must be a map of at least one method, as in "
                           "\"methods: {pcs: {}, newton: {}}\""});
      return;
    }
    ConfigNode resolved_map;
    std::set<std::string> names;
    for (const auto& [name, written] : methods.entries) {
      ConfigNode node = written;
      if (node.kind == ConfigNode::Kind::null) node.kind = ConfigNode::Kind::map;
      if (node.kind == ConfigNode::Kind::map) {
        if (!node.find("type")) {
          ConfigNode type = scalar_node(name);
          type.where = written.where;
          node.add("type", type);
        }
        if (common && takes_newton(registry_.find("solver", name_of(node)))) {
          ConfigNode base;
          base.add("newton", *common);
          fill_in(node, base);
        }
      }
      ConfigNode resolved;
      check_name("method", name, written.where, errors_);
      if (name == all_methods)
        errors_.push_back({written.where,
                           "\"all\" cannot name a method, since --method all runs every one; "
                           "rename it"});
      if (!names.insert(name).second)
        errors_.push_back(
            {written.where, "method \"" + excerpt(name) + "\" is given twice; rename one of them"});
      if (auto solver = make_from<Solver>(registry_, node, errors_, &resolved))
        e_.methods.emplace_back(name, solver);
      resolved_map.add(name, resolved);
    }
    set("methods", resolved_map);
    check_reference(names);
  }

  void check_reference(const std::set<std::string>& methods) {
    const ReferenceParameters& reference = e_.parameters.reference;
    const auto refuse = [&](const std::string& what) {
      errors_.push_back({e_.location_of("reference"), "\"reference\" " + what});
    };
    const bool lowest = reference.method == ReferenceParameters::lowest;
    if (!reference.method.empty() && !reference.file.empty())
      refuse("takes either a method or a file, not both");
    else if (lowest && methods.count(reference.method))
      refuse(
          "takes the word lowest for the lowest state of all methods; give the method of that name another");
    else if (!reference.method.empty() && !lowest && !methods.count(reference.method))
      refuse("must be one of the methods, or lowest, not \"" + excerpt(reference.method) + "\"");
    else if (reference.method.empty() && reference.force_tolerance > 0)
      refuse("needs the method whose finest state is solved further, as in {method: " +
             (methods.empty() ? "newton" : *methods.rbegin()) + ", force_tolerance: 1e-5}");
  }

  void set(const std::string& key, ConfigNode value) {
    for (auto& [own, old] : e_.resolved.entries)
      if (own == key) {
        old = std::move(value);
        return;
      }
    e_.resolved.add(key, std::move(value));
  }

  const Registry& registry_;
  ConfigErrors& errors_;
  Experiment& e_;
};

}  // namespace

void make_plugins(const Registry& registry, ConfigErrors& errors, Experiment& experiment) {
  PluginMaker(registry, errors, experiment).make_all();
}

}  // namespace drape
