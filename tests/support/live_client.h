#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <string>

/// The parts of a live view's address, http://HOST:PORT/TOKEN/.
struct LiveAddress {
  explicit LiveAddress(const std::string& url)
      : host(url.substr(7, url.find('/', 7) - 7)),
        path(url.substr(url.find('/', 7))),
        port(std::stoi(host.substr(host.find(':') + 1))) {}

  std::string request(const std::string& method, const std::string& target,
                      const std::string& more = "") const {
    return method + " " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
  }

  std::string host, path;
  int port;
};

/// A connection to a live view's server.
class LiveClient {
 public:
  /// With SOCK_NONBLOCK in `flags` nothing waits for the connection, which may be refused.
  explicit LiveClient(int port, int flags = 0)
      : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | flags, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int refused = connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    REQUIRE((refused == 0 || flags != 0));
  }
  ~LiveClient() { close(socket_); }
  LiveClient(const LiveClient&) = delete;

  /// Whether all of it could be sent.
  bool send(const std::string& text) const {
    return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == ssize_t(text.size());
  }

  /// Whether the server has closed the connection.
  bool is_ended() const {
    char byte;
    return recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
  }

  /// The bytes that come until the server closes the connection. ctest's limit ends a wait in vain.
  std::string answer() const {
    std::string all;
    char buffer[4096];
    for (ssize_t n; (n = recv(socket_, buffer, sizeof buffer, 0)) > 0;)
      all.append(buffer, static_cast<std::size_t>(n));
    return all;
  }

 private:
  int socket_;
};
