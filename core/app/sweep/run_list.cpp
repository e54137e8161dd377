#include <algorithm>
#include <sstream>

#include "core/app/sweep/local_engine.h"
#include "core/app/sweep/sweep_folder.h"

namespace drape {

namespace {

/// Columns on the terminal: code points, not bytes.
std::size_t width(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string list_of_runs(const nlohmann::ordered_json& sweep) {
  std::size_t widest = 9;
  for (const auto& run : sweep["runs"]) widest = std::max(widest, width(run["name"]));
  const auto line = [&](const std::string& name, const std::string& seed, const std::string& status,
                        const std::string& seconds) {
    return name + std::string(widest - width(name) + 2, ' ') + seed +
           std::string(8 - std::min<std::size_t>(7, seed.size()), ' ') + status +
           std::string(15 - status.size(), ' ') + seconds + "\n";
  };
  std::string text = line("variation", "seed", "status", "time");
  for (const auto& run : sweep["runs"]) {
    const std::string status = run["status"];
    const bool timed = run["seconds"] > 0.0;
    text += line(run["name"], run["seed"].dump(), status, timed ? duration_text(run["seconds"]) : "");
    std::istringstream error(run["error"].get<std::string>());
    for (std::string said; status == "failed" && std::getline(error, said);) text += "    " + said + "\n";
  }
  return text;
}

}  // namespace drape
