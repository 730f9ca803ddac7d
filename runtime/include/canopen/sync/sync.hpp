/// SYNC (CiA 301, 7.2.5), which synchronous PDOs wait for: consumer and producer.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"

namespace canopen {

/// A received SYNC message.
struct Sync {
  std::uint8_t counter;  ///< 1..240; 0: the network does not use the counter
  bool good;             ///< its length is the one that 1019h requires
};

inline constexpr std::uint8_t highest_sync_counter = 240;

/// Whether 1006h or 1007h contains a time: not 0, which is off, and not longer than two points in time can be apart.
[[nodiscard]] constexpr bool is_span(Duration span) { return span.count() - 1u < longest_span.count(); }

/// Whether 1006h accepts a value, including 0.
[[nodiscard]] constexpr bool is_sync_period(std::uint32_t microseconds) { return microseconds <= longest_span.count(); }

/// Whether 1019h accepts a counter overflow value: 0, or 2 to 240 (CiA 301, 7.5.2.22).
[[nodiscard]] constexpr bool is_sync_overflow(std::uint32_t value) {
  return value != 1 && value <= highest_sync_counter;
}

/// Receives the SYNC of 1005h. It has one data byte if the counter overflow value in 1019h is not 0, otherwise none.
template <class Device>
class SyncConsumer {
 public:
  static constexpr bool exists = Device::dictionary.has(0x1005, 0);
  static constexpr bool has_overflow = Device::dictionary.has(0x1019, 0);

  /// Whether a frame with this CAN-ID is the SYNC of this device.
  [[nodiscard]] static bool takes([[maybe_unused]] const ObjectStore<Device>& store,
                                  [[maybe_unused]] std::uint32_t cob_id) {
    if constexpr (exists) {
      // Bits 30 and 31 of 1005h do not belong to the CAN-ID.
      return (store.template number<0x1005, 0>() ^ cob_id) << 2 == 0;
    } else {
      return false;
    }
  }

  /// Returns the content of a SYNC. A device without 1019h does not check the length.
  [[nodiscard]] static Sync sync_of(const ObjectStore<Device>& store, const Frame& frame) {
    const std::uint8_t overflow = overflow_of(store);
    if (!has_overflow) return Sync{0, true};
    if constexpr (has_sheet<Device>) {
      if (!Device::sheet_of(store).dictionary.has(0x1019, 0)) return Sync{0, true};
    }
    return Sync{overflow != 0 ? frame.data[0] : std::uint8_t{0}, frame.size == (overflow != 0 ? 1 : 0)};
  }

  /// Returns 1019h; 0: the counter is not used.
  [[nodiscard]] static std::uint8_t overflow_of([[maybe_unused]] const ObjectStore<Device>& store) {
    if constexpr (has_overflow) {
      return static_cast<std::uint8_t>(store.template number<0x1019, 0>());
    } else {
      return 0;
    }
  }
};

/// Sends the SYNC of 1005h every 1006h microseconds if bit 30 of 1005h is set, with a counter up to 1019h.
template <class Device>
class SyncProducer {
 public:
  static constexpr bool exists = SyncConsumer<Device>::exists && Device::dictionary.has(0x1006, 0) &&
                                 (entry::place_of(Device::dictionary.find(0x1005, 0)) == entry::Place::ram ||
                                  entry::place_of(Device::dictionary.find(0x1006, 0)) == entry::Place::ram);

  /// Whether 1005h and 1006h allow the device to produce SYNC.
  [[nodiscard]] static bool can_be_switched_on([[maybe_unused]] EntryAccess<Device> entries) {
    if constexpr (has_sheet<Device>) {
      const entry::Word period = entries.find(0x1006, 0);
      return period > Dictionary::no_sub_index && (entry::place_of(period) == entry::Place::ram ||
                                                   entry::place_of(entries.find(0x1005, 0)) == entry::Place::ram);
    } else {
      return exists;
    }
  }

  /// Handles a new value of 1005h or 1006h, or a state in which SYNCs are sent: the first one is due one period later.
  /// The counter starts with 1 if `restart` is set (after Stopped and at boot-up) and when production starts.
  [[gnu::noinline]] void start(const ObjectStore<Device>& store, TimePoint now, bool restart) {
    const Duration period = period_of(store);
    const std::uint32_t cob_id = store.template number<0x1005, 0>();
    const bool produces = (cob_id & CobId::no_rtr_bit) != 0 && is_span(period) && is_usable(cob_id & CobId::identifier);
    if (restart || !running_) counter_ = 0;
    running_ = produces;
    due_ = now + period;
  }

  void stop() { running_ = false; }
  [[nodiscard]] bool runs() const { return running_; }

