// Whether a checkpoint's values fit the experiment. The checksum detects damage; these checks detect files
// that another program or another version of drape wrote.

#include <algorithm>
#include <stdexcept>

#include "core/app/files/json_file.h"
#include "core/app/run/checkpoint.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

/// Strictly ascending.
template <class Values, class Key>
bool ascends(const Values& values, const Key& key) {
  return std::adjacent_find(values.begin(), values.end(),
                            [&](const auto& a, const auto& b) { return !(key(a) < key(b)); }) == values.end();
}

class Check {
 public:
  Check(const Checkpoint& checkpoint, const Experiment& experiment, const Scene& scene)
      : c_(checkpoint), experiment_(experiment), scene_(scene) {}

  void all() const {
    methods();
    levels();
    if (c_.start.rows() > 0) positions(c_.start, c_.first_level, "where the methods begin");
    if (c_.state.under_way) under_way(*c_.state.under_way);
    recorder(c_.recorder);
  }

 private:
  static void require(bool fits, const std::string& what) {
    if (!fits)
      throw std::runtime_error("the checkpoint does not fit its experiment: " + what +
                               "; run the experiment again");
  }
  bool is_level(int level) const { return level >= 0 && level < scene_.hierarchy.level_count(); }

  void positions(const Positions& x, int level, const std::string& what) const {
    require(is_level(level) && x.rows() == scene_.hierarchy.levels[level].vertex_count(),
            what + ": not as many vertices as the level has");
    require(x.allFinite(), what + ": not finite");
  }

  void methods() const {
    require(c_.method >= 0 && c_.method < static_cast<int>(c_.methods.size()), "the method under way");
    const std::vector<std::string> known = experiment_.method_names();
    for (const std::string& name : c_.methods)
      require(is_one_of(name, known), "the experiment has no method " + name);
  }

  void levels() const {
    const MethodState& s = c_.state;
    require(is_level(c_.first_level), "the level that the methods begin with");
    require(s.level >= c_.first_level && (s.level == scene_.hierarchy.level_count() || is_level(s.level)),
            "the level under way");
    int last = -1;
    for (const LevelResult& level : s.finished) {
      require(level.level > last, "the levels are not in order");
      result(level);
      last = level.level;
    }
    require(s.finished.empty() || last == s.level - 1, "the level before the one under way");
  }

  void result(const LevelResult& r) const {
    positions(r.x, r.level, "the state of level " + std::to_string(r.level));
    require(
        r.steps >= 0 && r.iterations >= 0 && r.factorisations >= 0 && r.analyses >= 0 && r.saddles_left >= 0,
        "negative counts");
    stiffness(r.contact_stiffness, r.level);
    load_stepping(r.load_stepping);
  }

  void stiffness(const ContactStiffness& s, int level) const {
    require(s.empty() || s.size() == scene_.model(level)->contacts().size(), "the contacts' stiffness");
    for (const double own : s) require(own >= 0, "the contacts' stiffness");
  }

  void load_stepping(const LoadSteppingState& s) const {
    if (!scene_.load_stepping) return;
    require(s.increment >= 0 && s.increment <= scene_.load_stepping->increment_count() &&
                s.values.size() == scene_.load_stepping->state().values.size(),
            "the schedule's increment");
    require(s.kept.size() == scene_.load_stepping->state().kept.size(), "the states that the schedule keeps");
    for (const Positions& x : s.kept)
      require(x.rows() == 0 || std::ranges::any_of(scene_.hierarchy.levels,
                                                   [&](const Level& level) {
                                                     return x.rows() == level.vertex_count() && x.allFinite();
                                                   }),
              "the states that the schedule keeps");
  }

  void under_way(const NewtonState& s) const {
    const int level = c_.state.level, n = static_cast<int>(s.so_far.x.rows());
    require(s.so_far.level == level, "the level under way");
    result(s.so_far);
    // The load under way may pin more vertices than the first: DirichletEnforcer checks against its number.
    for (const int k : s.dirichlet.unsatisfied) require(k >= 0 && k < n, "a Dirichlet vertex out of range");
    const int blend = s.step.factor.blend;
    require(s.step.controller.step_size > 0 && s.step.max_iterations > 0 &&
                s.step.factor.fallback_solves >= 0 && blend >= 0 && blend < HessianModification::blend_count,
            "the settings of the step");
    require(s.check.strictness >= 1 && s.check.slack >= 1 && s.saddle_exit.exits >= 0,
            "the exit from a saddle");
    for (const Positions* x : {&s.load_stepper.response.from, &s.load_stepper.response.predicted})
      if (x->rows() > 0) positions(*x, level, "the response to an increment");
    contacts(s.contacts, level);
    const HessianAssembler::ExtraPattern& extra = s.step.factor.pattern.extra;
    require(extra.blocks.size() == extra.idle.size() &&
                ascends(extra.blocks, [](const auto& block) { return block; }),
            "the matrix's pattern");
    for (const auto& [i, j] : extra.blocks) require(i >= 0 && i < j && j < n, "the matrix's pattern");
    factor(s.step.factor, n);
  }

