#include "network/error_control.hpp"

#include "network/communication_objects.hpp"
#include "network/network.hpp"

namespace edsc {

std::uint64_t heartbeat_time(const Device& device) {
  return value_of(device, communication::producer_heartbeat).value_or(0);
}

std::optional<NodeGuarding> node_guarding(const Device& device) {
  const auto time = static_cast<std::uint16_t>(value_of(device, communication::guard_time).value_or(0));
  const auto factor = static_cast<std::uint8_t>(value_of(device, communication::life_time_factor).value_or(0));
  if (time == 0 || factor == 0) return std::nullopt;
  return NodeGuarding{time, factor};
}

std::uint32_t slave_assignment(const Device& slave) {
  constexpr std::uint32_t is_slave = 0x1;
  constexpr std::uint32_t is_booted = 0x4;
  const auto guarding = node_guarding(slave);
  if (!guarding || heartbeat_time(slave) != 0) return is_slave | is_booted;
  return is_slave | is_booted | std::uint32_t{guarding->life_time_factor} << 8 |
         std::uint32_t{guarding->guard_time} << 16;
}

}  // namespace edsc
