#include "server/listen_address.hpp"

#include <charconv>
#include <stdexcept>

namespace edsc {

ListenAddress parse_listen_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  ListenAddress address;
  bool good = colon != std::string::npos;
  if (good) {
    address.host = text.substr(0, colon);
    if (address.host.size() > 1 && address.host.front() == '[' && address.host.back() == ']')
      address.host = address.host.substr(1, address.host.size() - 2);
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, address.port);
    good = error == std::errc{} && stop == end && !address.host.empty();
  }
  if (!good)
    throw std::invalid_argument{"\"" + text +
                                "\" is not a listen address; expected HOST:PORT, such as 127.0.0.1:29536"};
  return address;
}

std::string to_text(const ListenAddress& address) {
  const bool ipv6 = address.host.find(':') != std::string::npos;
  return (ipv6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace edsc
