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

  [[nodiscard]] std::string url() const { return "http://" + to_text(address_) + "/?token=" + token_; }

  /// Whether only programs on this computer can connect.
  [[nodiscard]] static bool is_loopback(const std::string& host);

 private:
  [[nodiscard]] bool is_own_host(std::string_view host) const;
  [[nodiscard]] bool is_own_token(std::string_view token) const;

  ListenAddress address_;
  std::string token_;
};

}  // namespace edsc
