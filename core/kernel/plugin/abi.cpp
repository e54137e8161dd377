#include "core/kernel/plugin/abi.h"

namespace drape {

std::string mismatch(const DrapePluginDescriptor& theirs) {
  if (theirs.magic != DRAPE_ABI_MAGIC) return "its descriptor is not one of drape";
  if (theirs.abi_number != DRAPE_ABI_NUMBER)
    return "its ABI number is " + std::to_string(theirs.abi_number) + ", drape's is " +
           std::to_string(DRAPE_ABI_NUMBER);
  const std::string build = theirs.build ? theirs.build : "what it does not tell";
  return build == DRAPE_BUILD ? "" : "it was built by " + build + "; drape by " DRAPE_BUILD;
}

}  // namespace drape
