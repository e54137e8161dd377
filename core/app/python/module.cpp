// The Python module drape._core: a thin layer over libdrape and libdrape_app.

#include "core/app/python/module.h"

#include <pybind11/stl.h>

#include <set>

#include "core/app/python/registry.h"
#include "core/kernel/plugin/abi.h"
#include "core/kernel/threads/parallel.h"
#include "core/kernel/version.h"

namespace {

/// A module that was built against other headers than the library that it found, as a plugin would be.
void require_fitting_library() {
  static constexpr DrapePluginDescriptor own = DRAPE_ABI_DESCRIPTOR(nullptr);
  const std::string fault = drape::mismatch(own);
  if (!fault.empty())
    throw pybind11::import_error("this drape module does not fit the libdrape that it found: " + fault +
                                 " (the plugin is the module); build and install both together");
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  using namespace drape;
  require_fitting_library();
  m.attr("__version__") = version();
  m.attr("__commit__") = commit();
  m.def(
      "set_threads",
      [](int count) {
        if (count < 0) throw pybind11::value_error("the number of threads must be at least 0");
        set_thread_count(count);
      },
      pybind11::arg("count"), "Set the number of threads of the process; 0 means one for each core.");
  m.def(
      "plugins",
      [](const std::string& kind) {
        std::vector<std::pair<std::string, std::string>> names;
        const std::set<std::string> kinds = {"energy", "refiner", "contact", "solver", "metric"};
        if (!kinds.contains(kind))
          throw pybind11::value_error("there is no kind \"" + kind +
                                      "\"; the kinds are energy, refiner, contact, solver and metric");
        for (const RegistryEntry* entry : python::registry().of_kind(kind))
          names.emplace_back(entry->name, entry->summary);
        return names;
      },
      pybind11::arg("kind"),
      "Name and summary of every plugin of a kind: energy, refiner, contact, solver or metric. Prototypes "
      "that are registered count.");
  python::bind_errors(m);
  python::bind_levels(m);
  python::bind_model(m);
  python::bind_scene(m);
  python::bind_iterations(m);
  python::bind_result(m);
  python::bind_solve(m);
  python::bind_experiment(m);
  python::bind_prototypes(m);
}
