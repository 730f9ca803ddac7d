/// An HTTP server for one page and its stream of events.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "server/listen_address.hpp"
#include "web/live_rows.hpp"

namespace edsc {

struct CannotListen : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Serves, in threads of its own, `/`, the page, and `/events`, the changes of the rows as server-sent events, to
/// clients that know the token. It reads at most 16 kB of a request within five seconds, and has up to 16 streams at a
/// time.
class WebServer {
 public:
  static constexpr unsigned max_streams = 16;

  /// `page` must have the placeholder `{{{nonce}}}` for each inline script and style. `rows` must outlive the server.
  /// Throws CannotListen.
  WebServer(const ListenAddress& address, std::string page, LiveRows& rows);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// The URL of the page, with the token.
  [[nodiscard]] std::string url() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace edsc