  /// Sends a SYNC that is due; a producer consumes its own. Returns false if none is due or the bus had no room.
  template <Bus BusType>
  [[nodiscard]] bool serve(const ObjectStore<Device>& store, BusType& bus, TimePoint now) {
    if (!running_ || due_.is_ahead(now)) return false;
    const std::uint8_t overflow = SyncConsumer<Device>::overflow_of(store);
    const std::uint8_t counter = counter_ < overflow ? static_cast<std::uint8_t>(counter_ + 1) : std::uint8_t{1};
    const std::uint32_t cob_id = store.template number<0x1005, 0>();
    if (!send_configured(bus, cob_id & CobId::identifier, overflow != 0 ? 1 : 0, overflow != 0 ? counter : 0u)) {
      due_.keep(now);
      return false;
    }
    counter_ = counter;
    const Duration period = period_of(store);
    due_ = due_.at() + period;
    if (due_.has_passed(now)) due_ = now + period;  // called so late that whole periods are missing
    return true;
  }

  /// Returns the last SYNC that has been sent.
  [[nodiscard]] Sync last(const ObjectStore<Device>& store) const {
    return Sync{SyncConsumer<Device>::overflow_of(store) != 0 ? counter_ : std::uint8_t{0}, true};
  }

  /// Returns when the next SYNC is due.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    return running_ ? std::optional{due_.at()} : std::nullopt;
  }

 private:
  [[nodiscard]] static Duration period_of(const ObjectStore<Device>& store) {
    return Duration{store.template number<0x1006, 0>()};
  }

  Deadline due_{};
  std::uint8_t counter_ = 0;  ///< of the last SYNC
  bool running_ = false;
};

/// The synchronous window of 1007h: the PDOs of a SYNC are sent and applied within it or not at all.
template <class Device>
class SyncWindow {
 public:
  static constexpr bool exists = SyncConsumer<Device>::exists && Device::dictionary.has(0x1007, 0);

  void open([[maybe_unused]] const ObjectStore<Device>& store, [[maybe_unused]] TimePoint now) {
    if constexpr (exists) {
      const Duration length{store.template number<0x1007, 0>()};
      window_ = {now + length, is_span(length)};
    }
  }

  /// Handles a new value of 1007h: 0 ends the window of the last SYNC. Another length applies from the next SYNC on.
  void length_changed([[maybe_unused]] const ObjectStore<Device>& store) {
    if constexpr (exists) window_.limited = window_.limited && store.template number<0x1007, 0>() != 0;
  }

  /// Whether the window of the last SYNC has elapsed. It remains so until the next SYNC.
  [[nodiscard]] bool over([[maybe_unused]] TimePoint now) const {
    if constexpr (exists) {
      return window_.limited && now > window_.end.at();
    } else {
      return false;
    }
  }

  /// Keeps the end of the window.
  void keep_deadline([[maybe_unused]] TimePoint now) {
    if constexpr (exists) window_.end.keep(now);
  }
  /// The time by which `keep_deadline` must be called.
  [[nodiscard]] std::optional<TimePoint> next_deadline([[maybe_unused]] TimePoint now) const {
    if constexpr (exists) {
      if (window_.limited) return now + longest_sleep;
    }
    return std::nullopt;
  }

 private:
  struct Window {
    Deadline end;
    bool limited;
  };
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<exists, Window, Nothing> window_{};
};

/// Checks whether these bytes may be written to 1005h, 1006h or 1019h (CiA 301, 7.5.2.5, 7.5.2.6 and 7.5.2.22). Bits of
/// 1005h that the device does not allow to change are restored in `bytes`.
///   0609 0030h  1005h: the device cannot produce SYNC; the CAN-ID changes while it does; a restricted CAN-ID.
///               1019h: 1 or more than 240
///   0609 0031h  1006h: more than 35 minutes
///   0604 0047h  1005h: in the EDS, it does not have the type of CiA 301
///   0800 0022h  1019h: 1006h is not 0
template <class Device>
[[nodiscard]] AbortCode check_sync_parameter(EntryAccess<Device> entries, std::uint16_t index,
                                             std::span<std::uint8_t> bytes) {
  if (index == 0x1005) {
    if constexpr (entry::wire_bytes(Device::dictionary.find(0x1005, 0)) != 4)
      return AbortCode::internal_incompatibility;
    const CobId before{entries.template number<0x1005, 0>()};
    const CobId written{number_in(bytes)};
    const CobId after = written_cob_id(before, options_of<Device>(entries).sync_cob_id_writable, bytes);
    if (!SyncProducer<Device>::can_be_switched_on(entries)) {
      if ((written.value() & CobId::no_rtr_bit) != 0) return AbortCode::invalid_value;
    }
    const bool generates = (before.value() & after.value() & CobId::no_rtr_bit) != 0;
    const bool changed = ((before.value() ^ after.value()) & CobId::identifier) != 0;
    if (generates && changed) return AbortCode::invalid_value;
    return may_be_written(after, true, options_of<Device>(entries).pdo_extended_ids) ? ok : AbortCode::invalid_value;
  }
  if (index == 0x1006) return is_sync_period(number_in(bytes)) ? ok : AbortCode::value_too_high;
  if constexpr (SyncConsumer<Device>::has_overflow) {
    if (!is_sync_overflow(bytes[0])) return AbortCode::invalid_value;
    if constexpr (Device::dictionary.has(0x1006, 0)) {
      if (entries.template number<0x1006, 0>() != 0) return AbortCode::device_state;
    }
  }
  return ok;
}

}  // namespace canopen
