// The Python module drape._core: a thin layer over libdrape and libdrape_app.

#include "core/app/python/module.h"

#include <pybind11/stl.h>

#include <map>
#include <sstream>
#include <vector>

#include "core/app/plugin_files/plugin_files.h"
#include "core/app/python/values.h"
#include "core/app/run/runner.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/abi.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/threads/parallel.h"
#include "core/kernel/version.h"

namespace drape::python {

namespace {

/// Never destroyed: experiments and plugins' objects may outlive the interpreter's last call.
Registry& mutable_registry() {
  static Registry* const all = [] {
    auto loaded = std::make_unique<Registry>();
    load_plugins(*loaded, plugin_directories());
    return loaded.release();
  }();
  return *all;
}

std::vector<std::pair<std::string, std::string>> plugins(const Text& kind) {
  const std::vector<std::string>& kinds = plugin_kinds();
  if (!is_one_of(kind, kinds))
    throw py::value_error("there is no kind \"" + kind + "\"; the kinds are " + joined(kinds));
  std::vector<std::pair<std::string, std::string>> names;
  for (const RegistryEntry* entry : registry().of_kind(kind)) names.emplace_back(entry->name, entry->summary);
  return names;
}

/// Experiments that were made of entries that are no longer registered refer to them.
void keep(std::vector<std::unique_ptr<RegistryEntry>> entries) {
  static auto* const kept = new std::vector<std::unique_ptr<RegistryEntry>>;
  for (auto& entry : entries) kept->push_back(std::move(entry));
}

/// Takes the entries of a library out of the registry.
std::vector<std::unique_ptr<RegistryEntry>> taken_out(Registry& all, const std::string& library) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const auto& entry : all.entries())
    if (entry->library == library) names.emplace_back(entry->kind, entry->name);
  std::vector<std::unique_ptr<RegistryEntry>> entries;
  for (const auto& [kind, name] : names) entries.push_back(all.remove(kind, name));
  return entries;
}

/// The library that each source has given, by the source's absolute path.
std::map<std::string, std::string>& plugin_sources() {
  static std::map<std::string, std::string> sources;
  return sources;
}

/// The library of a source; an error has what the compiler said below it.
std::string library_of(const std::filesystem::path& source) {
  std::ostringstream said;
  try {
    return without_gil([&] { return compiled_plugin(source, said).string(); });
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what() + (said.str().empty() ? "" : ":\n" + said.str()));
  }
}

void load_source(const std::filesystem::path& file) {
  const std::filesystem::path source = std::filesystem::absolute(file).lexically_normal();
  Registry& all = mutable_registry();
  const std::string library = library_of(source);
  std::string& loaded = plugin_sources()[source.string()];
  if (loaded == library) return;
  auto earlier = taken_out(all, loaded);
  try {
    load_plugin(all, library);
  } catch (...) {
    keep(taken_out(all, library));
    for (auto& entry : earlier) all.add_entry(std::move(entry));
    throw;
  }
  keep(std::move(earlier));
  loaded = library;
}

/// The sources that are loaded.
std::vector<std::string> loaded_sources() {
  std::vector<std::string> files;
  for (const auto& [file, library] : plugin_sources())
    if (!library.empty()) files.push_back(file);
  return files;
}

/// A module that was built against other headers than the library that it found, as a plugin would be.
void require_fitting_library() {
  static constexpr DrapePluginDescriptor own = DRAPE_ABI_DESCRIPTOR(nullptr);
  const std::string fault = mismatch(own);
  if (!fault.empty())
    throw py::import_error("this drape module does not fit the libdrape that it found: " + fault +
                           "; build and install both together");
}

/// Errors of a config are raised by throw_errors.
void bind_errors(py::module_& m) {
  py::register_exception<RunAborted>(m, "RunAborted", PyExc_RuntimeError).attr("__doc__") =
      "A run was aborted after it had begun, as on a full disk; its message says what to do.";
  // Local: other modules that are built with pybind11 keep their own translation.
  py::register_local_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const std::logic_error& fault) {
      PyErr_SetString(PyExc_ValueError, fault.what());
    } catch (const py::builtin_exception&) {
      throw;
    } catch (const RunAborted&) {
      throw;
    } catch (const std::runtime_error& fault) {
      PyErr_SetString(PyExc_RuntimeError, in_python(fault.what()).c_str());
    }
  });
}

/// Has every method refuse an object whose __init__ has not run, as of Model.__new__(Model): pybind11 would
/// give it memory that nothing was written to. It takes that memory here; what C++ makes has its own.
void refuse_half_made(const py::module_& m) {
  for (const auto& [name, entry] : py::dict(m.attr("__dict__")))
    if (PyType_Check(entry.ptr()) != 0)
      if (auto* type = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(entry.ptr()))) {
        type->operator_new = [](std::size_t) -> void* {
          throw py::type_error("the object is not complete: its __init__ has not run");
        };
        // Python's own would make an object of pybind11's base, which ends the process.
        entry.attr("__reduce__") = py::cpp_function(
            [](const py::args&) { throw py::type_error("objects of drape cannot be pickled"); },
            py::is_method(entry));
      }
}

}  // namespace

const Registry& registry() { return mutable_registry(); }

void register_prototype(std::unique_ptr<RegistryEntry> entry) {
  Registry& all = mutable_registry();
  const RegistryEntry* before = all.find(entry->kind, entry->name);
  entry->library = "Python";
  std::unique_ptr<RegistryEntry> earlier;
  if (before && before->library == entry->library) earlier = all.remove(entry->kind, entry->name);
  try {
    all.add_entry(std::move(entry));
  } catch (...) {
    if (earlier) all.add_entry(std::move(earlier));
    throw;
  }
  std::vector<std::unique_ptr<RegistryEntry>> replaced;
  if (earlier) replaced.push_back(std::move(earlier));
  keep(std::move(replaced));
}

}  // namespace drape::python

PYBIND11_MODULE(_core, m) {
  using namespace drape;
  python::require_fitting_library();
  m.attr("__version__") = version();
  m.attr("__commit__") = commit();
  m.def(
      "set_threads",
      [](int count) {
        if (count < 0 || count > most_threads)
          throw pybind11::value_error("the number of threads must be at least 0 and at most " +
                                      std::to_string(most_threads));
        set_thread_count(count);
      },
      python::whole("count"), "Set the number of threads of the process; 0 means one for each core.");
  m.def("plugins", &python::plugins, pybind11::arg("kind"),
        "Name and summary of every plugin of a kind: energy, refiner, contact, solver or metric. Prototypes "
        "that are registered count.");
  m.def("load_plugin", &python::load_source, pybind11::arg("file"),
        "Compile a plugin, one C++ file, unless it was compiled before, and load it, as `drape run --plugin "
        "FILE` does; experiments then know what it registers. Of a file that has changed since, the new "
        "entries take the place of the old ones. Raises RuntimeError, with what the compiler says.");
  m.def("_plugin_sources", &python::loaded_sources);
  python::bind_errors(m);
  python::bind_scene(m);
  python::bind_model(m);
  python::bind_experiment(m);
  python::bind_run(m);
  python::bind_solve(m);
  python::bind_bound_energy(m);
  python::bind_prototype_problem(m);
  python::bind_prototypes(m);
  python::refuse_half_made(m);
}
