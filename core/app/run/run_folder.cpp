#include "core/app/run/run_folder.h"

#include <unistd.h>

#include <climits>
#include <cstring>
#include <regex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/app/files/json_file.h"
#include "core/app/report/run_data.h"
#include "core/kernel/files/file.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "checkpoint/lock";
/// Longest ending of a method's file names, which begin with the method's name: a picture's.
constexpr std::size_t longest_ending = std::string_view("_l10_on_l11.png.99.part").size();

/// Whether it is a run's folder: a run creates its lock first and never removes it. Without the lock,
/// results.json may be of another program.
bool is_of_a_run(const RunFolder& folder) {
  const fs::path results = folder.file("results.json");
  return fs::is_regular_file(fs::symlink_status(folder.file(lock_name))) ||
         (fs::is_regular_file(results) &&
          text_member(parse_json(read_file(results)), "version").starts_with("drape "));
}

enum class Named { file, unfinished, folder };

/// What there has a name of a run's file: the files, those of them that were not written to their end, or
/// the folders, which no run has made.
std::vector<fs::path> named_as_of_run(const RunFolder& folder, Named kind) {
  std::vector<fs::path> files;
  const std::regex unfinished(R"((\.\d+)?\.part$)");
  const auto add = [&](const std::string& own) {
    for (const auto& entry : fs::directory_iterator(folder.file(own))) {
      const std::string name = entry.path().filename().string(),
                        whole = std::regex_replace(name, unfinished, "");
      const bool is_folder = fs::is_directory(entry.symlink_status());
      if (is_folder == (kind == Named::folder) && is_file_of_run(own, is_folder ? name : whole) &&
          (kind != Named::unfinished || name != whole))
        files.push_back(entry.path());
    }
  };
  add("");
  for (const auto& [own, pattern] : own_folders)
    if (fs::is_directory(folder.file(own))) add(own);
  return files;
}

/// A file or non-empty folder with one of a run's names; "" without one.
fs::path left_there(const RunFolder& folder) {
  for (const char* own : own_files)
    if (fs::path path = folder.file(own); fs::exists(path)) return path;
  for (const auto& [own, pattern] : own_folders) {
    fs::path path = folder.file(own);
    if (fs::exists(path) && !fs::is_directory(path)) return path;
    if (!fs::is_directory(path)) continue;
    for (const auto& entry : fs::directory_iterator(path))
      if (entry.path() != folder.file(lock_name)) return path;
  }
  return {};
}

[[noreturn]] void refuse(const fs::path& path, const std::string& why, const std::string& remedy) {
  refuse_path(path, why + "; " + remedy + ", or name another results folder with --out");
}

/// A run writes into folders of its own, and replaces files by renaming. The files that a link leads to are
/// not a run's, whatever their names, and a folder in a file's place is somebody's own.
void refuse_other_kinds(const RunFolder& folder) {
  std::vector<fs::path> others = named_as_of_run(folder, Named::folder);
  for (const auto& [own, pattern] : own_folders)
    if (const fs::path path = folder.file(own); fs::exists(path) && !fs::is_directory(path))
      others.push_back(path);
  if (!others.empty()) refuse(others[0], "is not what a run has by this name", "move it");
}

/// What is there may only be replaced if it has a run's kinds and can be removed, and if the new run does not
/// read it.
void refuse_what_must_stay(const RunFolder& folder, const std::vector<fs::path>& inputs) {
  refuse_other_kinds(folder);
  for (const auto& [own, pattern] : own_folders)
    if (const fs::path path = folder.file(own);
        fs::exists(path) && access(path.c_str(), W_OK | X_OK) != 0)  // which removing a file takes
      refuse(path, "cannot be written to", "make it writable");
  for (const fs::path& file : named_as_of_run(folder, Named::file))
    for (const fs::path& input : inputs) {
      std::error_code error;
      if (input.is_absolute() && fs::equivalent(input, file, error))  // else a copy that the new run makes
        refuse(input, "is read by this experiment, and --overwrite would remove it", "copy it");
    }
}

void refuse_linked_folders(const RunFolder& folder) {
  for (const auto& [own, pattern] : own_folders) refuse_links(folder.path(), own);
}

