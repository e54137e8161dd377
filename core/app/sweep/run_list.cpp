#include <algorithm>
#include <sstream>

#include "core/app/files/json_file.h"
#include "core/app/sweep/local_engine.h"
#include "core/app/sweep/sweep_folder.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

std::string list_of_runs(const nlohmann::ordered_json& sweep) {
  const auto status_of = [](const auto& run) -> std::string {
    return is_refused_as_expected(run) ? "refused, as expected" : run["status"];
  };
  std::size_t widest = 9, widest_status = 13;
  for (const auto& run : sweep["runs"]) {
    widest = std::max(widest, display_width(run["name"]));
    widest_status = std::max(widest_status, display_width(status_of(run)));
  }
  const auto line = [&](const std::string& name, const std::string& seed, const std::string& status,
                        const std::string& seconds) {
    return padded(name, widest + 2) + padded(seed, 7) + " " + padded(status, widest_status + 2) + seconds +
           "\n";
  };
  std::string text = line("variation", "seed", "status", "time");
  for (const auto& run : sweep["runs"]) {
    const std::string status = status_of(run);
    const double seconds = run["seconds"];
    text += line(run["name"], json_text(run["seed"]), status, seconds > 0 ? duration_text(seconds) : "");
    std::istringstream error(run["error"].get<std::string>());
    for (std::string said; status == "failed" && std::getline(error, said);) text += "    " + said + "\n";
  }
  return text;
}

}  // namespace drape
