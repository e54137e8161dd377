// The live view's server against peers that take their time or send what no browser does.

#include "core/app/view/live_server.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <memory>
#include <optional>

#include "core/kernel/linear_algebra/stopwatch.h"
#include "tests/support/live_client.h"

using namespace drape;

namespace {

struct Served {
  int stops = 0;
  std::string body = std::string(100000, 'p');
  LiveAnswers answers{[this] { return body; }, [](long, std::size_t) { return ""; },
                      [this](const std::string&) { return std::make_shared<const std::string>(body); },
                      [this] { ++stops; }, [] { return ""; }};
  std::optional<LiveServer> server{std::in_place, 0, answers};
  LiveAddress address{server->url()};
  std::string path = address.path;
  int port = address.port;

  std::string request(const std::string& method, const std::string& target,
                      const std::string& more = "") const {
    return address.request(method, target, more);
  }
  std::optional<std::string> answer(const std::string& request, double seconds = 10) const {
    const LiveClient client(port);
    client.send(request);
    return client.answer(seconds);
  }
  /// Status code, or 0 without an answer.
  int status(const std::string& request, double seconds = 10) const {
    const std::string text = answer(request, seconds).value_or("");
    return text.starts_with("HTTP/1.1 ") ? std::stoi(text.substr(9)) : 0;
  }
  bool serves_page(double seconds) const {
    const auto text = answer(request("GET", path), seconds);
    return text && text->starts_with("HTTP/1.1 200") && text->ends_with(body);
  }
};

}  // namespace

TEST_CASE("forty slow peers delay neither the page nor the shutdown") {
  Served served;
  REQUIRE(served.serves_page(10));
  std::vector<std::unique_ptr<LiveClient>> slow;
  for (int k = 0; k < 40; ++k) {
    slow.push_back(std::make_unique<LiveClient>(served.port));
    slow.back()->send("GET / HTTP/1.1\r\n");
  }
  const Stopwatch attack;
  int pages = 0;
  while (attack.seconds() < 3) {
    for (std::unique_ptr<LiveClient>& client : slow)
      if (!client->send("X-A: b\r\n")) {  // closed by the server: comes again
        client = std::make_unique<LiveClient>(served.port);
        client->send("GET / HTTP/1.1\r\n");
      }
    REQUIRE(served.serves_page(10));
    ++pages;
  }
  CHECK(pages >= 2);
  const Stopwatch end;
  served.server.reset();
  CHECK(end.seconds() < 3);  // at once; a busy machine takes its time
}

TEST_CASE("a peer that reads none of its answer does not delay the shutdown") {
  Served served;
  served.body = std::string(50000000, 'p');
  std::vector<std::unique_ptr<LiveClient>> deaf;
  for (int k = 0; k < 4; ++k) {
    deaf.push_back(std::make_unique<LiveClient>(served.port));
    deaf.back()->send(served.request("GET", served.path + "block/b"));
  }
  CHECK(served.status(served.request("GET", "/")) == 404);
  const Stopwatch end;
  served.server.reset();
  CHECK(end.seconds() < 3);  // at once; a busy machine takes its time
}

TEST_CASE("a request that does not arrive in time, or has too many bytes, is given up") {
  const Served served;
  const LiveClient idle(served.port), endless(served.port);
  const Stopwatch watch;
  for (int k = 0; k < 1000 && endless.send("X-A: " + std::string(1000, 'a') + "\r\n"); ++k) usleep(1000);
  CHECK(watch.seconds() < 4);  // closed after some of it
  CHECK(endless.answer(10).has_value());
  CHECK(idle.answer(15) == "");
  CHECK(watch.seconds() > 3);
  CHECK(watch.seconds() < 15);
}

TEST_CASE("lengths that are none, bodies of any size and long lines are refused at once") {
  const Served served;
  const auto post = [&](const std::string& more, const std::string& body = "") {
    return served.status(served.request("POST", served.path + "stop", more) + body);
  };
  for (const std::string length : {"-1", "1025", "99999999999999999999", "18446744073709551615", "1x", ""}) {
    CAPTURE(length);
    CHECK(post("Content-Length: " + length + "\r\n", std::string(2000, 'x')) == 400);
  }
  CHECK(post("Transfer-Encoding: chunked\r\n", "5\r\nhello\r\n") == 400);
  CHECK(post("Content-Length: 0\r\nContent-Length: -1\r\n") == 400);
  CHECK(served.stops == 0);
  CHECK(post("Content-Length: 5\r\n", "hello") == 204);
  CHECK(served.stops == 1);
  CHECK(served.status(served.request("GET", "/" + std::string(9000, 'a'))) == 414);
  CHECK(served.status(served.request("GET", served.path, "X-A: " + std::string(9000, 'a') + "\r\n")) == 400);
  CHECK(served.status("GET " + std::string(100000, 'a')) == 0);
  // These go through regular expressions, which must not run out of stack.
  std::string ranges = "bytes=0-1";
  while (ranges.size() < 8000) ranges += ",0-1";
  CHECK(served.status(served.request("GET", "/", "Range: " + ranges + "\r\n")) >= 400);
  CHECK(served.status(served.request("GET", served.path + "block/" + std::string(8000, 'a'))) == 200);
  CHECK(served.serves_page(10));
}
