/// Which requests the web server answers.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "server/listen_address.hpp"

namespace edsc {

/// The parts of a request that decide. Empty: missing.
struct WebRequest {
  std::string method;
  std::string host;    ///< Host
  std::string origin;  ///< Origin
  std::string range;   ///< Range
  std::string token;   ///< of the URL
};

/// 256 random bits in hexadecimal.
[[nodiscard]] std::string random_token();

/// Lets pass what the page of this server sends, and whoever opens its URL.
class RequestGuard {
 public:
  /// `address` is the one listened at, with its port.
  RequestGuard(ListenAddress address, std::string token) : address_{std::move(address)}, token_{std::move(token)} {}

  /// The HTTP status for a request: 200, or that of its refusal.
  [[nodiscard]] int check(const WebRequest& request) const;

  /// The same without the token and the method, for a server that has other ones.
  [[nodiscard]] int check_origin(const WebRequest& request) const;

  [[nodiscard]] std::string url() const { return url_with(token_); }
  [[nodiscard]] std::string url_with(const std::string& token) const {
    return "http://" + to_text(address_) + "/?token=" + token;
  }

  /// Compares in a time that does not depend on how much of a token is right.
  [[nodiscard]] static bool is_same_token(std::string_view one, std::string_view other);

  /// Whether only programs on this computer can connect.
  [[nodiscard]] static bool is_loopback(const std::string& host);

 private:
  [[nodiscard]] bool is_own_host(std::string_view host) const;

  ListenAddress address_;
  std::string token_;
};

}  // namespace edsc
