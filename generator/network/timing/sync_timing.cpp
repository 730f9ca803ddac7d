#include "network/timing/sync_timing.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "network/communication_objects.hpp"

namespace edsc {
namespace {

Nanoseconds microseconds_of(const CobIdUse& use, std::uint16_t index) {
  return std::chrono::microseconds{static_cast<std::int64_t>(value_of(use.node->device(), index).value_or(0))};
}

}  // namespace

std::optional<SyncTiming> sync_timing(const std::vector<CobIdUse>& uses, const NetworkTiming& timing) {
  const CobIdUse* const producer = sync_producer(uses);
  if (producer == nullptr || timing.messages.empty()) return std::nullopt;
  SyncTiming sync{microseconds_of(*producer, communication::cycle_period),
                  microseconds_of(*producer, communication::window_length)};
  if (sync.period == Nanoseconds{}) return std::nullopt;
  for (const TimedMessage& one : timing.messages) {
    if (!one.is_synchronous) continue;
    ++sync.pdos;
    sync.is_bounded = sync.is_bounded && one.response.worst;
    sync.last_end = std::max(sync.last_end, one.response.worst.value_or(Nanoseconds{}));
  }
  return sync;
}

Nanoseconds rule_of_thumb_period(std::size_t pdos, unsigned bit_rate) {
  constexpr std::int64_t full_rate = 1000;  // kbit/s
  constexpr std::int64_t pdos_per_millisecond = 9;
  constexpr std::int64_t percent_of_bus = 40;
  constexpr Nanoseconds others = std::chrono::milliseconds{2};
  const Nanoseconds of_pdos = Nanoseconds{std::chrono::milliseconds{100}} * static_cast<std::int64_t>(pdos) /
                              (pdos_per_millisecond * percent_of_bus);
  return (of_pdos + others) * full_rate / static_cast<std::int64_t>(bit_rate);
}

}  // namespace edsc
