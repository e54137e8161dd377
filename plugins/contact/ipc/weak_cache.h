#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace drape::ipc {

/// Shares objects for as long as anyone owns them. Contact models are rebuilt whenever a load changes.
template <class Value>
class WeakCache {
 public:
  /// The value for which matches(value) holds, otherwise a new one from make().
  template <class Matches, class Make>
  std::shared_ptr<const Value> find_or_make(const Matches& matches, const Make& make) {
    const std::lock_guard lock(busy_);
    std::erase_if(all_, [](const auto& value) { return value.expired(); });
    for (const auto& weak : all_)
      if (auto value = weak.lock(); value && matches(*value)) return value;
    auto value = std::make_shared<const Value>(make());
    all_.push_back(value);
    return value;
  }

 private:
  std::mutex busy_;
  std::vector<std::weak_ptr<const Value>> all_;
};

}  // namespace drape::ipc
