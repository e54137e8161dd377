#include "core/app/files/file_name.h"

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

void refuse_existing(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error))
    throw std::runtime_error(printable(file.string()) +
                             ": exists already; name another file, or replace it with --overwrite");
}

}  // namespace drape
