// SPDX-License-Identifier: MIT
// The page over HTTP: what is served, to whom, and that no client holds anything.
#include "tools/live/web/server.hpp"

#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/json_text.hpp"

using namespace unisim::live::web;

namespace {

constexpr int kPatienceSeconds = 60;  // against a hang; nothing here takes a second

/// A server on a port of its own, and a client.
struct Serving {
  explicit Serving(const std::string& token = "")
      : server(std::make_unique<Server>(&feed, Address(), token)),
        port(std::stoi(server->url().substr(server->url().rfind(':') + 1))),
        client("127.0.0.1", port) {
    client.set_read_timeout(kPatienceSeconds);
  }

  Feed feed{"test"};
  std::unique_ptr<Server> server;
  int port;
  httplib::Client client;
};

/// A view with an image that no JPEG makes small.
View big_view(int64_t frames) {
  View view;
  view.progress.frames = frames;
  view.has_image = true;
  view.pixels.resize(size_t{640} * 480);
  uint32_t noise = 1;
  for (uint8_t& pixel : view.pixels) {
    noise = noise * 1664525U + 1013904223U;
    pixel = static_cast<uint8_t>(noise >> 24);
  }
  view.image = {view.pixels.data(), 640, 480, 640, UNISIM_PIXEL_GRAY8};
  return view;
}

/// A client that asks for the events and then does nothing any more.
int silent_client(int port) {
  const int file = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  const std::string request = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";
  REQUIRE(write(file, request.data(), request.size()) == static_cast<ssize_t>(request.size()));
  return file;
}

bool wait_until(const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(kPatienceSeconds);
  while (!done() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return done();
}

}  // namespace

TEST_CASE("the page is one document that needs nothing from elsewhere") {
  Serving serving;
  const auto page = serving.client.Get("/");
  REQUIRE(page);
  CHECK(page->status == 200);
  CHECK(has(page->get_header_value("Content-Type"), "text/html"));
  CHECK(has(page->body, "new EventSource('events' + location.search)"));
  CHECK(has(page->body, "prefers-color-scheme: dark"));
  CHECK_FALSE(has(page->body, "src=\"http"));
  CHECK_FALSE(has(page->body, "@UNISIM"));
  CHECK(serving.client.Get("/elsewhere")->status == 404);
}

TEST_CASE("events carry the figures, the image with its features and the map") {
  Serving serving;
  View view = big_view(77);
  view.progress.frames_dropped = 5;
  view.session.keyframes = 12;
  view.stages.push_back({"observe", 77, 8.0, 15.5, 99.0});
  view.features = {{10.0F, 20.0F, 1}, {30.5F, 40.0F, 0}};
  view.has_map = true;
  view.segment = 0;
  view.live = {{-1, 0, {{0, 0, 0, 1}, {0, 0, 0}, 1}}, {-1, 0, {{0, 0, 0, 1}, {1, 0, 2}, 1}}};
  view.corrected = view.live;
  std::string got;
  const auto ends_after = [&got](const char* part) {
    const size_t begin = got.find(part);
    return begin != std::string::npos && got.find("\n\n", begin) != std::string::npos;
  };
  const auto whole = [&] {
    return ends_after("\"frames\":77,") && ends_after("event: frame\n") &&
           ends_after("event: map\n");
  };
  serving.client.Get("/events", [&](const char* data, size_t size) {
    View offered = view;
    offered.image.data = offered.pixels.data();
    serving.feed.offer(&offered);
    got.append(data, size);
    return !whole();
  });
  REQUIRE(whole());
  CHECK(has(got, "\"frames_dropped\":5,"));
  CHECK(has(got, "\"keyframes\":12,"));
  CHECK(has(got,
            "{\"name\":\"observe\",\"count\":77,\"p50_ms\":8.0,\"p95_ms\":15.5,\"max_ms\":99.0}"));
  CHECK(has(got, "\"features\":[10.0,20.0,1,30.5,40.0,0]"));
  CHECK(has(got, "\"jpeg\":\"/9j/"));
  CHECK(has(got, "\"live\":[0,0,2048,4096]"));
}

TEST_CASE("a client that does not read is dropped, and holds nothing before") {
  Serving serving;
  const int client = silent_client(serving.port);
  REQUIRE(wait_until([&] { return serving.feed.watched(); }));
  int64_t frames = 0;
  const bool dropped = wait_until([&] {
    View view = big_view(++frames);
    serving.feed.offer(&view);
    return !serving.feed.watched();
  });
  CHECK(dropped);
  CHECK(serving.client.Get("/")->status == 200);
  close(client);
}

TEST_CASE("a few may watch, one more is told so") {
  Serving serving;
  int clients[4];
  for (int& client : clients) client = silent_client(serving.port);
  REQUIRE(wait_until([&] { return serving.feed.watchers() == 4; }));
  CHECK(serving.client.Get("/events")->status == 503);
  CHECK(serving.client.Get("/")->status == 200);
  for (const int client : clients) close(client);
}

TEST_CASE("the end does not wait for those who watch or have said nothing yet") {
  auto serving = std::make_unique<Serving>();
  const int client = silent_client(serving->port);
  REQUIRE(wait_until([&] { return serving->feed.watched(); }));
  const auto start = std::chrono::steady_clock::now();
  serving.reset();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  // Less than a second on a machine with nothing else to do.
  CHECK(spent.count() < 20.0);
  close(client);
}

TEST_CASE("with a token nothing is served without it") {
  Serving serving("se cret");
  for (const char* path : {"/", "/events", "/?token=wrong", "/events?token=se"}) {
    INFO(path);
    const auto answer = serving.client.Get(path);
    REQUIRE(answer);
    CHECK(answer->status == 403);
  }
  CHECK(serving.client.Get("/?token=se%20cret")->status == 200);
}

TEST_CASE("without a token a request must name this machine") {
  Serving serving;
  CHECK(serving.client.Get("/", {{"Host", "evil.example.org"}})->status == 403);
  CHECK(serving.client.Get("/", {{"Host", "localhost:1"}})->status == 200);
}

TEST_CASE("an address of another machine is named, with what to do") {
  Feed feed("test");
  Address address;
  address.host = "192.0.2.1";
  address.port = 8080;
  try {
    Server server(&feed, address, "secret");
    FAIL("an address that is not ours");
  } catch (const unisim::tools::Failure& failure) {
    CHECK(failure.code() == unisim::tools::kExitLimit);
    CHECK(has(failure.what(), "--web 192.0.2.1:8080: "));
    CHECK(has(failure.what(), "give an address of this machine"));
  }
}

TEST_CASE("a port that is taken is named, with what to do") {
  Serving serving;
  Feed feed("test");
  Address address;
  address.port = serving.port;
  try {
    Server second(&feed, address, "");
    FAIL("two servers on one port");
  } catch (const unisim::tools::Failure& failure) {
    CHECK(failure.code() == unisim::tools::kExitLimit);
    CHECK(has(failure.what(), "another program has this port"));
  }
}
