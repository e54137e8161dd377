#include "core/app/view/live_server.h"

#include <httplib.h>
#include <sys/random.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "core/app/view/connections.h"

namespace drape {

namespace {

using httplib::Request, httplib::Response;

std::string random_token() {
  unsigned char bytes[16];
  if (getrandom(bytes, sizeof bytes, 0) != sizeof bytes)
    throw std::runtime_error("--view: the system gives no random numbers for the address");
  std::string token;
  char digits[3];
  for (const unsigned char byte : bytes) std::snprintf(digits, sizeof digits, "%02x", byte), token += digits;
  return token;
}

/// Through a content provider: the library would compress a plain body slowly.
void send(Response& response, const std::shared_ptr<const std::string>& body, const char* type) {
  const std::size_t size = body->size();
  response.set_content_provider(size, type,
                                [body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(body->data() + offset, length);
                                });
}

void send(Response& response, std::string body, const char* type) {
  send(response, std::make_shared<const std::string>(std::move(body)), type);
}

void refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", "text/plain");
}

constexpr std::size_t largest_body = 1024;  // [bytes]; no request of the page has one

/// The library's server with our own connections: its limits apply to a single read, and a peer that sends a
/// byte now and then would block a thread and the shutdown for ever.
class BoundedServer final : public httplib::Server {
 public:
  explicit BoundedServer(double patience)
      : connections_({.reading = patience, .writing = patience}, [this](httplib::Stream& stream) {
          bool closed = false;
          process_request(stream, true, closed, nullptr);
        }) {
    // The listening thread only passes connections on.
    struct AtOnce final : httplib::TaskQueue {
      void enqueue(std::function<void()> task) override { task(); }
      void shutdown() override {}
    };
    new_task_queue = [] { return new AtOnce; };
  }

  /// The library's backlog is five connections: of a burst, the others would retry after a second.
  void lengthen_queue() { ::listen(svr_sock_, SOMAXCONN); }
  void end_connections() { connections_.end(); }

 private:
  bool process_and_close_socket(socket_t socket) override {
    connections_.take(socket);
    return true;
  }

  Connections connections_;
};

/// Why the request's body is refused; empty if it is not. The library accepts "-1" as a length.
std::string fault_of_body(const Request& request) {
  if (request.has_header("Transfer-Encoding")) return "the live view takes no body in parts";
  // For these the library would wait for a body until the connection closes.
  if (request.method != "GET" && request.method != "HEAD" && !request.has_header("Content-Length"))
    return "Content-Length is missing";
  for (std::size_t k = 0; k < request.get_header_value_count("Content-Length"); ++k) {
    const std::string length = request.get_header_value("Content-Length", k);
    std::size_t bytes = 0;
    const char* end = length.data() + length.size();
    const auto [rest, error] = std::from_chars(length.data(), end, bytes);
    if (error != std::errc() || rest != end || bytes > largest_body)
      return "Content-Length must be 0 to " + std::to_string(largest_body);
  }
  return "";
}

}  // namespace

struct LiveServer::Impl {
  explicit Impl(double patience) : server(patience) {}

  BoundedServer server;
  std::thread thread;
  std::atomic<bool> ended = false;
  std::string origin, same_origin;  // http://127.0.0.1:port, and by name

  /// Whether the request is for the printed address. This stops DNS rebinding and cross-site requests.
  bool is_ours(const Request& request) const {
    const std::string host = "http://" + request.get_header_value("Host");
    if (host != origin && host != same_origin) return false;
    return request.method == "GET" || !request.has_header("Origin") ||
           request.get_header_value("Origin") == host;
  }
};

LiveServer::LiveServer(int port, const LiveAnswers& answers, double patience)
    : impl_(std::make_unique<Impl>(patience)) {
  httplib::Server& server = impl_->server;
  // The library's default would let two programs listen on one port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_payload_max_length(largest_body);
  server.set_default_headers(
      {{"Cache-Control", "no-store"},
       {"Referrer-Policy", "same-origin"},
       {"X-Content-Type-Options", "nosniff"},
       {"Content-Security-Policy",
        "default-src 'none'; img-src data:; connect-src 'self'; frame-ancestors 'none'; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'"}});
  server.set_pre_routing_handler([this](const Request& request, Response& response) {
    if (const std::string fault = fault_of_body(request); !fault.empty()) {
      refuse(response, 400, "Refused: " + fault + ".");
      return httplib::Server::HandlerResponse::Handled;
    }
    if (impl_->is_ours(request)) return httplib::Server::HandlerResponse::Unhandled;
    refuse(response, 403, "Refused: the request comes from elsewhere than the live view's own page.");
    return httplib::Server::HandlerResponse::Handled;
  });

  const std::string base = "/" + random_token() + "/";
  server.Get(base, [answers](const Request&, Response& response) {
    send(response, answers.page(), "text/html; charset=utf-8");
  });
  server.Get(base + "news", [answers](const Request& request, Response& response) {
    const long version = std::atol(request.get_param_value("version").c_str());
    const long rows = std::atol(request.get_param_value("rows").c_str());
    std::string news = answers.news(version, static_cast<std::size_t>(std::max(rows, 0L)));
    if (news.empty()) {
      response.status = 204;
    } else {
      send(response, std::move(news), "application/json");
    }
  });
  server.Get(base + "block/([a-zA-Z0-9_-]+)", [answers](const Request& request, Response& response) {
    if (const auto block = answers.block(request.matches[1]))
      send(response, block, "application/octet-stream");
    else
      refuse(response, 404, "This state has been replaced by a newer one.");
  });
  server.Post(base + "stop", [answers](const Request&, Response& response) {
    answers.stop();
    response.status = 204;
  });
  server.Post(base + "refine", [answers](const Request&, Response& response) {
    const std::string why_not = answers.refine();
    if (why_not.empty())
      response.status = 204;
    else
      refuse(response, 409, why_not);
  });

  errno = 0;
  const int bound =
      port == 0 ? server.bind_to_any_port("127.0.0.1") : (server.bind_to_port("127.0.0.1", port) ? port : -1);
  if (bound <= 0)
    throw std::runtime_error(
        "--port " + std::to_string(port) + ": cannot listen on 127.0.0.1:" + std::to_string(port) + " (" +
        std::strerror(errno) + "); name another port, or leave --port out for one that is free");
  impl_->server.lengthen_queue();
  impl_->origin = "http://127.0.0.1:" + std::to_string(bound);
  impl_->same_origin = "http://localhost:" + std::to_string(bound);
  url_ = impl_->origin + base;
  impl_->thread = std::thread([this] {
    impl_->server.listen_after_bind();
    impl_->ended = true;
  });
}

LiveServer::~LiveServer() {
  // A server that does not listen yet would miss the stop.
  while (!impl_->server.is_running() && !impl_->ended) std::this_thread::yield();
  impl_->server.stop();
  impl_->thread.join();
  impl_->server.end_connections();
}

}  // namespace drape
