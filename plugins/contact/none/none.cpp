#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {

/// No contact: the cloth may intersect itself and everything else, at no cost.
class NoContact : public ContactModel {
 public:
  std::unique_ptr<BoundContact> bind(const Level&, const Material&) const override { return nullptr; }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::ContactModel, drape::NoContact>(
      "none", "No contact: intersections are allowed, and no contact code runs.");
}
