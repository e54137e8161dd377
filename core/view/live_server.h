#pragma once

#include <functional>
#include <memory>
#include <string>

namespace drape {

/// The live view's answers. Called on the server's threads, several at a time.
struct LiveAnswers {
  std::function<std::string()> page;  ///< HTML
  /// JSON of what is newer than that version and that number of rows; empty where nothing is.
  std::function<std::string(long version, std::size_t rows)> news;
  std::function<std::shared_ptr<const std::string>(const std::string& name)> block;  ///< null if unknown
  std::function<void()> stop;
  std::function<std::string()> refine;  ///< empty, or why that cannot be
};

/// Serves the live view on 127.0.0.1 alone, under a path that nobody can guess. Requests for another host
/// name, and actions from another site's pages, are refused. Whatever peers do, the page is served and the
/// end comes (see ConnectionLimits).
class LiveServer {
 public:
  /// Listens from now on; port 0 takes any that is free. Throws std::runtime_error where the port cannot be
  /// had.
  LiveServer(int port, const LiveAnswers& answers);
  ~LiveServer();

  const std::string& url() const { return url_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string url_;
};

}  // namespace drape
