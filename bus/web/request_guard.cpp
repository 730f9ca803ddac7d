#include "web/request_guard.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <nettle/memops.h>

#include <cstdint>
#include <random>

namespace edsc {
namespace {

constexpr int ok = 200, forbidden = 403, method_not_allowed = 405, misdirected = 421, no_range = 416;

bool is_ip_address(const std::string& host) {
  in6_addr buffer;
  return inet_pton(AF_INET, host.c_str(), &buffer) == 1 || inet_pton(AF_INET6, host.c_str(), &buffer) == 1;
}

}  // namespace

std::string random_token() {
  std::random_device source;  // the generator of the operating system
  std::string token;
  for (int i = 0; i < 8; ++i) token += fmt::format("{:08x}", std::uint32_t{source()});
  return token;
}

int RequestGuard::check(const WebRequest& request) const {
  if (!is_own_host(request.host)) return misdirected;
  if (!request.origin.empty() && request.origin != "http://" + request.host) return forbidden;
  if (!is_own_token(request.token)) return forbidden;
  if (request.method != "GET") return method_not_allowed;
  return request.range.empty() ? ok : no_range;
}

bool RequestGuard::is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || (host.starts_with("127.") && is_ip_address(host));
}

/// A page of another site whose name resolves to this server sends the name of that site (DNS rebinding). An address
/// is not a name.
bool RequestGuard::is_own_host(std::string_view host) const {
  const std::string port = ":" + std::to_string(address_.port);
  const bool is_default_port = address_.port == 80 && host.find_last_of(":]") == std::string_view::npos;
  if (!host.ends_with(port) && !is_default_port) return false;
  if (host.ends_with(port)) host.remove_suffix(port.size());
  if (host.size() > 2 && host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string name{host};
  if (name == address_.host) return true;
  return is_loopback(address_.host) ? is_loopback(name) : is_ip_address(name);
}

/// In a time that does not depend on how much of the token is right.
bool RequestGuard::is_own_token(std::string_view token) const {
  return token.size() == token_.size() && memeql_sec(token.data(), token_.data(), token_.size()) != 0;
}

}  // namespace edsc
