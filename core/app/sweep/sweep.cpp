#include "core/app/sweep/sweep.h"

#include <algorithm>
#include <map>
#include <set>

#include "core/app/experiment/cloth.h"
#include "core/app/experiment/experiment_path.h"
#include "core/app/files/yaml_file.h"
#include "core/app/sweep/variations.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

constexpr std::size_t most_runs = 100'000;
constexpr std::size_t most_text = 500'000'000;  // [bytes] of all runs' experiments

/// Removes the methods that are not chosen from a resolved experiment, and the reference if it is one of
/// them.
void keep_methods(ConfigNode& resolved, const std::vector<std::string>& chosen) {
  const auto is_left_out = [&](const std::string& name) {
    return !chosen.empty() && !is_one_of(name, chosen);
  };
  ConfigNode methods;
  for (const auto& [name, method] : resolved.find("methods")->entries)
    if (!is_left_out(name)) methods.add(name, method);
  set_path(resolved, "methods", std::move(methods));
  const std::string& reference = resolved.find("reference")->find("method")->scalar;
  if (!reference.empty() && reference != ReferenceParameters::lowest && is_left_out(reference))
    set_path(resolved, "reference", ConfigNode::of(""));
}

/// The value at a path of a resolved experiment: of a plugin its type; null if the experiment has none.
Json setting_at(const ConfigNode& resolved, const std::string& path) {
  // A fabric has become numbers; its name stays as a record.
  const ConfigNode* node = value_at(resolved, path == "material.fabric" ? "material.from_fabric" : path);
  // A method's newton has what differs from the experiment's alone.
  const std::vector<std::string> words = split(path, '.');
  if (!node && words.size() == 4 && words[0] == "methods" && words[2] == "newton" &&
      value_at(resolved, "methods." + words[1]))
    node = value_at(resolved, "newton." + words[3]);
  if (!node) return nullptr;
  const ConfigNode* type = node->find("type");
  return json_value(type ? *type : *node);
}

/// Takes the numbers that the experiment has in the end: an option, a schedule's key or a later setting may
/// have replaced what the variation sets.
void take_final_numbers(const ConfigNode& resolved, Json& settings) {
  for (auto& [path, value] : settings.items())
    if (const ConfigNode* node = value.is_number() ? value_at(resolved, path) : nullptr;
        node && node->is_scalar())
      value = json_value(*node);
}

class Reader {
 public:
  Reader(const Registry& registry, ConfigErrors& errors, std::optional<int> most_levels)
      : registry_(registry), errors_(errors), most_levels_(most_levels) {}

  Sweep read(ConfigNode source) {
    sweep_.file = source.where.file;
    source_ = std::move(source);
    SweepParameters& p = sweep_.parameters;
    schema_of<SweepParameters>().read(&p, source_, errors_);
    if (source_.find("name")) check_name("name", p.name, source_.where_of("name"), errors_);
    check_seeds();
    check_settings(p.set, errors_);
    const std::vector<Variation> variations = variations_of(p.ablation, errors_);
    const std::size_t before = errors_.size();
    const std::vector<ExperimentSource> experiments = experiment_sources(p, source_, errors_);
    const std::size_t runs =
        experiments.size() * variations.size() * std::max<std::size_t>(p.seeds.size(), 1);
    if (runs > most_runs)
      errors_.push_back({source_.where_of(p.repeats ? "repeats" : "seeds"),
                         "the sweep has " + std::to_string(runs) + " runs, and may have " +
                             std::to_string(most_runs) + "; take fewer seeds, variations or experiments"});
    if (errors_.size() > before) return sweep_;
    for (const ExperimentSource& experiment : experiments)
      if (!experiment.label.empty()) keys_["experiment"] = nullptr;
    for (const Variation& variation : variations)
      for (const auto& [path, value] : variation.set.entries) keys_[path] = nullptr;
    for (const ExperimentSource& experiment : experiments)
      for (const Variation& variation : variations)
        if (text_ <= most_text) add_variation(experiment, labelled(variation, experiment.label));
    list_faults(experiments.size() * variations.size());
    return sweep_;
  }

 private:
  void check_seeds() {
    SweepParameters& p = sweep_.parameters;
    if (p.repeats && !p.seeds.empty()) {
      errors_.push_back(
          {source_.where_of("repeats"), "\"repeats\" and \"seeds\" are both given; keep one of them"});
      p.seeds.clear();
    }
    for (int k = 1; p.repeats && k <= *p.repeats; ++k) p.seeds.push_back(k);
    if (std::set<int>(p.seeds.begin(), p.seeds.end()).size() != p.seeds.size())
      errors_.push_back({source_.where_of("seeds"), "\"seeds\" names one of them twice"});
  }

  Variation labelled(Variation variation, const std::string& experiment) const {
    if (experiment.empty()) return variation;
    const bool alone = sweep_.parameters.ablation.kind == NodeKind::null;
    variation.name = alone ? experiment : experiment + ", " + variation.name;
    return variation;
  }

