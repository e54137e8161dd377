#include "core/app/view/connections.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>

#include "core/kernel/threads/stopwatch.h"

namespace drape {

/// A connection's stream with time limits.
class Peer final : public httplib::Stream {
 public:
  Peer(const Connections& all, int socket) : all_(all), socket_(socket) {}

  bool is_readable() const override { return begin_ < end_ || waits_for(POLLIN, 0); }
  bool is_writable() const override { return !all_.ended_; }
  socket_t socket() const override { return socket_; }

  ssize_t read(char* to, std::size_t size) override {
    if (begin_ == end_ && !fill()) return -1;
    const std::size_t n = std::min(size, end_ - begin_);
    std::copy_n(buffer_.data() + begin_, n, to);
    begin_ += n;
    return static_cast<ssize_t>(n);
  }

  ssize_t write(const char* from, std::size_t size) override {
    const Stopwatch watch;
    while (!all_.ended_ && watch.seconds() < all_.limits_.writing) {
      if (!waits_for(POLLOUT, poll_pause)) continue;
      const ssize_t n = send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n >= 0 || !would_block()) return n;
    }
    return -1;
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override { ip = "127.0.0.1", port = 0; }
  void get_local_ip_and_port(std::string& ip, int& port) const override { ip = "127.0.0.1", port = 0; }

 private:
  static constexpr int poll_pause = 20;  // [ms]; latency of limits and shutdown

  static bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

  bool waits_for(short event, int milliseconds) const {
    pollfd one{socket_, event, 0};
    return poll(&one, 1, milliseconds) > 0;
  }

  /// The limit applies to the whole request: a byte now and then does not extend it.
  bool fill() {
    while (taken_ < all_.limits_.request && !all_.is_too_late(since_.seconds())) {
      if (!waits_for(POLLIN, poll_pause)) continue;
      const std::size_t size = std::min(buffer_.size(), all_.limits_.request - taken_);
      const ssize_t n = recv(socket_, buffer_.data(), size, MSG_DONTWAIT);
      if (n < 0 && would_block()) continue;
      if (n <= 0) return false;
      taken_ += static_cast<std::size_t>(n);
      begin_ = 0, end_ = static_cast<std::size_t>(n);
      return true;
    }
    return false;
  }

  const Connections& all_;
  const int socket_;
  const Stopwatch since_;
  std::array<char, 4096> buffer_;
  std::size_t begin_ = 0, end_ = 0, taken_ = 0;
};

namespace {

/// Closes the connection such that the peer receives the last answer even if it sent more than was read.
void close_gently(int socket) {
  shutdown(socket, SHUT_WR);
  std::array<char, 4096> ignored;
  for (int k = 0; k < 16 && recv(socket, ignored.data(), ignored.size(), MSG_DONTWAIT) > 0; ++k) continue;
  close(socket);
}

}  // namespace

Connections::Connections(const ConnectionLimits& limits, std::function<void(httplib::Stream&)> serve)
    : limits_(limits), serve_(std::move(serve)) {
  for (int k = 0; k < limits_.threads; ++k) threads_.emplace_back([this] { work(); });
}

bool Connections::is_too_late(double seconds) const {
  return ended_ || seconds > (waiting_count_ > 0 ? limits_.reading_in_queue : limits_.reading);
}

void Connections::take(int socket) {
  {
    const std::lock_guard lock(mutex_);
    if (!ended_ && waiting_.size() < limits_.waiting) {
      waiting_.push_back(socket);
      waiting_count_ = waiting_.size();
      socket = -1;
    }
  }
  if (socket >= 0)
    close(socket);
  else
    changed_.notify_one();
}

void Connections::work() {
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || !waiting_.empty(); });
    if (ended_) return;
    const int socket = waiting_.front();
    waiting_.pop_front();
    waiting_count_ = waiting_.size();
    lock.unlock();
    Peer peer(*this, socket);
    try {
      serve_(peer);
    } catch (const std::exception&) {
      // This peer gets no answer; the run continues.
    }
    close_gently(socket);
  }
}

void Connections::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  for (const int socket : waiting_) close(socket);
  waiting_.clear();
}

}  // namespace drape
