#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "core/app/cli/commands.h"
#include "core/app/sweep/process.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

fs::path cache_folder() {
  const std::string own = variable("XDG_CACHE_HOME"), home = variable("HOME");
  if (!own.empty()) return fs::path(own) / "drape";
  return home.empty() ? fs::temp_directory_path() / "drape-cache" : fs::path(home) / ".cache" / "drape";
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

/// What tells one version of a file from another.
std::string stamp(const fs::path& file) {
  return file.string() + " " + std::to_string(checksum_of(read_file(file))) + "\n";
}

/// The stamps of the headers beside the source that a file of make's rules names.
std::string headers_of(const fs::path& rule, const fs::path& source) {
  std::string text = read_file(rule), stamps;
  text.erase(0, text.find(':') + 1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    while (word.back() == '\\' && word.size() > 1) {  // a space in a name
      std::string rest;
      words >> rest;
      word.back() = ' ';
      word += rest;
    }
    if (word != "\\" && word != source.string()) stamps += stamp(word);
  }
  return stamps;
}

/// Whether the headers are as they were when they were stamped.
bool same_headers(const fs::path& stamps) {
  if (!fs::exists(stamps)) return false;
  std::istringstream lines(read_file(stamps));
  for (std::string line; std::getline(lines, line);) {
    const fs::path header = line.substr(0, line.rfind(' '));
    if (!fs::exists(header) || stamp(header) != line + "\n") return false;
  }
  return true;
}

/// The folder of the library that the source makes.
fs::path compiled(const fs::path& source) {
  const std::string text = read_file(source);
  const fs::path root = own_program().parent_path().parent_path(), libraries = root / "lib";
  std::vector<std::string> words = compiler(root);
  std::string key = text + joined(words) + source.string();
  // A library that was built again may have other classes.
  const fs::path kernel = fs::canonical(libraries / "libdrape.so");
  key += std::to_string(fs::last_write_time(kernel).time_since_epoch().count());
  std::ostringstream name;
  name << source.stem().string() << '-' << std::hex << std::hash<std::string>()(key);
  fs::path folder = cache_folder() / name.str();
  const fs::path library = folder / (source.stem().string() + ".so"), stamps = folder / "headers";
  if (fs::exists(library) && same_headers(stamps)) return folder;

  make_folder(folder);
  const std::string own = std::to_string(getpid());
  const fs::path made = folder / (own + ".part"), rule = folder / (own + ".d");
  words.insert(words.end(), {"-MMD", "-MF", rule.string(), source.string(), "-o", made.string(),
                             "-L" + libraries.string(), "-ldrape"});
  std::cerr << "compiling " << printable(source.string()) << std::flush;
  const auto begin = std::chrono::steady_clock::now();
  const ProgramOutput said = run_program(words);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cerr << ": " << three_digits(seconds) << " s\n" << printable_lines(said.err);
  if (said.exit.code == 127)
    throw std::runtime_error("--plugin: there is no compiler " + words[0] +
                             "; install it, or name one of its kind in the variable CXX");
  if (said.exit.code != 0) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    throw std::runtime_error("--plugin " + source.string() + ": does not compile; " + words[0] +
                             " says why above");
  }
  write_file(stamps, headers_of(rule, source));
  rename_file(made, library);
  fs::remove(rule);
  return folder;
}

}  // namespace

void compile_plugins(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    const std::string folder = compiled(fs::absolute(file)).string();
    const std::string before = variable("DRAPE_PLUGIN_PATH");
    setenv("DRAPE_PLUGIN_PATH", (before.empty() ? folder : before + ":" + folder).c_str(), 1);
  }
}

}  // namespace drape
