#include "core/app/files/file_name.h"

#include <unistd.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// Most file systems allow 255 bytes; the rest is for endings that a run appends.
constexpr std::size_t most_bytes = 200;

bool is_utf8(const std::string& text) {
  try {
    nlohmann::ordered_json(text).dump();
    return true;
  } catch (const nlohmann::ordered_json::exception&) {
    return false;
  }
}

}  // namespace

std::string fault_of_file_name(const std::string& name) {
  if (!is_utf8(name)) return "is no UTF-8, which results.json needs";
  if (name.size() > most_bytes)
    return "has " + std::to_string(name.size()) + " bytes, and may have " + std::to_string(most_bytes);
  return "";
}

void refuse_target(const std::filesystem::path& file, bool overwrite) {
  namespace fs = std::filesystem;
  const auto refuse = [](const fs::path& path, const std::string& why) {
    throw std::runtime_error(printable(path.string()) + ": " + why);
  };
  std::error_code error;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) refuse(folder, "is no folder; make it, or name another file");
  if (access(folder.c_str(), W_OK | X_OK) != 0) refuse(folder, "cannot be written to; name another file");
  if (fs::is_directory(file, error)) refuse(file, "is a folder; name a file");
  if (!overwrite && fs::exists(fs::symlink_status(file, error)))
    refuse(file, "exists already; name another file, or replace it with --overwrite");
  fs::path part = file;
  part += ".part";
  if (fs::exists(fs::symlink_status(part, error)))
    refuse(part,
           "exists already, and a file is first written under that name; move it, or name another file");
}

}  // namespace drape