  void add_variation(const ExperimentSource& base, const Variation& variation) {
    const SweepParameters& p = sweep_.parameters;
    ConfigNode source = base.root;
    ConfigErrors faults;
    SweepRun run;
    run.name = variation.name;
    run.expect = variation.expect;
    run.settings = Json::object();
    if (!base.label.empty()) run.settings["experiment"] = base.label;
    for (const ConfigNode* set : {&p.set, &variation.set})
      for (std::size_t k = 0; k < set->entries.size(); ++k) {
        const auto& [path, value] = set->entries[k];
        const Location& where = set->key_locations[k];
        if (path == "start.seed" && !p.seeds.empty())
          faults.push_back({where, "\"start.seed\" is what the sweep's seeds set; take one of them out"});
        set_parameter(source, path, value, where, faults);
        if (set == &variation.set) run.settings[path] = json_value(value);
      }
    for (std::size_t k = 0; k < variation.set.entries.size(); ++k)
      refuse_scheduled(source, variation.set.entries[k].first, variation.set.key_locations[k].text(), faults);
    const bool own = !variation.methods.empty();
    const std::vector<std::string>& methods = own ? variation.methods : p.methods;
    if (own) run.settings["methods"] = methods;
    auto experiment = read_experiment(source, registry_, faults);
    if (experiment && most_levels_ && experiment->parameters.level_count() > *most_levels_) {
      set_path(source, "levels", ConfigNode::of(*most_levels_), source_.where, faults);
      experiment = read_experiment(std::move(source), registry_, faults);
    }
    if (experiment) {
      take_final_numbers(experiment->resolved, run.settings);
      check_methods(*experiment, methods, own ? variation.methods_where : source_.where_of("methods"),
                    faults);
      if (p.seeds.size() > 1 && experiment->parameters.start.perturbation == 0)
        faults.push_back({source_.where_of(p.repeats ? "repeats" : "seeds"),
                          "every seed gives the same run where \"start.perturbation\" is 0; set it, as in "
                          "\"set: {start.perturbation: 1e-3}\""});
    }
    for (const ConfigError& fault : faults) note(fault, variation.name);
    if (faults.empty()) add_runs(*experiment, methods, variation, run);
  }

  static void check_methods(const Experiment& experiment, const std::vector<std::string>& chosen,
                            const Location& where, ConfigErrors& errors) {
    const std::vector<std::string> known = experiment.method_names();
    for (const std::string& name : chosen)
      if (!is_one_of(name, known))
        errors.push_back({where, "there is no method \"" + excerpt(name) +
                                     "\"; the experiment's methods are " + listed(known)});
  }

  void add_runs(const Experiment& experiment, const std::vector<std::string>& methods,
                const Variation& variation, SweepRun run) {
    const ExperimentParameters& e = experiment.parameters;
    ConfigNode resolved = experiment.resolved;
    keep_methods(resolved, methods);
    run.levels = e.levels;
    const std::vector<double> vertices = estimated_vertices(e);
    run.vertices = vertices.empty() ? 0 : vertices.back();
    std::vector<int> seeds = sweep_.parameters.seeds;
    if (seeds.empty()) seeds.push_back(e.start.seed);
    for (const auto& [key, value] : keys_.items())
      if (!run.settings.contains(key)) run.settings[key] = setting_at(resolved, key);
    for (const int seed : seeds) {
      set_path(resolved, "start.seed", ConfigNode::of(seed));
      run.seed = seed;
      run.folder = "runs/" + folder_name(variation.name) + "/seed_" + std::to_string(seed);
      run.config = to_yaml(resolved);
      if (seed == seeds.front()) text_ += seeds.size() * run.config.size();
      if (text_ > most_text) {
        errors_.push_back({source_.where, "the experiments of all runs have more than " +
                                              std::to_string(most_text / 1'000'000) +
                                              " MB of text together; take fewer seeds or variations, or "
                                              "have the experiment name less"});
        return;
      }
      if (seed == seeds.front() && first_unprintable(run.config) != run.config.npos)
        note({variation.where, "a file of it is in a folder whose name is no UTF-8; rename the folder"},
             run.name);
      if (seed == seeds.front())
        if (const auto [other, first] = configs_.emplace(run.config, run.name); !first)
          same_.push_back({variation.where, "variations \"" + other->second + "\" and \"" + run.name +
                                                "\" come to the same experiment; take one of them out"});
      sweep_.runs.push_back(run);
    }
  }

  void note(const ConfigError& fault, const std::string& variation) {
    auto& names = faulty_[fault.text()];
    if (names.empty()) faults_.push_back(fault);
    names.push_back(variation);
  }

  /// Every error once, with the variations that have it, in file order.
  void list_faults(std::size_t variations) {
    for (ConfigError& fault : faults_) {
      const auto& names = faulty_[fault.text()];
      if (names.size() < variations)
        fault.message += " (variation \"" + names[0] + "\"" +
                         (names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : "") + ")";
      errors_.push_back(fault);
    }
    if (errors_.empty()) errors_ = same_;
    sort_by_place(errors_, source_.where.file);
  }

  const Registry& registry_;
  ConfigErrors& errors_;
  std::optional<int> most_levels_;
  Sweep sweep_;
  Json keys_ = Json::object();  // that some variation sets, for which each run has a value
  std::size_t text_ = 0;        // [bytes] of the runs' experiments so far
  ConfigNode source_;
  ConfigErrors faults_, same_;
  std::map<std::string, std::vector<std::string>> faulty_;
  std::map<std::string, std::string> configs_;
};

}  // namespace

std::optional<Sweep> read_sweep(const std::filesystem::path& file, const Registry& registry,
                                ConfigErrors& errors, std::optional<int> most_levels) {
  ConfigNode source = read_yaml(file, errors);
  if (errors.empty() && source.find("cloth") && !is_sweep_source(source))
    errors.push_back({{file.string(), 0, 0}, "is an experiment: `drape run` runs it"});
  if (!errors.empty()) return std::nullopt;
  return read_sweep(std::move(source), registry, errors, most_levels);
}

std::optional<Sweep> read_sweep(ConfigNode source, const Registry& registry, ConfigErrors& errors,
                                std::optional<int> most_levels) {
  Sweep sweep = Reader(registry, errors, most_levels).read(std::move(source));
  if (!errors.empty()) return std::nullopt;
  return sweep;
}

}  // namespace drape