/// Files may be replaced only if they are a run's and `overwrite` is set.
void refuse_what_is_there(const RunFolder& folder, bool overwrite, const std::vector<fs::path>& inputs) {
  for (const char* name : {"sweep.json", "sweep.lock"})
    if (fs::exists(folder.file(name)))
      refuse_path(folder.path(), "is a sweep's folder; name another results folder with --out");
  refuse_linked_folders(folder);
  const fs::path left = left_there(folder);
  if (left.empty()) return;
  if (!is_of_a_run(folder))
    refuse_path(left, "is there already, and not from a run; name another results folder with --out");
  if (!overwrite)
    refuse_path(
        folder.path(),
        "holds the results of another run; name another folder with --out, or replace them with --overwrite");
  refuse_what_must_stay(folder, inputs);
}

/// The missing folders of the path, innermost first. A link is not missing, wherever it leads.
std::vector<fs::path> missing_folders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  fs::path p = fs::absolute(folder);
  for (; !fs::exists(fs::symlink_status(p, error)) && p.has_relative_path(); p = p.parent_path())
    missing.push_back(p);
  return missing;
}

void remove_files(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw WriteError(file.string() + ": cannot be removed (" + error.message() + ")");
  }
}

/// Removes the files of an earlier run; those that others have put into its folders stay.
void clear(const RunFolder& folder) {
  remove_files(named_as_of_run(folder, Named::file));
  for (const auto& [own, pattern] : own_folders) {
    std::error_code error;
    fs::remove(folder.file(own), error);  // if empty
  }
}

}  // namespace

void make_results_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (std::error_code none; fs::is_symlink(folder, none) && !fs::exists(folder, none))
    refuse_path(folder, "is a link to " + fs::read_symlink(folder).string() +
                            ", which does not exist; make that folder, or name another with --out");
  if (error || !fs::is_directory(folder, error))
    refuse_path(folder, "cannot make the results folder" + (error ? " (" + error.message() + ")" : "") +
                            "; name another with --out");
}

void refuse_long_paths(const fs::path& folder, const std::vector<std::string>& methods) {
  for (const std::string& method : methods) {
    const std::size_t path =
        fs::absolute(folder).string().size() + std::strlen("/pictures/") + method.size() + longest_ending;
    if (path >= PATH_MAX)
      throw std::runtime_error("method \"" + method + "\" would have files with paths of " +
                               std::to_string(path) + " bytes, and the system takes " +
                               std::to_string(PATH_MAX - 1) + "; name a results folder less deep with --out");
  }
}

RunFolder::RunFolder(std::filesystem::path path, bool overwrite,
                     const std::vector<std::filesystem::path>& inputs)
    : path_(std::move(path)) {
  const std::vector<fs::path> made = missing_folders(path_);
  try {
    make_results_folder(path_);
    refuse_what_is_there(*this, overwrite, inputs);
    lock();
  } catch (...) {
    std::error_code error;
    if (!made.empty() && fs::is_empty(file(lock_name), error) && !error) fs::remove(file(lock_name), error);
    if (!made.empty()) fs::remove(file("checkpoint"), error);
    for (const fs::path& folder : made) fs::remove(folder, error);  // removes only empty ones
    throw;
  }
  refuse_what_is_there(*this, overwrite, inputs);  // by another run that has just finished
  clear(*this);
  for (const char* folder : {"levels", "fields", "rest", "obstacles"}) make_folder(file(folder));
}

RunFolder RunFolder::of_run(std::filesystem::path path) {
  RunFolder folder(std::move(path));
  if (!is_of_a_run(folder)) refuse_path(folder.path_, "holds no run; give the results folder of one");
  refuse_linked_folders(folder);
  refuse_other_kinds(folder);
  folder.lock();
  return folder;
}

void RunFolder::remove_unfinished() const { remove_files(named_as_of_run(*this, Named::unfinished)); }

void RunFolder::lock() {
  std::error_code error;
  fs::create_directories(file("checkpoint"), error);
  if (error) refuse_path(path_, "cannot write to the results folder; name another with --out");
  lock_ = std::make_unique<FileLock>(file(lock_name));
  if (!lock_->acquire(0)) refuse_path(path_, lock_->holder() + " uses this folder; wait for it, or stop it");
}

}  // namespace drape