  void contacts(const ContactMemory& memory, int level) const {
    const BoundContacts& models = scene_.model(level)->contacts();
    if (models.empty()) return;
    for (const Positions* x : {&memory.reference, &memory.candidates_begin, &memory.candidates_end})
      positions(*x, level, "the contacts");
    require(memory.tangential_displacements.size() == models.size(),
            "the contacts' tangential displacements");
    require(memory.stiffness.size() == models.size(), "the contacts' stiffness");
    stiffness(memory.stiffness, level);
    for (const TangentialDisplacements& displacements : memory.tangential_displacements)
      require(ascends(displacements, [](const TangentialDisplacement& d) { return d.contact; }),
              "the contacts' tangential displacements");
    const LagDamping& damping = memory.damping;
    require(damping.fraction > 0 && damping.fraction <= 1 &&
                (damping.lag.size() == models.size() || (damping.lag.empty() && damping.fraction == 1)),
            "the lag of friction");
    const int n = scene_.hierarchy.levels[level].vertex_count();
    for (const FrictionContacts& groups : damping.lag)
      for (const auto& group : groups)
        for (const FrictionContact& contact : group)
          for (const int v : contact.vertices) require(v >= -1 && v < n, "the lag of friction");
  }

  void factor(const FactorCache::State& s, int n) const {
    const BlockCholesky::Analysis& a = s.analysis;
    require(a.count >= 0, "the factor's ordering");
    if (a.count == 0) return;
    if (a.fixed.empty() && a.ordering.empty() && a.reused_ordering.empty()) return;
    require(static_cast<int>(a.fixed.size()) == n, "the factor's ordering");
    std::vector<int> free;
    for (int v = 0; v < n; ++v)
      if (!a.fixed[v]) free.push_back(v);
    for (const std::vector<int>* ordering : {&a.reused_ordering, &a.ordering}) {
      std::vector<int> sorted = *ordering;
      std::sort(sorted.begin(), sorted.end());
      require(sorted.empty() || sorted == free, "the factor's ordering");
    }
  }

  void recorder(const Recorder::State& s) const {
    const Json results = parse_json(s.results);
    const Json& entries = member_of(results, "methods");
    require(entries.is_object(), "results.json as it was");
    for (const auto& [name, method] : entries.items())
      require(member_of(method, "levels").is_array() && member_of(method, "seconds").is_number() &&
                  member_of(method, "peak_memory_bytes").is_number(),
              "results.json as it was, of method " + name);
    require(s.method.empty() || (entries.contains(s.method) && s.method == c_.methods[c_.method] &&
                                 entries[s.method]["levels"].size() == c_.state.finished.size()),
            "results.json as it was, of the method under way");
    if (!s.last_load.values.empty()) load_stepping(s.last_load);
    for (const RecordedState& state : s.states) {
      positions(state.x, state.level, "a level's result");
      const bool has_contact = !scene_.models[state.level]->contacts().empty();
      require(state.contact_pressure.size() == (has_contact ? state.x.rows() : 0),
              "a level's contact forces");
      require(state.snapshots.all.empty() == (experiment_.parameters.snapshots == 0), "the snapshots");
    }
    require(s.snapshots.spacing > 0 && s.snapshots.seen >= 0, "the snapshots");
    if (is_level(c_.state.level))
      for (const Snapshot& snapshot : s.snapshots.snapshots)
        positions(snapshot.x, c_.state.level, "the snapshots");
  }

  const Checkpoint& c_;
  const Experiment& experiment_;
  const Scene& scene_;
};

}  // namespace

void require_fitting(const Checkpoint& checkpoint, const Experiment& experiment, const Scene& scene) {
  Check(checkpoint, experiment, scene).all();
}

}  // namespace drape
