/// TIME (1012h) in a node, and the high-resolution time stamp (1013h).
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "canopen/base/assume_aligned.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/service_set.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/time/time_stamp.hpp"

namespace canopen::service {

template <class Device>
class Time : public ServiceDefaults<Time<Device>> {
 public:
  static constexpr bool exists = TimeStamp<Device>::exists;

  template <class Host>
  static constexpr bool may_take(const Host&, std::uint32_t) {
    return true;
  }
  template <class Host>
  static bool on_frame(Host& host, const Frame& frame, std::uint32_t) {
    const std::optional<TimeOfDay> time = TimeStamp<Device>::take(host.store, frame);
    if (!time) return false;
    if (serves_sync(host.state)) host.handlers.template notify<function::OnTimeOfDay>(host.node(), *time);
    return true;
  }

  static constexpr bool checks(std::uint16_t index, std::uint8_t) { return index == 0x1012; }
  template <class Host>
  static AbortCode check_write(Host& host, std::uint16_t, std::uint8_t, std::span<std::uint8_t> bytes) {
    return check_time_parameter(host.store.entries(), bytes);
  }
};

/// 1013h: the time of the last SYNC, in us.
template <class Device>
class HighResolutionTime : public ServiceDefaults<HighResolutionTime<Device>> {
  static constexpr entry::Word word = Device::dictionary.find(0x1013, 0);

 public:
  static constexpr bool exists = (word > Dictionary::no_sub_index) && entry::place_of(word) == entry::Place::ram;

  template <class Host>
  void on_sync(Host& host, canopen::Sync) {
    const std::uint32_t microseconds = host.now.since_start().count() + offset_;
    std::uint8_t* const value = assume_aligned<alignof(std::uint32_t)>(host.store.entries().ram(word));
    std::memcpy(value, &microseconds, sizeof microseconds);
  }
  template <class Host>
  void after_write(Host& host, std::uint16_t index, std::uint8_t) {
    if (index == 0x1013) offset_ = host.store.entries().number(word) - host.now.since_start().count();
  }

 private:
  std::uint32_t offset_ = 0;  ///< us from the node's time to 1013h
};

}  // namespace canopen::service
