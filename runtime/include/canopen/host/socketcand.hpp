/// A CAN bus of a socketcand server, over TCP.
///
///     canopen::SocketcandPort bus{"192.168.0.7", "29536", "can0"};
#pragma once

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "canopen/host/socketcand_codec.hpp"
#include "canopen/host/stream_port.hpp"

namespace canopen {

class SocketcandPort : public StreamPort<SocketcandClient> {
 public:
  /// Connects, and opens a bus of the server in raw mode. A connection that is refused is tried again for a second,
  /// since the server may be starting. Throws std::system_error if the server does not respond or rejects the
  /// connection, and std::invalid_argument if the name of the bus does not have 1 to 16 characters.
  SocketcandPort(const std::string& host, const std::string& port, const std::string& bus)
      : StreamPort{connect_to(host, port), "socketcand at " + host + ":" + port} {
    const bool plain = bus.find_first_of(" <>") == std::string::npos;
    if (bus.empty() || bus.size() > SocketcandClient::longest_name || !plain) {
      throw std::invalid_argument{"\"" + bus + "\" is not a bus name: 1 to 16 characters"};
    }
    protocol_.start(bus, now());
    connect(connect_timeout);
  }

 private:
  static constexpr Duration connect_timeout = std::chrono::seconds{5};
  static constexpr Duration start_of_server = std::chrono::seconds{1};
  static constexpr int retry_ms = 20;

  struct FreeAddresses {
    void operator()(addrinfo* addresses) const { ::freeaddrinfo(addresses); }
  };

  [[nodiscard]] static Descriptor connect_to(const std::string& host, const std::string& port) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string name = host + ":" + port;
    if (const int error = ::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found); error != 0) {
      throw std::system_error{std::make_error_code(std::errc::host_unreachable), name + ": " + ::gai_strerror(error)};
    }
    const std::unique_ptr<addrinfo, FreeAddresses> addresses{found};
    const TimePoint end = now() + start_of_server;
    for (;;) {
      int problem = EHOSTUNREACH;
      for (const addrinfo* address = found; address != nullptr; address = address->ai_next) {
        Descriptor stream =
            opened(::socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0), "socket");
        problem = try_address(stream, *address);
        if (problem == 0) return stream;
      }
      if (problem != ECONNREFUSED || now() >= end) throw std::system_error{problem, std::generic_category(), name};
      static_cast<void>(::poll(nullptr, 0, retry_ms));
    }
  }

  /// Returns 0 if connected, otherwise an errno.
  [[nodiscard]] static int try_address(const Descriptor& stream, const addrinfo& address) {
    if (::connect(stream.number(), address.ai_addr, address.ai_addrlen) != 0) {
      if (errno != EINPROGRESS) return errno;
      pollfd waiting{stream.number(), POLLOUT, 0};
      const timespec span = to_timespec(connect_timeout);
      const int ready = ::ppoll(&waiting, 1, &span, nullptr);
      if (ready <= 0) return ready == 0 ? ETIMEDOUT : errno;
      int error = 0;
      socklen_t size = sizeof error;
      if (::getsockopt(stream.number(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) return errno;
      if (error != 0) return error;
    }
    const int on = 1;
    static_cast<void>(::setsockopt(stream.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on));
    return 0;
  }
};

}  // namespace canopen
