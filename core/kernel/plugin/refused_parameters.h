#pragma once

#include <cstddef>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/files/message_text.h"

namespace drape {

/// A fault that a plugin finds in a valid parameter, such as a mesh file that is missing.
struct ParameterFault {
  std::string path;  ///< in the plugin's section, with indices from 0: "obstacles.2"
  std::string message;
  std::optional<std::size_t> at = {};  ///< its place in a text: the byte
  std::string shown = {};              ///< ConfigError::shown
};

/// Thrown by a plugin's constructor to refuse parameters, each with its own location in the config.
class RefusedParameters : public std::runtime_error {
 public:
  explicit RefusedParameters(std::vector<ParameterFault> all)
      : std::runtime_error(text_of(all)), faults(std::move(all)) {}

  std::vector<ParameterFault> faults;

 private:
  static std::string text_of(const std::vector<ParameterFault>& all) {
    std::string text;
    for (const ParameterFault& fault : all) text += (text.empty() ? "" : "; ") + fault.message;
    return text;
  }
};

/// Makes something of every item of a list of parameters. Throws RefusedParameters with the faults of all
/// items that `make(item, index)` throws for, all of an item's if that is RefusedParameters.
template <class Items, class Make>
void for_all_items(const std::string& list, const Items& items, const Make& make) {
  std::vector<ParameterFault> faults;
  for (std::size_t k = 0; k < items.size(); ++k) try {
      make(items[k], k);
    } catch (const RefusedParameters& refused) {
      for (const ParameterFault& fault : refused.faults)
        faults.push_back({list + "." + std::to_string(k) + (fault.path.empty() ? "" : "." + fault.path),
                          fault.message, fault.at, fault.shown});
    } catch (const std::exception& error) {
      faults.push_back({list + "." + std::to_string(k), reason_of(error)});
    }
  if (!faults.empty()) throw RefusedParameters(std::move(faults));
}

}  // namespace drape
