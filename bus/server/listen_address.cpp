#include "server/listen_address.hpp"

#include <stdexcept>

#include "text/number_text.hpp"

namespace edsc {

ListenAddress parse_listen_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon != 0) {
    std::string host = text.substr(0, colon);
    if (host.size() > 1 && host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
    const auto port = parse_whole<std::uint16_t>(std::string_view{text}.substr(colon + 1));
    if (port && !host.empty()) return {std::move(host), *port};
  }
  throw std::invalid_argument{"\"" + text + "\" is not a listen address; expected HOST:PORT, such as 127.0.0.1:29536"};
}

std::string listen_address_problem(const std::string& text) {
  try {
    static_cast<void>(parse_listen_address(text));
    return {};
  } catch (const std::invalid_argument& problem) {
    return problem.what();
  }
}

std::string to_text(const ListenAddress& address) {
  const bool ipv6 = address.host.find(':') != std::string::npos;
  return (ipv6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace edsc
