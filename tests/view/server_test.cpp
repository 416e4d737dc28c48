// The server as a browser and as others meet it, over sockets of this machine.
// SPDX-License-Identifier: Apache-2.0
#include "view/server.h"

#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

#include "support/temporary_folder.h"
#include "umbrick/core/error.h"
#include "view/view_fixture.h"

using namespace umbrick;
using namespace umbrick::view;
namespace beast = boost::beast;
namespace http = beast::http;
namespace asio = boost::asio;

namespace {

struct Served {
  TemporaryFolder folder;
  Viewer viewer{testScene(),   testVolume(), EngineKind::cpu, {.targetError = 0.05, .mostSamples = 4},
                folder.path(), openForTest};
  ViewServer server{viewer, {.token = "secret"}};
  std::atomic<bool> stop{false};
  std::thread thread{[this] { server.run([this] { return stop.load(); }); }};
  asio::io_context io;

  ~Served() {
    stop = true;
    thread.join();
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(server.port()); }
  beast::tcp_stream connect() {
    beast::tcp_stream stream(io);
    stream.connect({asio::ip::make_address("127.0.0.1"), server.port()});
    return stream;
  }
  http::response<http::string_body> ask(const std::string& target, const std::string& as = {},
                                        http::verb verb = http::verb::get) {
    beast::tcp_stream stream = connect();
    http::request<http::empty_body> request(verb, target, 11);
    request.set(http::field::host, as.empty() ? host() : as);
    http::write(stream, request);
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    if (verb == http::verb::head) parser.skip(true);
    http::read(stream, buffer, parser);
    return parser.release();
  }
  // Sends a file as a page does. @param stated  its length as the head says it; negative: as it is
  int send(const std::string& name, const std::string& bytes, const std::string& origin, long stated = -1) {
    beast::tcp_stream stream = connect();
    const long length = stated < 0 ? static_cast<long>(bytes.size()) : stated;
    const std::string head = "POST /secret/upload/" + name + " HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: " + origin +
                             "\r\nContent-Length: " + std::to_string(length) + "\r\n\r\n";
    beast::error_code ignored;
    asio::write(stream, asio::buffer(head + bytes), ignored);
    if (stated > static_cast<long>(bytes.size())) stream.socket().shutdown(asio::socket_base::shutdown_send, ignored);
    beast::flat_buffer buffer;
    http::response<http::string_body> response;
    http::read(stream, buffer, response, ignored);
    return ignored ? 0 : response.result_int();
  }
  // Returns whether a page may connect.
  bool mayConnect(const std::string& target, const std::string& origin, const std::string& as = {}) {
    beast::websocket::stream<beast::tcp_stream> socket(connect());
    socket.set_option(beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
      if (!origin.empty()) request.set(http::field::origin, origin);
    }));
    beast::error_code failed;
    socket.handshake(as.empty() ? host() : as, target, failed);
    return !failed;
  }
};

}  // namespace

TEST_CASE("The page is served to who has the token", "[view]") {
  Served served;
  const auto page = served.ask("/secret/");
  CHECK(page.result_int() == 200);
  CHECK(page[http::field::content_type] == "text/html; charset=utf-8");
  CHECK(page.body().find("view.js") != std::string::npos);
  CHECK(served.ask("/secret/view.js").result_int() == 200);
  CHECK(served.ask("/secret/view.js?x=1").result_int() == 200);
  CHECK(served.ask("/secret/view.css", {}, http::verb::head).result_int() == 200);
  CHECK(served.ask("/secret/../view.cpp").result_int() == 404);
  CHECK(served.ask("/secret/nothing").result_int() == 404);
  CHECK(served.ask("/secret/", {}, http::verb::post).result_int() == 405);
  for (const char* target : {"/", "/secre/", "/secreT/", "/secrets/", "/secret", "//secret/"})
    CHECK(served.ask(target).result_int() == 403);
}

