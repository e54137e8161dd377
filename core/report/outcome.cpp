#include <sstream>

#include "core/report/html.h"
#include "core/report/tables.h"

namespace drape {

namespace {

using html::escape;
using html::figure;

/// "0.001" rather than a measured figure's "1.00e-3".
std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// The method whose widest pair of levels differs least, where several have one.
std::string most_consistent(const RunData& run) {
  const auto pairs = run.pairs();
  if (pairs.empty()) return "";
  const int coarse = pairs.front().first, fine = pairs.back().second;
  const MethodRecord* best = nullptr;
  Figure lowest;
  int known = 0;
  for (const MethodRecord& method : run.methods) {
    const ConsistencyRecord* pair = method.pair(coarse, fine);
    if (!pair || !pair->d_H_fit) continue;
    ++known;
    if (lowest && *lowest <= *pair->d_H_fit) continue;
    best = &method;
    lowest = pair->d_H_fit;
  }
  if (known < 2) return "";
  return "; from level " + std::to_string(coarse) + " to " + std::to_string(fine) + ", <b>" +
         escape(best->name) +
         "</b> changes its mean curvature least (d<sub>H</sub><sup>fit</sup> = " + figure(lowest) + ")";
}

}  // namespace

Figure final_energy(const RunData& run, const MethodRecord& method) {
  if (method.levels.empty()) return {};
  const LevelRecord& last = method.levels.back();
  if (last.energy_on_finest) return last.energy_on_finest;
  return last.level == run.finest_level() ? last.energy : Figure();
}

std::string outcome_sentence(const RunData& run) {
  if (run.methods.empty()) return "The run holds no method's results yet.";
  int converged = 0;
  for (const MethodRecord& m : run.methods) converged += m.status == "converged";
  const int total = static_cast<int>(run.methods.size());
  std::string text = run.complete ? "" : "The run is not complete; these are the figures it had written. ";
  text += std::to_string(converged) + " of " + std::to_string(total) + (total == 1 ? " method" : " methods") +
          " converged";
  if (run.force_tolerance) text += " (force residual below " + shortest(*run.force_tolerance) + ")";

  const MethodRecord* lowest = nullptr;
  int compared = 0;
  for (const MethodRecord& m : run.methods) {
    if (m.status != "converged" || !final_energy(run, m)) continue;
    ++compared;
    if (!lowest || *final_energy(run, m) < *final_energy(run, *lowest)) lowest = &m;
  }
  if (compared > 1) {
    text += "; <b>" + escape(lowest->name) + "</b> ends with the lowest energy (" +
            figure(final_energy(run, *lowest)) + " J";
    for (const MethodRecord& m : run.methods) {
      if (&m == lowest || m.status != "converged" || !final_energy(run, m)) continue;
      text += ", " + escape(m.name) + " " + figure(*final_energy(run, m) - *final_energy(run, *lowest)) +
              " J above";
    }
    text += ")";
  }
  text += most_consistent(run);
  return text + ".";
}

}  // namespace drape
