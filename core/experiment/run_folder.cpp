#include "core/experiment/run_folder.h"

#include <fstream>
#include <stdexcept>

namespace drape {

namespace {

// What a run writes; the only names that --overwrite may remove.
constexpr const char* own_names[] = {"config.yaml",   "results.json", "report.html", "steps.csv",
                                     "log.jsonl",     "levels",       "fields",      "rest",
                                     "pictures",      "obstacles",    "frames",      "errors.csv",
                                     "reference.ply", "checkpoint",   "start.ply"};

}  // namespace

RunFolder::RunFolder(std::filesystem::path path, bool overwrite) : path_(std::move(path)) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(path_, error);
  const std::string name = path_.string();
  if (error || !fs::is_directory(path_))
    throw std::runtime_error(name + ": cannot make the results folder" +
                             (error ? " (" + error.message() + ")" : "") + "; name another with --out");
  const bool earlier_run = fs::exists(file("results.json"));
  if (earlier_run && !overwrite)
    throw std::runtime_error(name +
                             ": holds the results of another run; name another folder with --out, or "
                             "replace them with --overwrite");
  for (const char* own : own_names)
    if (!earlier_run && fs::exists(file(own)))
      throw std::runtime_error(file(own).string() +
                               ": is there already, and not from a run; "
                               "name another results folder with --out");
  const fs::path probe = file("writable.part");
  {
    std::ofstream out(probe);
    if (!out.put('\n'))
      throw std::runtime_error(name + ": cannot write to the results folder; name another with --out");
  }
  fs::remove(probe, error);
  if (earlier_run) lock();
  if (earlier_run)
    for (const char* own : own_names) fs::remove_all(file(own), error);
  for (const char* folder : {"levels", "fields", "rest", "obstacles"}) fs::create_directories(file(folder));
  lock();
}

RunFolder RunFolder::of_run(std::filesystem::path path) {
  RunFolder folder(std::move(path));
  if (!std::filesystem::exists(folder.file("results.json")))
    throw std::runtime_error(folder.path_.string() + ": holds no run; give the results folder of one");
  folder.lock();
  return folder;
}

void RunFolder::lock() {
  std::filesystem::create_directories(file("checkpoint"));
  lock_ = std::make_unique<FileLock>(file("checkpoint/lock"));
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
