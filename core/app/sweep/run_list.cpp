#include <algorithm>
#include <sstream>

#include "core/app/files/json_file.h"
#include "core/app/sweep/local_engine.h"
#include "core/app/sweep/sweep_folder.h"
#include "core/kernel/plugin/string_utils.h"

namespace drape {

std::string list_of_runs(const nlohmann::ordered_json& sweep) {
  std::size_t widest = 9;
  for (const auto& run : sweep["runs"]) widest = std::max(widest, display_width(run["name"]));
  const auto line = [&](const std::string& name, const std::string& seed, const std::string& status,
                        const std::string& seconds) {
    return padded(name, widest + 2) + padded(seed, 7) + " " + padded(status, 15) + seconds + "\n";
  };
  std::string text = line("variation", "seed", "status", "time");
  for (const auto& run : sweep["runs"]) {
    const std::string status = run["status"];
    const double seconds = run["seconds"];
    text += line(run["name"], json_text(run["seed"]), status, seconds > 0 ? duration_text(seconds) : "");
    std::istringstream error(run["error"].get<std::string>());
    for (std::string said; status == "failed" && std::getline(error, said);) text += "    " + said + "\n";
  }
  return text;
}

}  // namespace drape
