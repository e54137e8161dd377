#include "core/kernel/plugin/loader.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "core/kernel/files/file.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/abi.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> libraries_of(const fs::path& directory) {
  std::vector<fs::path> libraries;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(directory, error))
    if (file.path().extension() == ".so") libraries.push_back(file.path());
  if (error) refuse_path(directory, "the folder of plugins cannot be read: " + error.message());
  std::sort(libraries.begin(), libraries.end());
  return libraries;
}

/// Why the file cannot be loaded as a library, with a remedy; "" if it may be one. dlopen maps a file without
/// a look at its size, so one that is cut short would end the process with SIGBUS. Section headers come last.
std::string fault_of(const fs::path& library) {
  std::error_code error;
  const fs::file_status status = fs::status(library, error);
  if (status.type() == fs::file_type::not_found) return "there is no such file; does the link lead nowhere?";
  if (error) return error.message();
  if (!fs::is_regular_file(status)) return "it is not a regular file; take it out of the folder";
  std::ifstream file(library, std::ios::binary);
  if (!file) return "it cannot be read; check its permissions";
  ElfW(Ehdr) header{};
  file.read(reinterpret_cast<char*>(&header), sizeof header);
  const std::uintmax_t size = fs::file_size(library);
  if (std::memcmp(header.e_ident, ELFMAG, std::min<std::uintmax_t>(size, SELFMAG)) != 0)
    return "it is no shared library (ELF); take it out of the folder or build it again";
  if (size < sizeof header || size < header.e_shoff + std::uintmax_t{header.e_shnum} * header.e_shentsize)
    return "the file is cut short at " + std::to_string(size) +
           " bytes, its headers ask for more; build or copy it again";
  return "";
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

}  // namespace

void load_plugin(Registry& registry, const fs::path& library) {
  const std::string path = library.string();
  if (const std::string unfit = fault_of(library); !unfit.empty())
    refuse_path(library, "cannot be loaded: " + unfit);
  // The pointer hides from the compiler that dlopen is declared to throw nothing: static initialisers may. A
  // name without a slash would be looked for in the system's folders.
  void* (*volatile const open)(const char*, int) = dlopen;
  const auto load = [&] { return open(fs::absolute(library).c_str(), RTLD_NOW | RTLD_LOCAL); };
  void* handle = call(path, "static initialiser", load);
  if (!handle) refuse_path(library, std::string("cannot be loaded: ") + dlerror());
  const auto entry_point =
      reinterpret_cast<const DrapePluginDescriptor* (*)()>(dlsym(handle, "drape_plugin"));
  const auto refuse = [&](const std::string& why) {
    refuse_path(library,
                "is not a drape plugin: " + why + " (see DRAPE_PLUGIN in core/kernel/plugin/plugin.h)");
  };
  if (!entry_point) refuse("it exports no function drape_plugin");
  const DrapePluginDescriptor* descriptor = call(path, "function drape_plugin", entry_point);
  if (!descriptor) refuse("its function drape_plugin returns null");
  if (const std::string fault = mismatch(*descriptor); !fault.empty())
    refuse_path(library, "does not fit this drape, rebuild it: " + fault);
  if (!descriptor->register_entries) refuse("its descriptor has no function that names its entries");
  registry.current_library = path;
  const std::size_t before = registry.entries().size();
  call(path, "DRAPE_PLUGIN", [&] { descriptor->register_entries(registry); });
  if (registry.entries().size() == before)
    refuse_path(library, "names no entries; add some in its DRAPE_PLUGIN");
}

fs::path library_directory() {
  Dl_info own;
  if (!dladdr(reinterpret_cast<const void*>(&load_plugins), &own) || !own.dli_fname)
    throw std::runtime_error("the path of libdrape cannot be found; name its plugins in DRAPE_PLUGIN_PATH");
  return fs::canonical(own.dli_fname).parent_path();
}

std::vector<fs::path> plugin_directories() {
  const fs::path beside = library_directory() / "drape";
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

void load_plugins(Registry& registry, const std::vector<fs::path>& directories) {
  std::vector<fs::path> done;
  for (const fs::path& directory : directories) {
    if (!fs::is_directory(directory)) refuse_path(directory, "is not a folder of plugins");
    // A folder named twice is one folder, not a clash of names.
    const fs::path canonical = fs::canonical(directory);
    if (std::find(done.begin(), done.end(), canonical) != done.end()) continue;
    done.push_back(canonical);
    for (const fs::path& library : libraries_of(directory)) load_plugin(registry, library);
  }
}

}  // namespace drape
