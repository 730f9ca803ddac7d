/// Where a server listens: HOST:PORT, with an IPv6 address in brackets.
#pragma once

#include <cstdint>
#include <string>

namespace edsc {

struct ListenAddress {
  std::string host = "127.0.0.1";
  std::uint16_t port = 29536;  ///< 0: the system picks one
};

/// Throws std::invalid_argument with a message for the user if the address is malformed.
[[nodiscard]] ListenAddress parse_listen_address(const std::string& text);

/// What is wrong with the text of an address; empty for a valid one.
[[nodiscard]] std::string listen_address_problem(const std::string& text);

/// HOST:PORT again.
[[nodiscard]] std::string to_text(const ListenAddress& address);

}  // namespace edsc
