#include "online/live_bus.hpp"

#include <fmt/format.h>

#include <canopen/host/host_bus.hpp>
#include <system_error>

#include "online/simulated_port.hpp"

namespace edsc {
namespace {

using canopen::Duration;
using canopen::Frame;
using canopen::TimePoint;

constexpr Duration longest_refusal = canopen::from_milliseconds(2000);
constexpr Duration try_again = canopen::from_milliseconds(1);

class HostPort final : public BusPort {
 public:
  explicit HostPort(const std::string& address) : bus_{address} {}

  bool send(const Frame& frame) override { return bus_.send(frame); }
  std::optional<Frame> receive(Duration timeout) override { return bus_.receive(timeout); }
  TimePoint now() const override { return canopen::HostBus::now(); }
  TimePoint received_at() const override { return bus_.received_at(); }

 private:
  canopen::HostBus bus_;
};

std::unique_ptr<BusPort> open_port(const std::string& address) {
  if (SimulatedPort::is_address(address)) return std::make_unique<SimulatedPort>(address);
  return std::make_unique<HostPort>(address);
}

}  // namespace

LiveBus::LiveBus(const std::string& address) : port_{open_port(address)} {}

bool LiveBus::send(const Frame& frame) {
  try {
    if (port_->send(frame)) {
      refused_since_.reset();
      if (on_sent) on_sent(frame, now());
      return true;
    }
  } catch (const std::system_error& problem) {
    throw BusLost{problem.what()};
  }
  if (!refused_since_) refused_since_ = now();
  return false;
}

void LiveBus::send_all(const Frame& frame) {
  while (!send(frame)) {
    (void)receive(try_again);
    if (Interruption::noted()) throw Interrupted{};
  }
}

std::optional<Frame> LiveBus::receive(Duration timeout) {
  const TimePoint end = now() + std::min(timeout, canopen::longest_span);
  const Duration longest_at_once = port_->longest_at_once();
  for (;;) {
    if (refused_since_ && now() - *refused_since_ > longest_refusal) {
      throw BusLost{"it does not accept frames: no node acknowledges them, or the controller is off"};
    }
    const TimePoint present = now();
    const Duration left = end > present ? end - present : Duration{0};
    std::optional<Frame> frame;
    try {
      frame = port_->receive(std::min(left, longest_at_once));
    } catch (const std::system_error& problem) {
      throw BusLost{problem.what()};
    }
    if (frame) {
      if (on_frame) on_frame(*frame, now());
      return frame;
    }
    if (left <= longest_at_once || Interruption::noted()) return std::nullopt;
  }
}

void LiveBus::listen(Duration span) {
  const TimePoint end = now() + span;
  for (TimePoint present = now(); present < end; present = now()) {
    (void)receive(end - present);
    if (Interruption::noted()) throw Interrupted{};
  }
}

}  // namespace edsc
