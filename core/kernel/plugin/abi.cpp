#include "core/kernel/plugin/abi.h"

namespace drape {
namespace {

constexpr DrapePluginDescriptor ours = DRAPE_ABI_DESCRIPTOR(nullptr);

void compare(std::string& faults, const std::string& what, const std::string& theirs,
             const std::string& own) {
  if (theirs == own) return;
  faults += (faults.empty() ? "" : "; ") + what + " is " + theirs + " in the plugin and " + own + " in drape";
}

/// A text of the plugin, which may be null.
std::string text_of(const char* theirs) { return theirs ? theirs : "not given"; }

}  // namespace

std::string mismatch(const DrapePluginDescriptor& theirs) {
  if (theirs.magic != ours.magic) return "its descriptor is not one of drape";
  std::string faults;
  compare(faults, "the ABI number", std::to_string(theirs.abi_number), std::to_string(ours.abi_number));
  if (!faults.empty()) return faults;
  compare(faults, "the compiler", text_of(theirs.compiler), ours.compiler);
  compare(faults, "the standard library", text_of(theirs.standard_library), ours.standard_library);
  compare(faults, "the Eigen version", text_of(theirs.eigen_version), ours.eigen_version);
  compare(faults, "Eigen's alignment (-march)", std::to_string(theirs.eigen_max_align_bytes) + " bytes",
          std::to_string(ours.eigen_max_align_bytes) + " bytes");
  compare(faults, "the scalar type", text_of(theirs.scalar), ours.scalar);
  return faults;
}

}  // namespace drape
