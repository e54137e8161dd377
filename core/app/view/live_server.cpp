#include "core/app/view/live_server.h"

#include <arpa/inet.h>
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <boost/algorithm/string/erase.hpp>
#include <boost/uuid/uuid_generators.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/kernel/threads/held_signals.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

namespace {

using httplib::Request, httplib::Response;

/// Through a content provider: the library would compress a plain body slowly. It asks for all of a range,
/// whether or not the body is so long.
void send(Response& response, const std::shared_ptr<const std::string>& body, const char* type) {
  const std::size_t size = body->size();
  response.set_content_provider(
      size, type, [body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return offset + length <= body->size() && sink.write(body->data() + offset, length);
      });
}

void refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", "text/plain");
}

constexpr std::size_t largest_body = 1024;    // [bytes]; no request of the page has one
constexpr std::size_t most_connections = 16;  // at a time, each with a thread of its own
constexpr int longest_headers = 32768;        // [bytes]

/// Waits for the headers of a request, which the library would read without end. Ends the connection where
/// they are too long, or have not come within `patience` [s].
void await_headers(int socket, double patience) {
  std::vector<char> headers(longest_headers);
  const Stopwatch watch;
  pollfd events{socket, POLLIN | POLLRDHUP, 0};
  while (true) {
    ::poll(&events, 1, 100);
    if ((events.revents & ~POLLIN) != 0) return;  // the peer has ended it
    const ssize_t size = ::recv(socket, headers.data(), headers.size(), MSG_PEEK | MSG_DONTWAIT);
    const std::string_view seen(headers.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    if (size == 0 || seen.find("\r\n\r\n") != seen.npos) return;
    if (size == longest_headers || watch.seconds() > patience) {
      ::shutdown(socket, SHUT_RDWR);
      while (::recv(socket, headers.data(), headers.size(), MSG_DONTWAIT) > 0) {
      }
      return;
    }
    if (size > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));  // poll would return at once
  }
}

/// The connections to a port of this process: their sockets, by the ports of their peers. The library tells
/// nobody its sockets; those beyond 1024 cannot be its own, since it has so few. A new socket has the least
/// free number: beyond the `highest` known one, a gap ends the search, which takes a call for each number.
std::map<int, int> connections_to(int port, int highest = 1023) {
  constexpr int gap = 16;
  std::map<int, int> sockets;
  for (int socket = 3, closed = 0; socket < 1024 && (socket <= highest || closed < gap); ++socket) {
    sockaddr_in own{}, peer{};
    socklen_t own_size = sizeof own, peer_size = sizeof peer;
    errno = 0;
    if (getsockname(socket, reinterpret_cast<sockaddr*>(&own), &own_size) == 0 && own.sin_family == AF_INET &&
        ntohs(own.sin_port) == port &&
        getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &peer_size) == 0)
      sockets[ntohs(peer.sin_port)] = socket;
    closed = errno == EBADF ? closed + 1 : 0;
  }
  return sockets;
}

/// The library's threads for connections. The library accepts any number of them, and each that waits for a
/// thread takes a descriptor that the run may need. Here the next one is not accepted before there is room.
/// The oldest connection that has not asked for anything of the live view makes room: it is ended.
class ConnectionQueue final : public httplib::ThreadPool {
 public:
  ConnectionQueue(const int& port, double patience)
      : ThreadPool(most_connections), port_(port), patience_(patience) {}

  /// Called by the thread that accepts connections, once for each.
  void enqueue(std::function<void()> serve) override {
    std::unique_lock lock(mutex_);
    std::map<int, int> sockets = connections_to(port_, highest_);
    for (const auto& [peer, socket] : sockets) highest_ = std::max(highest_, socket);
    std::erase_if(idle_, [&](int peer) { return !sockets.contains(peer); });
    for (const auto& [peer, socket] : sockets)
      if (!sockets_.contains(peer)) idle_.push_back(peer);
    sockets_ = std::move(sockets);
    const auto accepted = std::ranges::find_if(sockets_, [&](const auto& known) {
      const auto served = served_.find(known.second);
      return served == served_.end() || served->second != known.first;
    });
    const bool has_ended = accepted == sockets_.end();
    const int peer = has_ended ? -1 : accepted->first, socket = has_ended ? -1 : accepted->second;
    served_[socket] = peer;
    const bool several_idle = idle_.size() > 1;  // the newest has had no time to ask
    if (sockets_.size() > most_connections && several_idle) ::shutdown(sockets_.at(idle_.front()), SHUT_RDWR);
    has_room_.wait(lock, [&] { return open_ < most_connections; });
    ++open_;
    ThreadPool::enqueue([this, peer, socket, serve = std::move(serve)] {
      if (socket >= 0) await_headers(socket, patience_);
      serve();
      {
        const std::lock_guard ended(mutex_);
        if (served_[socket] == peer) served_.erase(socket);
        --open_;
      }
      has_room_.notify_one();
    });
  }

  /// The connection of this peer has asked for something of the live view.
  void keep(int peer) {
    const std::lock_guard lock(mutex_);
    std::erase(idle_, peer);
  }

 private:
  const int& port_;
  double patience_;  // [s]
  std::mutex mutex_;
  std::condition_variable has_room_;
  std::size_t open_ = 0;        // connections that have a thread
  int highest_ = 0;             // of the sockets so far
  std::map<int, int> sockets_;  // of the connections when the last one came, by the ports of their peers
  std::map<int, int> served_;   // peers of the sockets that have a thread
  std::vector<int> idle_;       // ports of those that have not asked for anything, the oldest first
};

}  // namespace

