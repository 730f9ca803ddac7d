#include "web/edit_server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "server/listen_address.hpp"
#include "web/bounded_server.hpp"
#include "web/http_status.hpp"
#include "web/page_headers.hpp"
#include "web/request_guard.hpp"

namespace edsc {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

using namespace http_status;

constexpr const char* session_header = "X-Edsc-Session";
constexpr std::size_t max_header_bytes = 16'384;

struct EditRoute {
  std::string_view method, path;
  bool needs_session = true;
  std::size_t max_bytes = EditServer::max_body_bytes;
};

constexpr EditRoute edit_routes[] = {
    {"GET", "/", false},  {"POST", "/session", false},
    {"GET", "/state"},    {"GET", "/section"},
    {"GET", "/diff"},     {"POST", "/change"},
    {"POST", "/undo"},    {"POST", "/redo"},
    {"POST", "/review"},  {"POST", "/save"},
    {"POST", "/resolve"}, {"POST", "/journal"},
    {"POST", "/close"},   {"POST", "/import", true, EditServer::max_import_bytes},
};

struct RefusalText {
  int status;
  std::string_view body;
};

/// What a person reads who opens a wrong URL, and what the page reads. They have no information of the file.
constexpr RefusalText refusal_texts[] = {
    {forbidden,
     R"({"error":"This page does not have a session. Open a URL that edsc edit prints; the key u prints a new one."})"},
    {not_found, R"({"error":"unknown request"})"},
    {method_not_allowed, R"({"error":"unknown method"})"},
    {length_required, R"({"error":"the length of the request is missing"})"},
    {too_large, R"({"error":"the request is too large"})"},
    {wrong_type, R"({"error":"the request is not JSON"})"},
    {421, R"({"error":"unknown host name"})"},
};

constexpr const char* json_type = "application/json; charset=utf-8";

std::optional<std::size_t> number_of(const std::string& text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional{number} : std::nullopt;
}

/// The value of a member that is a text; empty without one.
std::string text_member(const std::string& body, const char* name) {
  const nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
  const auto found = json.find(name);
  return json.is_object() && found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

/// The tokens that URLs have, and those of sessions.
class SessionTokens {
 public:
  std::string new_token() {
    const std::lock_guard lock{mutex_};
    return unused_.emplace_back(random_token());
  }

  /// The token of a new session, for a token of a URL; empty for any other text, or if it was used before.
  std::string exchange(std::string_view token) {
    const std::lock_guard lock{mutex_};
    const auto found = find(unused_, token);
    if (found == unused_.end()) return {};
    unused_.erase(found);
    return sessions_.emplace_back(random_token());
  }

  [[nodiscard]] bool has_session(std::string_view session) {
    const std::lock_guard lock{mutex_};
    return find(sessions_, session) != sessions_.end();
  }

 private:
  static std::vector<std::string>::iterator find(std::vector<std::string>& tokens, std::string_view token) {
    return std::ranges::find_if(tokens, [&](const auto& one) { return RequestGuard::is_same_token(one, token); });
  }

  std::mutex mutex_;
  std::vector<std::string> unused_, sessions_;
};

}  // namespace

class EditServer::Implementation {
 public:
  Implementation(std::uint16_t port, std::string page, EditHandlers handlers)
      : page_{std::move(page)}, handlers_{std::move(handlers)}, guard_{bind(port), random_token()} {
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      for (const auto& [name, value] : page_headers) response.set_header(name, value);
      const int status = check(request);
      if (status == ok) return httplib::Server::HandlerResponse::Unhandled;
      response.status = status;
      for (const RefusalText& row : refusal_texts) {
        if (row.status == status) response.set_content(std::string{row.body}, json_type);
      }
      return httplib::Server::HandlerResponse::Handled;
    });
    server_.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      const std::string nonce = random_token();
      response.set_header("Content-Security-Policy", page_policy(nonce));
      response.set_content(with_nonce(page_, nonce), "text/html; charset=utf-8");
    });
    server_.Post("/session", [this](const httplib::Request& request, httplib::Response& response) {
      const std::string session = tokens_.exchange(text_member(request.body, "token"));
      if (session.empty()) return answer(response, {forbidden, std::string{refusal_texts[0].body}});
      note_page();
      answer(response, {ok, R"({"session":")" + session + "\"}"});
    });
    server_.Get("/state", [this](const httplib::Request& request, httplib::Response& response) {
      const auto since = number_of(request.get_param_value("since"));
      if (!since) return answer(response, {bad_request, R"({"error":"since is a version"})"});
      answer(response, {ok, state(*since, request.get_param_value("wait") == "1")});
    });
    server_.Get("/section", [this](const httplib::Request& request, httplib::Response& response) {
      const std::lock_guard lock{mutex_};
      answer(response, handlers_.section(request.get_param_value("title")));
    });
    server_.Get("/diff", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock{mutex_};
      answer(response, {ok, handlers_.diff()});
    });
    server_.Post(R"(/([a-z]+))", [this](const httplib::Request& request, httplib::Response& response) {
      answer(response, post(request.path.substr(1), request.body));
    });
    server_.set_threads(threads);
    server_.set_payload_max_length(max_import_bytes);
    server_.set_max_request_bytes(max_import_bytes + max_header_bytes);
    thread_ = std::thread{[this] {
      server_.listen_after_bind();
      has_ended_ = true;
    }};
    while (!server_.is_running() && !has_ended_) std::this_thread::yield();  // before that, stop() has no effect
  }

  ~Implementation() {
    {
      const std::lock_guard lock{mutex_};
      is_ending_ = true;
    }
    changed_.notify_all();
    server_.end_connections();
    server_.stop();
    thread_.join();
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  [[nodiscard]] std::string new_url() { return guard_.url_with(tokens_.new_token()); }

  [[nodiscard]] bool has_unsaved_edits() {
    const std::lock_guard lock{mutex_};
    return handlers_.has_unsaved_edits();
  }

  [[nodiscard]] std::optional<milliseconds> time_without_page() {
    const std::lock_guard lock{pages_};
    if (!last_page_ || waiting_ > 0) return std::nullopt;
    return std::chrono::duration_cast<milliseconds>(steady_clock::now() - *last_page_);
  }

 private:
  static constexpr std::size_t threads = 32;
  static constexpr milliseconds longest_wait{5'000};
  static constexpr milliseconds between_looks{500};

  ListenAddress bind(std::uint16_t port) {
    // Not SO_REUSEPORT, which httplib sets: another program could listen at the same port.
    server_.set_socket_options([](socket_t socket) {
      constexpr int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    ListenAddress address;
    address.port = port;
    const int bound = port == 0                                  ? server_.bind_to_any_port(address.host)
                      : server_.bind_to_port(address.host, port) ? port
                                                                 : -1;
    if (bound <= 0) throw CannotListen{"cannot listen at " + to_text(address)};
    server_.lengthen_queue();
    address.port = static_cast<std::uint16_t>(bound);
    return address;
  }

  /// Before the body is read.
  [[nodiscard]] int check(const httplib::Request& request) {
    const std::string origin = request.get_header_value("Origin");
    if (const int status = guard_.check_origin({request.method, request.get_header_value("Host"), origin, {}, {}});
        status != ok) {
      return status;
    }
    const auto* const route = std::ranges::find_if(
        edit_routes, [&](const EditRoute& row) { return row.path == request.path && row.method == request.method; });
    if (route == std::end(edit_routes)) {
      const bool is_path = std::ranges::find(edit_routes, request.path, &EditRoute::path) != std::end(edit_routes);
      return is_path || (request.method != "GET" && request.method != "POST") ? method_not_allowed : not_found;
    }
    if (request.has_header("Range")) return no_range;
    if (route->method == "POST") {
      if (origin.empty()) return forbidden;
      const std::string type = request.get_header_value("Content-Type");
      if (type.substr(0, type.find(';')) != "application/json") return wrong_type;
      const auto length = number_of(request.get_header_value("Content-Length"));
      if (!length || request.has_header("Transfer-Encoding")) return length_required;
      if (*length > route->max_bytes) return too_large;
    }
    if (route->needs_session && !tokens_.has_session(request.get_header_value(session_header))) return forbidden;
    return ok;
  }

  static void answer(httplib::Response& response, const JsonAnswer& json) {
    response.status = json.status;
    response.set_content(json.body, json_type);
  }

  void note_page() {
    const std::lock_guard lock{pages_};
    last_page_ = steady_clock::now();
  }

  JsonAnswer post(const std::string& action, const std::string& body) {
    note_page();
    if (action == "close") {
      {
        const std::lock_guard lock{mutex_};
        ++closed_;
      }
      changed_.notify_all();  // the other pages ask again
      return {ok, "{}"};
    }
    JsonAnswer result;
    {
      const std::lock_guard lock{mutex_};
      result = handlers_.post(action, body);
    }
    changed_.notify_all();
    return result;
  }

  std::string state(std::uint64_t since, bool waits) {
    {
      const std::lock_guard lock{pages_};
      ++waiting_;
    }
    const auto end = steady_clock::now() + (waits ? longest_wait : milliseconds{0});
    std::string update;
    {
      std::unique_lock lock{mutex_};
      const std::uint64_t closed = closed_;
      while (!is_ending_ && closed_ == closed && handlers_.version() == since && !handlers_.look_for_changes() &&
             steady_clock::now() < end) {
        changed_.wait_for(lock, between_looks);
      }
      update = handlers_.update(since);
    }
    const std::lock_guard lock{pages_};
    --waiting_;
    last_page_ = steady_clock::now();
    return update;
  }

  std::string page_;
  EditHandlers handlers_;
  BoundedServer server_;
  RequestGuard guard_;
  SessionTokens tokens_;
  std::mutex mutex_;  ///< of the handlers
  std::condition_variable changed_;
  std::uint64_t closed_ = 0;
  bool is_ending_ = false;
  std::mutex pages_;
  unsigned waiting_ = 0;
  std::optional<steady_clock::time_point> last_page_;
  std::atomic<bool> has_ended_ = false;
  std::thread thread_;
};

EditServer::EditServer(std::uint16_t port, std::string page, EditHandlers handlers)
    : implementation_{std::make_unique<Implementation>(port, std::move(page), std::move(handlers))} {}

EditServer::~EditServer() = default;

std::string EditServer::new_url() { return implementation_->new_url(); }

bool EditServer::has_unsaved_edits() { return implementation_->has_unsaved_edits(); }

std::optional<milliseconds> EditServer::time_without_page() { return implementation_->time_without_page(); }

}  // namespace edsc
