#pragma once

#include <httplib.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace drape {

/// How long peers may take, and how many are served at a time.
struct ConnectionLimits {
  int threads = 16;              ///< connections that are served at a time
  std::size_t waiting = 64;      ///< connections that may wait for a thread; further ones are closed at once
  double reading = 5;            ///< for a request to arrive [s]
  double reading_in_queue = .2;  ///< the same while others wait [s]
  double writing = 5;            ///< for a peer to take any part of an answer [s]
  std::size_t request = 32768;   ///< largest request, with its headers [bytes]
};

/// Serves connections, one request each, on threads of its own. No peer holds a thread for longer than the
/// limits say, and none holds up the end.
class Connections {
 public:
  /// `serve` reads a request from the stream and writes its answer there.
  Connections(const ConnectionLimits& limits, std::function<void(httplib::Stream&)> serve);
  ~Connections() { end(); }

  void take(int socket);  ///< the connection is served and closed
  void end();             ///< closes all connections, and waits for the threads alone

 private:
  friend class Peer;
  void work();
  bool is_too_late(double seconds) const;

  const ConnectionLimits limits_;
  const std::function<void(httplib::Stream&)> serve_;
  std::atomic<bool> ended_ = false;
  std::atomic<std::size_t> waiting_count_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<int> waiting_;
  std::vector<std::thread> threads_;
};

}  // namespace drape
