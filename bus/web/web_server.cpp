#include "web/web_server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "web/bounded_server.hpp"
#include "web/page_headers.hpp"
#include "web/request_guard.hpp"

namespace edsc {
namespace {

using std::chrono::milliseconds;

/// What a person reads who opens an incomplete URL. It has no information of the bus.
constexpr std::pair<int, const char*> refusals[] = {
    {403, "This URL does not have the token. Open the URL that edsc monitor prints.\n"},
    {421, "Unknown host name. Open the URL printed by edsc monitor.\n"},
};

}  // namespace

class WebServer::Implementation {
 public:
  Implementation(const ListenAddress& address, std::string page, LiveRows& rows)
      : page_{std::move(page)}, rows_{rows}, guard_{bind(address), random_token()} {
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      for (const auto& [name, value] : page_headers) response.set_header(name, value);
      const int status =
          guard_.check({request.method, request.get_header_value("Host"), request.get_header_value("Origin"),
                        request.get_header_value("Range"), request.get_param_value("token")});
      if (status == 200) return httplib::Server::HandlerResponse::Unhandled;
      response.status = status;
      for (const auto& [refused, text] : refusals) {
        if (refused == status) response.set_content(text, "text/plain; charset=utf-8");
      }
      return httplib::Server::HandlerResponse::Handled;
    });
    server_.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      const std::string nonce = random_token();
      response.set_header("Content-Security-Policy", page_policy(nonce));
      response.set_content(with_nonce(page_, nonce), "text/html; charset=utf-8");
    });
    server_.Get("/events", [this](const httplib::Request&, httplib::Response& response) { stream_to(response); });
    server_.set_threads(max_streams + other_threads);
    thread_ = std::thread{[this] {
      server_.listen_after_bind();
      has_ended_ = true;
    }};
    while (!server_.is_running() && !has_ended_) std::this_thread::yield();  // before that, stop() has no effect
  }

  ~Implementation() {
    rows_.end();
    server_.end_connections();
    server_.stop();
    thread_.join();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  [[nodiscard]] std::string url() const { return guard_.url(); }

 private:
  static constexpr unsigned other_threads = 16;

  ListenAddress bind(ListenAddress address) {
    // Not SO_REUSEPORT, which httplib sets: another program could listen at the same port.
    server_.set_socket_options([](socket_t socket) {
      constexpr int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    const bool is_any = address.port == 0;
    const int port = is_any                                             ? server_.bind_to_any_port(address.host)
                     : server_.bind_to_port(address.host, address.port) ? address.port
                                                                        : -1;
    if (port <= 0) throw CannotListen{"cannot listen at " + to_text(address)};
    server_.lengthen_queue();
    address.port = static_cast<std::uint16_t>(port);
    return address;
  }

  void stream_to(httplib::Response& response) {
    if (streams_.fetch_add(1) >= max_streams) {
      --streams_;
      response.status = 503;
      response.set_header("Retry-After", "5");
      return;
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, version = std::uint64_t{0}](std::size_t, httplib::DataSink& sink) mutable {
          const auto update = rows_.wait(version, milliseconds{1'000});
          if (rows_.has_ended()) return false;
          if (!update) return sink.write(":\n\n", 3);  // a comment: is the client still there?
          version = update->version;
          const std::string event = "data: " + update->json + "\n\n";
          return sink.write(event.data(), event.size());
        },
        [this](bool) { --streams_; });
  }

  std::string page_;
  LiveRows& rows_;
  BoundedServer server_;
  RequestGuard guard_;
  std::atomic<unsigned> streams_ = 0;
  std::atomic<bool> has_ended_ = false;
  std::thread thread_;
};

WebServer::WebServer(const ListenAddress& address, std::string page, LiveRows& rows)
    : implementation_{std::make_unique<Implementation>(address, std::move(page), rows)} {}

WebServer::~WebServer() = default;

std::string WebServer::url() const { return implementation_->url(); }

}  // namespace edsc
