/// The guard of the web server: whatever a request has, it passes only with the token, by GET, and with a host that is
/// the server or an IP address.
#include <array>
#include <charconv>
#include <stdexcept>

#include "fuzz.hpp"
#include "server/listen_address.hpp"
#include "web/request_guard.hpp"

namespace edsc::fuzz {
namespace {

constexpr const char* token = "0123456789abcdef";

/// The input in lines: address of the server, method, host, origin, range, token.
std::array<std::string, 6> lines_of(const std::string& input) {
  std::array<std::string, 6> lines;
  std::size_t begin = 0;
  for (std::string& line : lines) {
    const std::size_t end = std::min(input.find('\n', begin), input.size());
    line = input.substr(begin, end - begin);
    begin = std::min(end + 1, input.size());
  }
  return lines;
}

/// Letters are what a name needs that another site could own; an IPv6 address has only a to f.
bool is_foreign_name(const std::string& host, const ListenAddress& address) {
  const auto is_letter = [](char c) { return (c >= 'g' && c <= 'z') || (c >= 'G' && c <= 'Z'); };
  std::string name = host.substr(0, host.find_last_of(':'));
  const auto same = [](char a, char b) { return (a | 0x20) == (b | 0x20); };
  const auto equals = [&](const std::string& other) {
    return name.size() == other.size() && std::equal(name.begin(), name.end(), other.begin(), same);
  };
  if (equals("localhost") || equals(address.host) || equals("[" + address.host + "]")) return false;
  name = host;
  if (equals("localhost") || equals(address.host) || equals("[" + address.host + "]")) return false;
  return std::any_of(host.begin(), host.end(), is_letter);
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  const auto [server, method, host, origin, range, token] = fuzz::lines_of(fuzz::text_of(data, size));
  ListenAddress address{"127.0.0.1", 8080};
  try {
    if (!server.empty()) address = parse_listen_address(server);
  } catch (const std::invalid_argument&) {
  }
  const RequestGuard guard{address, fuzz::token};
  const int status = guard.check({method, host, origin, range, token});
  fuzz::require(status == 200 || status == 403 || status == 405 || status == 416 || status == 421, "a known status");
  if (status != 200) return 0;
  fuzz::require(token == fuzz::token, "only with the token");
  fuzz::require(method == "GET" && range.empty(), "only GET of the whole");
  fuzz::require(origin.empty() || origin == "http://" + host, "only from its own page");
  fuzz::require(!fuzz::is_foreign_name(host, address), "no name of another site");
  return 0;
}
