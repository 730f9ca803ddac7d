/// Port for an SLCAN adapter on a serial line of a host, or a pseudo-terminal.
///
///     canopen::SlcanPort bus{"/dev/ttyACM0", {.bit_rate = 500'000}};
#pragma once

#include <fcntl.h>
#include <termios.h>

#include <cerrno>
#include <cstdint>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "canopen/host/slcan_host.hpp"
#include "canopen/host/stream_port.hpp"
#include "canopen/port/slcan_codec.hpp"

namespace canopen {

struct SlcanOptions {
  std::uint32_t bit_rate = 0;  ///< of the CAN bus in bit/s, one of slcan::bit_rates; 0: set in the adapter
  std::uint32_t baud = 0;      ///< of the serial line in bit/s; 0: unchanged, which USB adapters ignore
};

class SlcanPort : public StreamPort<SlcanHost> {
 public:
  /// Opens the line and the adapter's channel, which the destructor closes. Throws std::system_error if the line cannot
  /// be opened or the adapter rejects a command, and std::invalid_argument if a rate is not supported.
  explicit SlcanPort(const std::string& device, SlcanOptions options = {})
      : StreamPort{open_line(device, options.baud), device} {
    const std::optional<std::uint8_t> code = slcan::bit_rate_code(options.bit_rate);
    if (options.bit_rate != 0 && !code) {
      throw std::invalid_argument{"SLCAN has no bit rate of " + std::to_string(options.bit_rate) + " bit/s"};
    }
    protocol_.start(code, now());
    connect(std::chrono::seconds{3});
  }

 private:
  struct LineRate {
    std::uint32_t baud;
    speed_t code;
  };
  static constexpr LineRate line_rates[] = {
      {9'600, B9600},     {19'200, B19200},      {38'400, B38400},      {57'600, B57600},
      {115'200, B115200}, {230'400, B230400},    {460'800, B460800},    {500'000, B500000},
      {921'600, B921600}, {1'000'000, B1000000}, {2'000'000, B2000000}, {3'000'000, B3000000},
  };

  [[nodiscard]] static Descriptor open_line(const std::string& device, std::uint32_t baud) {
    Descriptor line = opened(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), device);
    termios settings{};
    if (::tcgetattr(line.number(), &settings) != 0) throw_errno(device);
    ::cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    if (baud != 0) ::cfsetspeed(&settings, line_rate(baud));
    if (::tcsetattr(line.number(), TCSANOW, &settings) != 0) throw_errno(device);
    // Input only: the adapter may not have received the last frames of an earlier port yet.
    static_cast<void>(::tcflush(line.number(), TCIFLUSH));
    return line;
  }

  [[nodiscard]] static speed_t line_rate(std::uint32_t baud) {
    for (const LineRate& rate : line_rates) {
      if (rate.baud == baud) return rate.code;
    }
    throw std::invalid_argument{"a serial line has no rate of " + std::to_string(baud) + " bit/s"};
  }
};

}  // namespace canopen
