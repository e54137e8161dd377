#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace drape {

/// A value that is made when it is first asked for. Copies share it, and threads may ask at the same time.
template <class T>
class Deferred {
 public:
  explicit Deferred(std::function<T()> make) : shared_(std::make_shared<Shared>()) {
    shared_->make = std::move(make);
  }

  /// If `make` throws, so does this, and the next call tries again.
  std::shared_ptr<const T> get() const {
    const std::lock_guard lock(shared_->busy);
    if (!shared_->value) {
      shared_->value = std::make_shared<const T>(shared_->make());
      shared_->make = nullptr;  // frees what it captured
    }
    return shared_->value;
  }

 private:
  struct Shared {
    std::mutex busy;  // guards the other members
    std::function<T()> make;
    std::shared_ptr<const T> value;
  };
  std::shared_ptr<Shared> shared_;
};

}  // namespace drape
