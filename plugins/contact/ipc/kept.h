#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace drape {

/// What was made before, for as long as somebody has it: models are made anew whenever a condition changes.
template <class Part>
class Kept {
 public:
  /// The part for which is_it(part) holds, or else what make() gives.
  template <class IsIt, class Make>
  std::shared_ptr<const Part> find_or_make(const IsIt& is_it, const Make& make) {
    const std::lock_guard lock(busy_);
    std::erase_if(all_, [](const auto& part) { return part.expired(); });
    for (const auto& weak : all_)
      if (auto part = weak.lock(); part && is_it(*part)) return part;
    auto part = std::make_shared<const Part>(make());
    all_.push_back(part);
    return part;
  }

 private:
  std::mutex busy_;
  std::vector<std::weak_ptr<const Part>> all_;
};

}  // namespace drape