struct LiveServer::Impl {
  httplib::Server server;
  std::thread thread;
  std::atomic<bool> ended = false;
  int port = 0;
  ConnectionQueue* queue = nullptr;  // the server's, while it listens
  const std::string base =
      "/" + boost::erase_all_copy(to_string(boost::uuids::random_generator()()), "-") + "/";

  /// Whether the request is for the printed address. This stops DNS rebinding and cross-site requests.
  bool is_ours(const Request& request) const {
    const std::string host = "http://" + request.get_header_value("Host");
    if (host != "http://127.0.0.1:" + std::to_string(port) &&
        host != "http://localhost:" + std::to_string(port))
      return false;
    return request.method == "GET" || !request.has_header("Origin") ||
           request.get_header_value("Origin") == host;
  }
};

LiveServer::LiveServer(int port, const LiveAnswers& answers, double patience)
    : impl_(std::make_unique<Impl>()) {
  httplib::Server& server = impl_->server;
  server.new_task_queue = [this, patience] {
    return impl_->queue = new ConnectionQueue(impl_->port, patience);
  };
  server.set_keep_alive_max_count(1);
  server.set_read_timeout(std::chrono::duration<double>(patience));
  server.set_write_timeout(std::chrono::duration<double>(patience));
  // The library's default would let two programs listen on one port.
  int listening = -1;
  server.set_socket_options([&listening](socket_t socket) {
    listening = socket;
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    const int received = 2 * longest_headers;  // of each connection, before the library reads it
    setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &received, sizeof received);
  });
  server.set_payload_max_length(largest_body);
  server.set_default_headers(
      {{"Cache-Control", "no-store"},
       {"Referrer-Policy", "same-origin"},
       {"X-Content-Type-Options", "nosniff"},
       {"Content-Security-Policy", "frame-ancestors 'none'"}});  // the page itself has the rest
  server.set_pre_routing_handler([this](const Request& request, Response& response) {
    // Before the body is read: only the page may send one.
    const bool ours = impl_->is_ours(request);
    // The library would read as many bytes as it is told of, to throw them away.
    if (std::strtoull(request.get_header_value("Content-Length").c_str(), nullptr, 10) > largest_body) {
      refuse(response, 413, "No request of the page is so long.");
      return httplib::Server::HandlerResponse::Handled;
    }
    if (ours && request.path.starts_with(impl_->base)) {
      impl_->queue->keep(request.remote_port);
      return httplib::Server::HandlerResponse::Unhandled;
    }
    refuse(response, ours ? 404 : 403,
           ours ? "There is nothing here."
                : "Refused: the request comes from elsewhere than the live view's own page. A port that is "
                  "forwarded to it must be " +
                      std::to_string(impl_->port) + " too.");
    return httplib::Server::HandlerResponse::Handled;
  });

  const std::string& base = impl_->base;
  const auto page = std::make_shared<const std::string>(answers.page);
  server.Get(
      base, [page](const Request&, Response& response) { send(response, page, "text/html; charset=utf-8"); });
  server.Get(base + "news", [answers](const Request& request, Response& response) {
    const long version = std::atol(request.get_param_value("version").c_str());
    const long rows = std::atol(request.get_param_value("rows").c_str());
    std::string news = answers.news(version, static_cast<std::size_t>(std::max(rows, 0L)));
    if (news.empty())
      response.status = 204;
    else
      send(response, std::make_shared<const std::string>(std::move(news)), "application/json");
  });
  server.Get(base + "block/([a-zA-Z0-9_-]+)", [answers](const Request& request, Response& response) {
    if (const auto block = answers.block(request.matches[1]))
      send(response, block, "application/octet-stream");
    else
      refuse(response, 404, "This state has been replaced by a newer one.");
  });
  const auto post = [&](const std::string& name, const std::function<std::string()>& action) {
    server.Post(base + name,
                [action](const Request& request, Response& response, const httplib::ContentReader& read) {
                  // Without a length the library would wait for a body until the peer closes the connection.
                  const auto skip = [](const char*, std::size_t) { return true; };
                  if (request.has_header("Content-Length") && !read(skip)) return;
                  response.status = 204;
                  if (const std::string why_not = action(); !why_not.empty()) refuse(response, 409, why_not);
                });
  };
  post("stop", [answers] {
    answers.stop();
    return std::string();
  });
  post("refine", answers.refine);

  errno = 0;
  const int bound =
      port == 0 ? server.bind_to_any_port("127.0.0.1") : (server.bind_to_port("127.0.0.1", port) ? port : -1);
  if (bound <= 0)
    throw std::runtime_error(
        "--port " + std::to_string(port) + ": cannot listen on 127.0.0.1:" + std::to_string(port) + " (" +
        std::strerror(errno) + "); name another port, or leave --port out for one that is free");
  // The library has the system let five connections wait; a sixth would come back after a second or more. A
  // page needs few, and would itself wait long behind thousands that others have closed.
  ::listen(listening, 64);
  impl_->port = bound;
  url_ = "http://127.0.0.1:" + std::to_string(bound) + base;
  const HeldSignals held;
  impl_->thread = std::thread([this] {
    impl_->server.listen_after_bind();
    impl_->ended = true;
  });
}

LiveServer::~LiveServer() {
  // A server that does not listen yet would miss the stop.
  while (!impl_->server.is_running() && !impl_->ended) std::this_thread::yield();
  impl_->server.stop();
  // The library ends its connections only between reads: a peer that sends a byte now and then would delay
  // the end for ever.
  while (!impl_->ended) {
    for (const auto& [peer, socket] : connections_to(impl_->port)) ::shutdown(socket, SHUT_RDWR);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  impl_->thread.join();
}

}  // namespace drape
