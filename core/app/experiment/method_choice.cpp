#include "core/app/experiment/method_choice.h"

#include <algorithm>
#include <stdexcept>

#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string default_method(const std::vector<std::string>& methods) {
  if (contains(methods, "pcs")) return "pcs";
  return methods.size() == 1 ? methods[0] : "";
}

std::vector<std::string> chosen_methods(const Experiment& experiment, const std::vector<std::string>& asked) {
  std::vector<std::string> known, chosen;
  for (const auto& [name, solver] : experiment.methods) known.push_back(name);
  for (const std::string& name : asked)
    if (name != all_methods && !contains(known, name))
      throw std::runtime_error("--method " + name + ": the experiment's methods are " + joined(known));
  if (contains(asked, all_methods)) return known;
  if (asked.empty()) {
    const std::string name = default_method(known);
    if (name.empty())
      throw std::runtime_error("the experiment has no method pcs, which runs by default; name some of " +
                               joined(known) + " with --method, or run them all with --method all");
    return {name};
  }
  std::copy_if(known.begin(), known.end(), std::back_inserter(chosen),
               [&](const std::string& name) { return contains(asked, name); });
  return chosen;
}

}  // namespace drape
