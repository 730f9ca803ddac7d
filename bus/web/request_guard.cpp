#include "web/request_guard.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <nettle/memops.h>

#include <algorithm>
#include <cstdint>
#include <random>

#include "text/ascii.hpp"
#include "web/http_status.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t default_port = 80;
using namespace http_status;

std::string lower(std::string_view text) {
  std::string out{text};
  std::ranges::transform(out, out.begin(), to_lower);
  return out;
}

bool is_address(int family, const std::string& host) {
  if (host.find('\0') != std::string::npos) return false;  // inet_pton reads up to it
  in6_addr buffer;
  return inet_pton(family, host.c_str(), &buffer) == 1;
}

bool is_ip_address(const std::string& host) { return is_address(AF_INET, host) || is_address(AF_INET6, host); }

}  // namespace

std::string random_token() {
  std::random_device source;  // the generator of the operating system
  std::string token;
  for (int i = 0; i < 8; ++i) token += fmt::format("{:08x}", std::uint32_t{source()});
  return token;
}

int RequestGuard::check_origin(const WebRequest& request) const {
  if (!is_own_host(request.host)) return misdirected;
  return request.origin.empty() || request.origin == "http://" + request.host ? ok : forbidden;
}

int RequestGuard::check(const WebRequest& request) const {
  if (const int status = check_origin(request); status != ok) return status;
  if (!is_same_token(request.token, token_)) return forbidden;
  if (request.method != "GET") return method_not_allowed;
  return request.range.empty() ? ok : no_range;
}

bool RequestGuard::is_loopback(const std::string& host) {
  return lower(host) == "localhost" || host == "::1" || (host.starts_with("127.") && is_ip_address(host));
}

/// A page of another site whose name resolves to this server sends the name of that site (DNS rebinding). An address
/// is not a name, and localhost is always this computer.
bool RequestGuard::is_own_host(std::string_view host) const {
  const std::size_t end = host.find_last_of(":]");
  const bool has_port = end != std::string_view::npos && host[end] == ':';
  if (has_port ? host.substr(end + 1) != std::to_string(address_.port) : address_.port != default_port) return false;
  if (has_port) host = host.substr(0, end);
  const bool in_brackets = host.size() > 2 && host.starts_with('[') && host.ends_with(']');
  const std::string name = lower(in_brackets ? host.substr(1, host.size() - 2) : host);
  if (in_brackets && !is_address(AF_INET6, name)) return false;
  if (name == lower(address_.host) || is_loopback(name)) return true;
  return !is_loopback(address_.host) && is_ip_address(name);
}

bool RequestGuard::is_same_token(std::string_view one, std::string_view other) {
  return one.size() == other.size() && memeql_sec(one.data(), other.data(), one.size()) != 0;
}

}  // namespace edsc
