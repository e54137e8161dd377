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

/// Time limits for peers and the number of concurrent connections.
struct ConnectionLimits {
  int threads = 16;              ///< concurrent connections
  std::size_t waiting = 64;      ///< connections that may wait for a thread; further ones are closed at once
  double reading = 0;            ///< for a request to arrive [s]
  double reading_in_queue = .2;  ///< the same while others wait [s]
  double writing = 0;            ///< for a peer to take any part of an answer [s]
  std::size_t request = 32768;   ///< largest request, with its headers [bytes]
};

/// Serves connections, one request each, on its own threads. No peer occupies a thread for longer than the
/// limits, and none delays the shutdown.
class Connections {
 public:
  /// `serve` reads a request from the stream and writes its answer there.
  Connections(const ConnectionLimits& limits, std::function<void(httplib::Stream&)> serve);
  ~Connections() { end(); }

  void take(int socket);  ///< serves and closes the connection
  void end();             ///< closes all connections and joins the threads

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