TEST_CASE("Names that are turned to this machine, and pages of others, are refused", "[view]") {
  Served served;
  CHECK(served.ask("/secret/", "evil.example").result_int() == 403);
  CHECK(served.ask("/secret/", "evil.example:80").result_int() == 403);
  // Names that are no names of this machine, however much they look like one.
  for (const char* host : {"localhost.evil.example", "localhost.evil.example:80", "localhost:1@evil.example",
                           "localhost:", "localhost:123456", "localhost:80:80", "127.0.0.1.evil.example", "127.0.0.11",
                           "::1", "[::1]x", "evil.example/localhost", "0.0.0.0"}) {
    INFO(host);
    CHECK(served.ask("/secret/", host).result_int() == 403);
  }
  CHECK(served.mayConnect("/secret/socket", "http://" + served.host()));
  CHECK_FALSE(served.mayConnect("/secret/socket", "http://evil.example"));
  CHECK_FALSE(served.mayConnect("/secret/socket", ""));
  CHECK_FALSE(served.mayConnect("/other/socket", "http://" + served.host()));
  CHECK_FALSE(served.mayConnect("/secret/", "http://" + served.host()));
}

// As with ssh -L 1234:localhost:PORT: the browser knows the other end alone.
TEST_CASE("A tunnel ends at another port of this machine's own names, and its page may connect", "[view]") {
  Served served;
  for (const std::string host : {"localhost:1234", "127.0.0.1:1234", "[::1]:1234", "localhost"}) {
    INFO(host);
    CHECK(served.ask("/secret/", host).result_int() == 200);
    CHECK(served.mayConnect("/secret/socket", "http://" + host, host));
    // The page of another server behind another port of the same name is another page.
    CHECK_FALSE(served.mayConnect("/secret/socket", "http://localhost:4321", host));
    CHECK_FALSE(served.mayConnect("/secret/socket", "http://" + served.host(), host));
  }
  CHECK_FALSE(served.mayConnect("/secret/socket", "http://evil.example:1234", "evil.example:1234"));
}

TEST_CASE("Frames wait until the one before is shown", "[view]") {
  Served served;
  beast::websocket::stream<beast::tcp_stream> socket(served.connect());
  socket.set_option(beast::websocket::stream_base::decorator(
      [&](beast::websocket::request_type& request) { request.set(http::field::origin, "http://" + served.host()); }));
  socket.handshake(served.host(), "/secret/socket");
  int frames = 0, done = 0;
  const auto read = [&](bool acknowledge) {
    beast::flat_buffer buffer;
    socket.read(buffer);
    const std::string bytes = beast::buffers_to_string(buffer.data());
    if (socket.got_binary()) {
      ++frames;
      std::size_t length = 0;
      for (std::size_t i = 4; i-- > 0;) length = length << 8 | static_cast<unsigned char>(bytes[i]);
      const auto head = nlohmann::json::parse(bytes.substr(4, length));
      CHECK(head["frame"] == frames);
      const std::string image = bytes.substr(4 + length);
      CHECK((image.starts_with("\x89PNG") || image.starts_with("\xff\xd8")));
      if (acknowledge) {
        socket.text(true);
        socket.write(asio::buffer(nlohmann::json{{"type", "shown"}, {"frame", frames}}.dump()));
      }
    } else if (const auto text = nlohmann::json::parse(bytes); text["type"] == "status") {
      done += text["done"] == true;
    }
  };
  while (done == 0) read(false);
  CHECK(frames == 1);  // the others gave way to newer ones
  socket.text(true);
  socket.write(asio::buffer(std::string(R"({"type": "shown", "frame": 1})")));
  while (frames < 2) read(true);
}

