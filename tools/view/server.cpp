// SPDX-License-Identifier: Apache-2.0
#include "view/server.h"

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {
std::string_view pageFile(std::string_view name);
std::vector<std::string> pageFileNames();
}  // namespace umbrick

namespace umbrick::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr auto kPatience = std::chrono::seconds(20);  // for the rest of a request, and for a page to take an answer
constexpr auto kLongestUpload = std::chrono::minutes(10);
constexpr std::size_t kMostTexts = 1000;  // that wait for one page: it does not read any more

// The path of a file that a page sends begins so, behind the token.
constexpr std::string_view kUpload = "upload/";

std::string randomToken() {
  std::random_device random;
  std::string token;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (int word = 0; word < 4; ++word)
    for (unsigned bits = random(), i = 0; i < 8; ++i, bits >>= 4) token += kDigits[bits & 15];
  return token;
}

// Takes the same time wherever texts differ.
bool equal(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differing |= static_cast<unsigned char>(a[i] ^ b[i]);
  return differing == 0;
}

const char* mimeOf(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  return "text/javascript; charset=utf-8";
}

// Whether a Host is a name that every machine has for itself, with a port or without. A tunnel (ssh -L) ends at any
// port of such a name; nobody can turn the name itself to another address.
bool isLoopback(std::string_view host) {
  for (const std::string_view name : {"localhost", "127.0.0.1", "[::1]"}) {
    if (!host.starts_with(name)) continue;
    const std::string_view port = host.substr(name.size());
    const bool digits =
        std::all_of(port.begin() + !port.empty(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (port.empty() || (port.front() == ':' && port.size() > 1 && port.size() <= 6 && digits)) return true;
  }
  return false;
}

// A page that is connected. All but text() and frame() is of the thread that serves.
class Page final : public ViewClient, public std::enable_shared_from_this<Page> {
 public:
  Page(beast::tcp_stream stream, Viewer& viewer) : socket_(std::move(stream)), viewer_(viewer) {}

  void text(const std::string& message) override {
    asio::post(socket_.get_executor(), [self = shared_from_this(), message] {
      self->texts_.push_back(message);
      self->write();
    });
  }
  void frame(const std::shared_ptr<const ViewFrame>& frame) override {
    asio::post(socket_.get_executor(), [self = shared_from_this(), frame] {
      self->frame_ = frame;
      self->write();
    });
  }

  asio::awaitable<void> serve(Request request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(kMostMessageBytes);
    socket_.auto_fragment(false);
    co_await socket_.async_accept(request, asio::use_awaitable);
    open_ = true;
    viewer_.join(shared_from_this());
    const auto left = [this](void*) { viewer_.leave(*this); };
    const std::unique_ptr<void, decltype(left)> leaving(this, left);
    for (;;) {
      beast::flat_buffer buffer;
      co_await socket_.async_read(buffer, asio::use_awaitable);
      take(beast::buffers_to_string(buffer.data()));
    }
  }

 private:
  void take(const std::string& message) {
    // What is on the screen concerns nobody but this page.
    try {
      const auto json = parseMessage(message);
      if (json["type"] == "shown") {
        waiting_ = false;
        write();
        return;
      }
    } catch (const Error&) {
      // The viewer says what is wrong.
    }
    viewer_.message(message, shared_from_this());
  }

  void write() {
    if (!open_ || writing_) return;
    if (texts_.size() > kMostTexts) {
      open_ = false;
      beast::get_lowest_layer(socket_).cancel();
      return;
    }
    writing_ = true;
    asio::co_spawn(
        socket_.get_executor(), [self = shared_from_this()]() -> asio::awaitable<void> { return self->writeAll(); },
        asio::detached);
  }

  // Texts go first. A frame is sent once the one before is on the screen: until then a newer one takes its place.
  asio::awaitable<void> writeAll() {
    const auto self = shared_from_this();
    try {
      for (;;) {
        if (!texts_.empty()) {
          const std::string message = std::move(texts_.front());
          texts_.pop_front();
          socket_.text(true);
          co_await socket_.async_write(asio::buffer(message), asio::use_awaitable);
        } else if (frame_ && !waiting_) {
          const std::shared_ptr<const ViewFrame> frame = std::move(frame_);
          frame_ = nullptr;
          waiting_ = true;
          const std::string head = headOf(*frame);
          const std::array<asio::const_buffer, 2> parts{asio::buffer(head), asio::buffer(frame->bytes)};
          socket_.binary(true);
          co_await socket_.async_write(parts, asio::use_awaitable);
        } else {
          break;
        }
      }
    } catch (const std::exception&) {
      open_ = false;  // the reader finds out, too, and leaves
    }
    writing_ = false;
  }

  std::string headOf(const ViewFrame& frame) {
    nlohmann::ordered_json about{{"frame", ++frames_}, {"width", frame.width}, {"height", frame.height},
                                 {"mime", frame.mime}, {"draft", frame.draft}, {"samples", frame.samples}};
    if (frame.number) about["number"] = *frame.number;
    const std::string json = about.dump();
    std::string head;
    for (int byte = 0; byte < 4; ++byte) head += static_cast<char>((json.size() >> (8 * byte)) & 0xff);
    return head + json;
  }

  websocket::stream<beast::tcp_stream> socket_;
  Viewer& viewer_;
  std::deque<std::string> texts_;
  std::shared_ptr<const ViewFrame> frame_;
  int frames_ = 0;
  bool open_ = false, writing_ = false, waiting_ = false;
};

}  // namespace

class ViewServer::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(Viewer& viewer, const ServerOptions& options)
      : viewer_(viewer), token_(options.token.empty() ? randomToken() : options.token), acceptor_(io_) {
    boost::system::error_code failed;
    const auto address = asio::ip::make_address(options.host, failed);
    if (failed) throw InvalidArgument("host: '" + options.host + "' is no address, such as 127.0.0.1");
    const tcp::endpoint endpoint(address, options.port);
    acceptor_.open(endpoint.protocol(), failed);
    if (!failed) acceptor_.set_option(asio::socket_base::reuse_address(true), failed);
    if (!failed) acceptor_.bind(endpoint, failed);
    if (!failed) acceptor_.listen(asio::socket_base::max_listen_connections, failed);
    if (failed) throw IoError("port " + std::to_string(options.port) + " of " + options.host + ": " + failed.message());
    host_ = address.is_v6() ? "[" + options.host + "]" : options.host;
    everywhere_ = !address.is_loopback();
  }

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  std::string address() const { return "http://" + host_ + ":" + std::to_string(port()) + "/" + token_ + "/"; }

  void run(const std::function<bool()>& stop) {
    asio::co_spawn(
        io_, [this] { return listen(); }, asio::detached);
    while (!stop()) io_.run_for(std::chrono::milliseconds(100));
  }

 private:
  asio::awaitable<void> listen() {
    for (;;) {
      boost::system::error_code failed;
      tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(asio::use_awaitable, failed));
      if (failed) {
        // Too many files are open, for example: others close theirs.
        asio::steady_timer timer(io_, std::chrono::milliseconds(200));
        co_await timer.async_wait(asio::use_awaitable);
        continue;
      }
      if (connections_ >= kMostConnections) continue;  // closes it
      asio::co_spawn(
          io_, [this, stream = beast::tcp_stream(std::move(socket))]() mutable { return serve(std::move(stream)); },
          asio::detached);
    }
  }

  // Serves one connection. What goes wrong with it is its own matter.
  asio::awaitable<void> serve(beast::tcp_stream stream) {
    ++connections_;
    try {
      beast::flat_buffer buffer;
      for (bool more = true; more;) {
        http::request_parser<http::empty_body> parser;
        // The size of a body is looked at below, before any of it is read. Boost 1.74 takes no limit for a limit of 0.
        parser.body_limit(std::numeric_limits<std::uint64_t>::max());
        stream.expires_after(kPatience);
        co_await http::async_read_header(stream, buffer, parser, asio::use_awaitable);
        if (isUpload(parser.get())) {
          Response response = co_await takeUpload(stream, buffer, parser);
          stream.expires_after(kPatience);
          co_await http::async_write(stream, response, asio::use_awaitable);
          co_await drain(stream);
          break;
        }
        if (!parser.is_done()) break;  // nothing else has a body
        Request request = parser.release();
        if (websocket::is_upgrade(request) && mayConnect(request) && pages_ < kMostPages) {
          stream.expires_never();
          const auto page = std::make_shared<Page>(std::move(stream), viewer_);
          ++pages_;
          try {
            co_await page->serve(std::move(request));
          } catch (const std::exception&) {
            // The page has gone.
          }
          --pages_;
          break;
        }
        Response response = answer(request);
        more = response.keep_alive();
        co_await http::async_write(stream, response, asio::use_awaitable);
      }
    } catch (const std::exception&) {
      // It has closed, or took too long, or sent what is no HTTP.
    }
    --connections_;
  }

  // Names that turn into this machine are no names of it. Where the port is open to others, they know it by names that
  // nobody can list.
  bool isOurName(std::string_view host) const {
    if (everywhere_) return true;
    const std::string ending = ":" + std::to_string(port());
    for (const std::string& name : {host_, std::string("localhost"), std::string("127.0.0.1"), std::string("[::1]")})
      if (host == name + ending) return true;
    return isLoopback(host);
  }

  // Returns what follows the token in a path; nothing where that is not ours.
  std::optional<std::string> nameOf(const Request& request) const {
    std::string_view target(request.target().data(), request.target().size());
    target = target.substr(0, target.find('?'));
    if (target.size() < token_.size() + 2 || target.front() != '/' || target[token_.size() + 1] != '/' ||
        !equal(target.substr(1, token_.size()), token_))
      return std::nullopt;
    return std::string(target.substr(token_.size() + 2));
  }

  static std::string_view headerOf(const Request& request, http::field field) {
    const auto value = request[field];
    return {value.data(), value.size()};
  }

  bool mayConnect(const Request& request) const {
    const std::string_view host = headerOf(request, http::field::host);
    return nameOf(request) == "socket" && isOurName(host) &&
           headerOf(request, http::field::origin) == "http://" + std::string(host);
  }

  // --- files that pages send ---

  bool isUpload(const Request& request) const {
    const std::optional<std::string> name = nameOf(request);
    return request.method() == http::verb::post && name && name->starts_with(kUpload) && viewer_.opensFiles();
  }

  // Takes a file to a temporary place, piece by piece, and lets the viewer open it. One at a time: so there is never
  // more than one of kMostUploadBytes on the disk.
  asio::awaitable<Response> takeUpload(beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                       http::request_parser<http::empty_body>& head) {
    const auto answered = [version = head.get().version()](http::status status, const std::string& why) {
      Response response = plainResponse(status, version);
      response.set(http::field::content_type, "text/plain; charset=utf-8");
      response.keep_alive(false);
      response.body() = why;
      response.prepare_payload();
      return response;
    };
    const std::string name = nameOf(head.get())->substr(kUpload.size());
    const std::string_view host = headerOf(head.get(), http::field::host);
    if (!isOurName(host) || headerOf(head.get(), http::field::origin) != "http://" + std::string(host))
      co_return answered(http::status::forbidden, "not a page of this server");
    const auto length = head.content_length();
    if (!length) co_return answered(http::status::length_required, "its length is not stated");
    if (*length > kMostUploadBytes)
      co_return answered(http::status::payload_too_large, "larger than a page may send: open it by its path");
    if (uploading_) co_return answered(http::status::conflict, "another file is on its way");
    uploading_ = true;
    const auto end = [this](void*) { uploading_ = false; };
    const std::unique_ptr<void, decltype(end)> ending(this, end);
    try {
      auto file = std::make_shared<UploadedFile>(name);
      http::request_parser<http::file_body> parser(std::move(head));
      parser.body_limit(kMostUploadBytes);
      beast::error_code failed;
      parser.get().body().open(file->path().c_str(), beast::file_mode::write_new, failed);
      if (failed) co_return answered(http::status::insufficient_storage, failed.message());
      const auto until = std::chrono::steady_clock::now() + kLongestUpload;
      while (!parser.is_done()) {
        if (std::chrono::steady_clock::now() > until) co_return answered(http::status::request_timeout, "too slow");
        stream.expires_after(kPatience);
        co_await http::async_read_some(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, failed));
        // A disk that is full, for example, or a page that has gone.
        if (failed) co_return answered(http::status::insufficient_storage, failed.message());
      }
      parser.get().body().close();
      viewer_.upload(std::move(file));
      co_return answered(http::status::ok, "opening " + name);
    } catch (const Error& error) {
      co_return answered(http::status::bad_request, error.what());
    }
  }

  // Reads what is still on its way, for a little while: a connection that is closed before is reset, and the answer
  // may be lost.
  static asio::awaitable<void> drain(beast::tcp_stream& stream) {
    boost::system::error_code ended;
    stream.socket().shutdown(tcp::socket::shutdown_send, ended);
    stream.expires_after(std::chrono::seconds(2));
    std::array<char, 4096> rest{};
    while (!ended)
      co_await stream.async_read_some(asio::buffer(rest), asio::redirect_error(asio::use_awaitable, ended));
  }

  static Response plainResponse(http::status status, unsigned version) {
    Response response{status, version};
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    return response;
  }

  Response answer(const Request& request) const {
    Response response = plainResponse(http::status::ok, request.version());
    response.keep_alive(request.keep_alive());
    response.set("Content-Security-Policy",
                 "default-src 'self'; img-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; connect-src 'self' "
                 "ws:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    const auto refuse = [&](http::status status, const char* why) {
      response.result(status);
      response.set(http::field::content_type, "text/plain");
      response.body() = why;
    };
    const std::optional<std::string> name = nameOf(request);
    if (!name || !isOurName(headerOf(request, http::field::host))) {
      refuse(http::status::forbidden, "umbrick view: this address has no token\n");
    } else if (request.method() != http::verb::get && request.method() != http::verb::head) {
      refuse(http::status::method_not_allowed, "umbrick view: GET alone\n");
    } else if (*name == "socket") {
      refuse(http::status::forbidden, "umbrick view: for its own pages, eight at most\n");
    } else {
      const std::string file = name->empty() ? "index.html" : *name;
      const std::string_view text = pageFile(file);
      if (text.empty()) {
        refuse(http::status::not_found, "umbrick view: no such file\n");
      } else {
        response.set(http::field::content_type, mimeOf(file));
        if (request.method() == http::verb::get) response.body() = text;
      }
    }
    response.prepare_payload();
    return response;
  }

  Viewer& viewer_;
  std::string token_, host_;
  bool everywhere_ = false;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  int connections_ = 0, pages_ = 0;
  bool uploading_ = false;
};

ViewServer::ViewServer(Viewer& viewer, const ServerOptions& options)
    : implementation_(std::make_shared<Implementation>(viewer, options)) {}

ViewServer::~ViewServer() = default;

std::uint16_t ViewServer::port() const { return implementation_->port(); }

std::string ViewServer::address() const { return implementation_->address(); }

void ViewServer::run(const std::function<bool()>& stop) { implementation_->run(stop); }

}  // namespace umbrick::view
