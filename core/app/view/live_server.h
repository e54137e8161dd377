#pragma once

#include <functional>
#include <memory>
#include <string>

namespace drape {

/// The live view's answers. Called on the server's threads, several at a time.
struct LiveAnswers {
  std::string page;  ///< HTML
  /// JSON of everything newer than that version and that number of rows; empty if there is nothing.
  std::function<std::string(long version, std::size_t rows)> news;
  std::function<std::shared_ptr<const std::string>(const std::string& name)> block;  ///< null if unknown
  std::function<void()> stop;
  std::function<std::string()> refine;  ///< empty, or why it is not possible
};

/// Serves the live view on 127.0.0.1 only, under an unguessable path. Refuses requests for another host name
/// and actions from other sites' pages. No peer delays the end.
class LiveServer {
 public:
  /// Starts to listen; port 0 takes any free one. A peer has `patience` seconds for each part of its
  /// request, and as many to take a part of the answer. Throws std::runtime_error if the port is not
  /// available.
  LiveServer(int port, const LiveAnswers& answers, double patience = 5);
  ~LiveServer();

  const std::string& url() const { return url_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string url_;
};

}  // namespace drape