TEST_CASE("What is no HTTP, too long, or more connections than there may be leave the server up", "[view]") {
  Served served;
  const auto sendRaw = [&](const std::string& bytes) {
    beast::tcp_stream stream = served.connect();
    beast::error_code ignored;
    asio::write(stream, asio::buffer(bytes), ignored);
    std::string answer(1, ' ');
    stream.expires_after(std::chrono::seconds(30));
    stream.read_some(asio::buffer(answer), ignored);
  };
  sendRaw("hello\r\n\r\n");
  sendRaw("GET /secret/ HTTP/1.1\r\nX: " + std::string(100000, 'a') + "\r\n\r\n");
  sendRaw("POST /secret/ HTTP/1.1\r\nContent-Length: 1000000000\r\n\r\n");
  std::vector<beast::tcp_stream> many;
  for (int i = 0; i < kMostConnections + 10; ++i) many.push_back(served.connect());
  many.clear();
  CHECK(served.ask("/secret/").result_int() == 200);
  // A message that is too long ends its page alone.
  beast::websocket::stream<beast::tcp_stream> socket(served.connect());
  socket.set_option(beast::websocket::stream_base::decorator(
      [&](beast::websocket::request_type& request) { request.set(http::field::origin, "http://" + served.host()); }));
  socket.handshake(served.host(), "/secret/socket");
  beast::error_code failed;
  socket.write(asio::buffer(std::string(2 * kMostMessageBytes, 'a')), failed);
  beast::flat_buffer buffer;
  while (!failed) socket.read(buffer, failed);
  CHECK(served.ask("/secret/").result_int() == 200);
}

TEST_CASE("A file of a page is taken from the server's own pages, with a plain name, up to a size", "[view]") {
  Served served;
  const auto page = std::make_shared<NotingClient>();
  served.viewer.join(page);
  const std::string own = "http://" + served.host(), file = metaImage();
  CHECK(served.send("a.mha", file, "http://evil.example") == 403);
  CHECK(served.send("a.mha", file, "") == 403);
  CHECK(served.send("a.txt", file, own) == 400);
  CHECK(served.send("..%2fa.mha", file, own) == 400);
  CHECK(served.send("../a.mha", file, own) == 400);
  CHECK(served.send(".a.mha", file, own) == 400);
  // A size beyond the limit is refused before anything of it is read.
  CHECK(served.send("a.mha", "", own, static_cast<long>(kMostUploadBytes) + 1) == 413);
  CHECK(served.ask("/secret/upload/a.mha").result_int() == 404);
  // One that breaks off is forgotten.
  CHECK(served.send("a.mha", "ObjectType", own, 1000) != 200);
  CHECK(served.send("a.mha", file, own) == 200);
  const auto done =
      page->take([](const auto& text) { return text["type"] == "opening" && text["state"] != "running"; });
  CHECK(done["state"] == "done");
  CHECK(served.ask("/secret/").result_int() == 200);
}

TEST_CASE("Pages reach nothing outside of the folder over their sockets", "[view]") {
  Served served;
  const auto outside = served.folder.path().parent_path() / (served.folder.path().filename().string() + ".mha");
  std::ofstream(outside) << metaImage();
  std::filesystem::create_symlink(outside, served.folder.path() / "link.mha");
  beast::websocket::stream<beast::tcp_stream> socket(served.connect());
  socket.set_option(beast::websocket::stream_base::decorator(
      [&](beast::websocket::request_type& request) { request.set(http::field::origin, "http://" + served.host()); }));
  socket.handshake(served.host(), "/secret/socket");
  socket.text(true);
  const auto answerTo = [&](const nlohmann::json& message) {
    socket.write(asio::buffer(message.dump()));
    for (;;) {
      beast::flat_buffer buffer;
      socket.read(buffer);
      if (!socket.got_text()) continue;
      const auto text = nlohmann::json::parse(beast::buffers_to_string(buffer.data()));
      if (text["type"] == "error" || text["type"] == "opening" || text["type"] == "files") return text;
    }
  };
  for (const std::string& path : {outside.string(), "../" + outside.filename().string(), std::string("link.mha"),
                                  std::string("/etc/passwd"), std::string("..")}) {
    INFO(path);
    CHECK(answerTo({{"type", "open"}, {"path", path}})["type"] == "error");
    CHECK(answerTo({{"type", "files"}, {"path", path}})["type"] == "error");
  }
  CHECK(answerTo({{"type", "files"}, {"path", ""}})["entries"].empty());
  std::filesystem::remove(outside);
}

TEST_CASE("A port that is taken and a host that is none are said", "[view]") {
  Served served;
  CHECK_THROWS_AS(ViewServer(served.viewer, {.port = served.server.port()}), IoError);
  CHECK_THROWS_WITH(ViewServer(served.viewer, {.host = "nowhere"}), Catch::Contains("'nowhere' is no address"));
}
