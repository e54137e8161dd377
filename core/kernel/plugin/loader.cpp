#include "core/kernel/plugin/loader.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/abi.h"
#include "core/kernel/plugin/shared_library.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> libraries_of(const fs::path& directory) {
  std::vector<fs::path> libraries;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(directory, error))
    if (file.path().extension() == ".so") libraries.push_back(file.path());
  if (error)
    throw std::runtime_error(directory.string() +
                             ": the folder of plugins cannot be read: " + error.message());
  std::sort(libraries.begin(), libraries.end());
  return libraries;
}

/// Calls a function of a plugin; errors that it throws name the library.
template <class Call>
auto call(const std::string& path, const char* what, const Call& function) {
  try {
    return function();
  } catch (const std::exception& error) {
    const std::string message = error.what();
    if (message.find(path) != std::string::npos) throw;  // as a name that is taken does
    throw std::runtime_error(path + ": its " + what + " throws: " + message);
  } catch (...) {
    throw std::runtime_error(path + ": its " + what + " throws what is no std::exception");
  }
}

void load(Registry& registry, const fs::path& library) {
  const std::string path = library.string();
  const std::string unfit = fault_of_library(library);
  if (!unfit.empty()) throw std::runtime_error(path + ": cannot be loaded: " + unfit);
  // A name without a slash would be looked for in the system's folders.
  void* handle = dlopen(fs::absolute(library).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) throw std::runtime_error(path + ": cannot be loaded: " + dlerror());
  const auto entry_point =
      reinterpret_cast<const DrapePluginDescriptor* (*)()>(dlsym(handle, "drape_plugin"));
  if (!entry_point)
    throw std::runtime_error(path +
                             ": is not a drape plugin: it exports no function drape_plugin"
                             " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  const DrapePluginDescriptor* descriptor = call(path, "function drape_plugin", entry_point);
  if (!descriptor)
    throw std::runtime_error(path +
                             ": is not a drape plugin: its function drape_plugin returns null"
                             " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  const std::string fault = mismatch(*descriptor);
  if (!fault.empty()) throw std::runtime_error(path + ": does not fit this drape, rebuild it: " + fault);
  if (!descriptor->register_entries)
    throw std::runtime_error(path +
                             ": is not a drape plugin: its descriptor has no function that names its entries"
                             " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  registry.current_library = path;
  const std::size_t before = registry.entries().size();
  call(path, "DRAPE_PLUGIN", [&] { descriptor->register_entries(registry); });
  if (registry.entries().size() == before)
    throw std::runtime_error(path + ": names no entries; add some in its DRAPE_PLUGIN");
}

}  // namespace

namespace {

/// `beside`, if it is a folder, then those of DRAPE_PLUGIN_PATH.
std::vector<fs::path> search_path(const fs::path& beside) {
  std::vector<fs::path> directories;
  if (fs::is_directory(beside)) directories.push_back(beside);
  const char* variable = std::getenv("DRAPE_PLUGIN_PATH");
  for (const std::string& directory : split(variable ? variable : "", ':')) {
    if (directory.empty()) continue;
    if (!fs::is_directory(directory))
      throw std::runtime_error("DRAPE_PLUGIN_PATH names " + directory + ", which is not a folder");
    directories.push_back(directory);
  }
  return directories;
}

}  // namespace

std::vector<fs::path> plugin_directories() {
  return search_path(fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "lib" / "drape");
}

std::vector<fs::path> plugin_directories_beside_library() {
  Dl_info library;
  if (!dladdr(reinterpret_cast<const void*>(&load_plugins), &library) || !library.dli_fname)
    throw std::runtime_error("the path of libdrape cannot be found; name its plugins in DRAPE_PLUGIN_PATH");
  return search_path(fs::canonical(library.dli_fname).parent_path() / "drape");
}

void load_plugins(Registry& registry, const std::vector<fs::path>& directories) {
  std::vector<fs::path> done;
  for (const fs::path& directory : directories) {
    if (!fs::is_directory(directory))
      throw std::runtime_error(directory.string() + ": is not a folder of plugins");
    // A folder named twice is one folder, not a clash of names.
    const fs::path canonical = fs::canonical(directory);
    if (std::find(done.begin(), done.end(), canonical) != done.end()) continue;
    done.push_back(canonical);
    for (const fs::path& library : libraries_of(directory)) load(registry, library);
  }
}

}  // namespace drape
