#include "core/experiment/run_folder.h"

#include <fstream>
#include <stdexcept>
#include <string_view>

namespace drape {

namespace {

namespace fs = std::filesystem;

// What a run writes; the only names that --overwrite may remove.
constexpr const char* own_names[] = {"config.yaml", "results.json", "report.html",  "steps.csv",
                                     "log.jsonl",   "levels",       "fields",       "rest",
                                     "pictures",    "obstacles",    "frames",       "errors.csv",
                                     "start.ply",   "checkpoint",   "reference.ply"};
constexpr const char* lock_name = "checkpoint/lock";

/// Whether it is a run's: its lock is the first thing that one makes, and nothing takes it away.
bool is_of_a_run(const RunFolder& folder) {
  return fs::exists(folder.file("results.json")) || fs::exists(folder.file(lock_name));
}

/// A run's file or folder there that is not empty; "" where there is none.
fs::path left_there(const RunFolder& folder) {
  for (const char* own : own_names) {
    const fs::path path = folder.file(own);
    if (!fs::is_directory(path)) {
      if (fs::exists(path)) return path;
      continue;
    }
    for (const auto& entry : fs::directory_iterator(path))
      if (entry.path() != folder.file(lock_name)) return path;
  }
  return {};
}

/// What is there may be lost only if it is a run's and `overwrite` says so.
void refuse_what_is_there(const RunFolder& folder, bool overwrite) {
  const fs::path left = left_there(folder);
  if (left.empty()) return;
  if (!is_of_a_run(folder))
    throw std::runtime_error(left.string() +
                             ": is there already, and not from a run; "
                             "name another results folder with --out");
  if (!overwrite)
    throw std::runtime_error(folder.path().string() +
                             ": holds the results of another run; name another folder with --out, or "
                             "replace them with --overwrite");
}

void check_writable(const RunFolder& folder) {
  const fs::path probe = folder.file("writable.part");
  {
    std::ofstream out(probe);
    if (!out.put('\n'))
      throw std::runtime_error(folder.path().string() +
                               ": cannot write to the results folder; name another with --out");
  }
  std::error_code error;
  fs::remove(probe, error);
}

void clear(const RunFolder& folder) {
  std::error_code error;
  for (const char* own : own_names)
    if (own != std::string_view("checkpoint")) fs::remove_all(folder.file(own), error);
  for (const auto& entry : fs::directory_iterator(folder.file("checkpoint")))
    if (entry.path() != folder.file(lock_name)) fs::remove_all(entry.path(), error);
}

}  // namespace

RunFolder::RunFolder(std::filesystem::path path, bool overwrite) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  const std::string name = path_.string();
  if (error || !fs::is_directory(path_))
    throw std::runtime_error(name + ": cannot make the results folder" +
                             (error ? " (" + error.message() + ")" : "") + "; name another with --out");
  refuse_what_is_there(*this, overwrite);
  check_writable(*this);
  lock();
  refuse_what_is_there(*this, overwrite);  // by another run, that has ended just now
  clear(*this);
  for (const char* folder : {"levels", "fields", "rest", "obstacles"}) fs::create_directories(file(folder));
}

RunFolder RunFolder::of_run(std::filesystem::path path) {
  RunFolder folder(std::move(path));
  if (!std::filesystem::exists(folder.file("results.json")))
    throw std::runtime_error(folder.path_.string() + ": holds no run; give the results folder of one");
  folder.lock();
  // A pipe in their place would hold up the run that goes on writing them.
  for (const char* name : {"steps.csv", "log.jsonl"})
    if (const fs::path file = folder.file(name); fs::exists(file) && !fs::is_regular_file(file))
      throw std::runtime_error(file.string() + ": is no file on a disk; run the experiment anew");
  return folder;
}

void RunFolder::lock() {
  std::filesystem::create_directories(file("checkpoint"));
  lock_ = std::make_unique<FileLock>(file(lock_name));
  if (!lock_->acquire(0))
    throw std::runtime_error(path_.string() + ": " + lock_->holder() +
                             " is at this run; wait for it, or stop it");
}

void write_atomically(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path part = file.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error(part.string() + ": cannot write (is the disk full?)");
  }
  std::filesystem::rename(part, file);
}

void RunFolder::write_text(const std::string& name, const std::string& text) const {
  write_atomically(file(name), text);
}

}  // namespace drape
