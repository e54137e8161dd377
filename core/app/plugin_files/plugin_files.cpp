#include "core/app/plugin_files/plugin_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <boost/algorithm/string/replace.hpp>
#include <cstdlib>
#include <functional>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "core/app/sweep/process.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// The folder for temporary files. Throws std::runtime_error without one.
fs::path temporary_folder() {
  std::error_code error;
  fs::path folder = fs::temp_directory_path(error);
  if (!error) return folder;
  std::string where = "/tmp";
  for (const char* name : {"TEMPDIR", "TEMP", "TMP", "TMPDIR"})  // the last that is set counts
    if (const std::string value = variable(name); !value.empty()) where = name + ("=" + value);
  throw std::runtime_error("--plugin: the folder for temporary files, " + where + ", is not there (" +
                           error.message() + "); make it, or name another in the variable TMPDIR");
}

fs::path cache_folder() {
  // Relative ones would name a folder of whatever folder the command runs in.
  const fs::path own = variable("XDG_CACHE_HOME"), home = variable("HOME");
  if (own.is_absolute()) return own / "drape";
  return home.is_absolute() ? home / ".cache" / "drape"
                            : temporary_folder() / ("drape-cache-" + std::to_string(geteuid()));
}

/// Whether a library is this user's or root's, and nobody else may write to it.
bool is_own(const fs::path& library) {
  struct stat status {};
  return lstat(library.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         (status.st_uid == geteuid() || status.st_uid == 0) && !(status.st_mode & (S_IWGRP | S_IWOTH));
}

/// Makes a folder in the cache, both for this user alone, and empties those that others might write to until
/// now. Throws std::runtime_error, which names the variable, if it cannot be made, if it is another user's,
/// or if DRAPE_PLUGIN_PATH cannot name it.
void make_cache(const fs::path& folder) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("--plugin: " + why + "; name a folder for it in the variable XDG_CACHE_HOME");
  };
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse("cannot make " + folder.string() + " for the library (" + error.message() + ")");
  for (const fs::path& own : {folder.parent_path(), folder}) {
    struct stat status {};
    const bool is_folder = lstat(own.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
    if (!is_folder || (status.st_uid != geteuid() && status.st_uid != 0))
      refuse("another user may have put a library into " + own.string());
    if (!(status.st_mode & (S_IWGRP | S_IWOTH))) continue;
    if (chmod(own.c_str(), S_IRWXU) != 0) refuse("other users may write to " + own.string());
    fs::remove_all(folder, error);
    if (error || (fs::create_directory(folder, error), error))
      refuse("cannot empty " + folder.string() + ", to which other users might write");
  }
  if (folder.string().find(':') != std::string::npos)
    refuse("\":\" separates the folders of DRAPE_PLUGIN_PATH, so that it cannot name " + folder.string());
}

/// The compiler and its options, without input and output. DRAPE_… are those of this build
/// (core/CMakeLists.txt).
std::vector<std::string> compiler(const fs::path& root) {
  const std::string chosen = variable("CXX");
  std::vector<std::string> words = {chosen.empty() ? DRAPE_CXX : chosen};
  std::istringstream options(DRAPE_CXX_OPTIONS);
  for (std::string option; options >> option;) words.push_back(option);
  const fs::path installed = root / "include" / "drape";
  const fs::path headers = fs::exists(installed / "core") ? installed : fs::path(DRAPE_HEADERS);
  for (const std::string& folder : {headers.string(), std::string(DRAPE_EIGEN)})
    words.insert(words.end(), {"-isystem", folder});
  return words;
}

/// Throws std::runtime_error for a file that is compiled already.
void require_source(const fs::path& file) {
  if (read_file(file).starts_with("\x7f"
                                  "ELF"))
    throw std::runtime_error("--plugin " + file.string() +
                             ": is compiled, and --plugin takes a source; put the folder of the library into "
                             "DRAPE_PLUGIN_PATH instead, as in export DRAPE_PLUGIN_PATH=" +
                             file.parent_path().string());
}

}  // namespace

fs::path compiled_plugin(const fs::path& file, std::ostream& said) {
  const fs::path source = fs::absolute(file);
  require_source(source);
  temporary_folder();  // which the compiler's output needs
  const fs::path libraries = library_directory();
  std::vector<std::string> words = compiler(libraries.parent_path());
  // Whatever the file's name: the compiler would take a file that ends otherwise than a source for an object.
  words.insert(words.end(), {"-x", "c++", source.string(), "-x", "none"});
  // The preprocessed source has the headers in it; a library that was built again may have other classes.
  std::vector<std::string> preprocess = words;
  preprocess.emplace_back("-E");
  const fs::path kernel = fs::canonical(libraries / "libdrape.so");
  const std::string key = read_file(source) + joined(words) + run_program(preprocess).out +
                          std::to_string(fs::last_write_time(kernel).time_since_epoch().count());
  std::ostringstream name;
  name << boost::replace_all_copy(source.stem().string(), ":", "_") << '-' << std::hex
       << std::hash<std::string>()(key);
  fs::path folder = cache_folder() / name.str();
  fs::path library = folder / (source.stem().string() + ".so");
  make_cache(folder);
  if (is_own(library)) return library;

  const fs::path made = folder / (std::to_string(getpid()) + ".part");
  words.insert(words.end(), {"-o", made.string(), "-L" + libraries.string(), "-ldrape"});
  said << "compiling " << printable(source.string()) << std::flush;
  const Stopwatch clock;
  const ProgramOutput output = run_program(words);
  said << ": " << three_digits(clock.seconds()) << " s\n" << printable_lines(output.err);
  if (output.exit.code == 127)
    throw std::runtime_error("--plugin: there is no compiler " + words[0] +
                             "; install it (Debian's package g++), or name one of its kind in the "
                             "variable CXX");
  if (output.exit.code != 0) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    const bool eigen = fs::exists(fs::path(DRAPE_EIGEN) / "Eigen/Core");
    throw std::runtime_error(
        "--plugin " + source.string() + ": does not compile; " + words[0] + " says why" +
        (eigen ? "" : "; Eigen is not in " DRAPE_EIGEN " (Debian's package libeigen3-dev)"));
  }
  rename_file(made, library);
  return library;
}

}  // namespace drape
