/// EMCY producer (CiA 301, 7.2.7): errors that appear and disappear, the error register 1001h and the history 1003h.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/assume_aligned.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/emcy/error_register.hpp"
#include "canopen/emcy/service_error.hpp"
#include "canopen/od/device_options.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"

namespace canopen {

/// The manufacturer-specific bytes of an EMCY.
using EmergencyInfo = std::array<std::uint8_t, 5>;
/// No such bytes.
inline constexpr EmergencyInfo no_emergency_info{};

/// Returns the manufacturer-specific bytes of an EMCY that a service of the device sends.
template <class Device>
[[nodiscard]] constexpr EmergencyInfo emergency_info([[maybe_unused]] const ObjectStore<Device>& store,
                                                     std::uint16_t code) {
  if constexpr (has_sheet<Device>) {
    return Device::sheet_of(store).emergency_info(code);
  } else {
    return Device::emergency_info(code);
  }
}

/// The errors of one device. Each error that appears is sent once, with the present register, and recorded in the
/// history; each one that disappears is sent as code 0000h with the remaining register. Messages wait, in order, while
/// the bus has no room, the inhibit time 1015h runs or the NMT state does not allow them; if more than `depth` are
/// waiting, the last one is overwritten and counted.
template <class Device>
class EmergencyProducer {
 public:
  static constexpr std::size_t depth = 4;

  /// Reports an error. `bits` remain set in the register until they are passed to `gone`.
  void appeared(ObjectStore<Device>& store, std::uint16_t code, ErrorRegister bits, const EmergencyInfo& info) {
    application_bits_ |= held_by(bits);
    note(store, code, info);
  }

  /// Sets bits of the register for an error that has already been reported.
  void hold(ObjectStore<Device>& store, ErrorRegister bits) {
    application_bits_ |= static_cast<std::uint8_t>(bits);
    if constexpr (has_register) store_register(store, error_register());
  }

  /// Reports that an error has disappeared, and clears its bits of the register; do not pass bits of another error.
  /// Returns false if there was no such error.
  bool gone(ObjectStore<Device>& store, ErrorRegister bits) {
    const std::uint8_t held = held_by(bits);
    if ((application_bits_ & (held == unnamed ? 0xFF : held)) == 0) return false;
    application_bits_ &= static_cast<std::uint8_t>(~unsigned{held});
    note_reset(store);
    return true;
  }
  /// The same, with manufacturer-specific bytes of the errors that remain.
  bool gone(ObjectStore<Device>& store, ErrorRegister bits, const EmergencyInfo& remaining) {
    const std::uint8_t held = held_by(bits);
    if ((application_bits_ & (held == unnamed ? 0xFF : held)) == 0) return false;
    application_bits_ &= static_cast<std::uint8_t>(~unsigned{held});
    note(store, emergency_code::reset, remaining);
    return true;
  }

  /// Reports an error that a service has detected.
  void appeared(ObjectStore<Device>& store, ServiceError error) {
    service_errors_ |= set_of(error);
    const std::uint8_t row = static_cast<std::uint8_t>(error);
    if constexpr (has_sheet<Device>) {
      note(store, service_error_codes[row], emergency_info<Device>(store, service_error_codes[row]));
    } else {
      note(store, service_error_codes[row], has_info ? infos[row] : no_info);
    }
  }

  /// Ends an error that a service has detected. Returns false if it was not present.
  bool gone(ObjectStore<Device>& store, ServiceError error) {
    if ((service_errors_ & set_of(error)) == 0) return false;
    service_errors_ &= static_cast<ServiceErrors>(~set_of(error));
    note_reset(store);
    return true;
  }

  /// Whether 1014h or 1015h is writable over the bus.
  static constexpr bool has_parameters = (Device::dictionary.find(0x1014, 0) & entry::writable) != 0 ||
                                         (Device::dictionary.find(0x1015, 0) & entry::writable) != 0;

  /// Checks whether these bytes may be written to 1014h or 1015h (CiA 301, 7.5.2.17 and 7.5.2.18). Bits of 1014h that
  /// the device does not allow to change are restored in `bytes`.
  ///   0609 0030h  1014h: the CAN-ID changes while EMCY is valid, is that of SYNC or a restricted one, also if the
  ///               device keeps some of its bits, or has 29 bits although the device supports 11; bit 30 is 1.
  ///               1015h: not a multiple of the device's step
  ///   0604 0047h  in the EDS, the object does not have the type of CiA 301
  [[nodiscard]] static AbortCode check(EntryAccess<Device> entries, std::uint16_t index,
                                       std::span<std::uint8_t> bytes) {
    const DeviceOptions& options = options_of<Device>(entries);
    if (index == 0x1015) {
      if (options.emcy_inhibit_time_step != 1) {
        if constexpr (entry::wire_bytes(Device::dictionary.find(0x1015, 0)) != 2)
          return AbortCode::internal_incompatibility;
        if (number_in(bytes) % options.emcy_inhibit_time_step != 0) return AbortCode::invalid_value;
      }
      return ok;
    }
    if constexpr (entry::wire_bytes(Device::dictionary.find(0x1014, 0)) != 4)
      return AbortCode::internal_incompatibility;
    const CobId before{entries.template number<0x1014, 0>()};
    const CobId written{number_in(bytes)};
    const CobId after = written_cob_id(before, options.emcy_cob_id_writable, bytes);
    constexpr std::uint32_t reserved_bit = 0x4000'0000;
    if ((after.value() & reserved_bit) != 0) return AbortCode::invalid_value;
    if (after.value() == function_code::sync) return AbortCode::invalid_value;
    if (options.emcy_cob_id_writable != 0xFFFF'FFFF) {
      if (after.valid() && !is_usable(written.value() & CobId::identifier)) return AbortCode::invalid_value;
    }
    const CobId from = options.emcy_cob_id_writable_while_valid ? CobId{} : before;
    return may_change(from, after, options.pdo_extended_ids) ? ok : AbortCode::invalid_value;
  }

  /// Clears all errors and waiting messages (CiA 301, 7.2.7.1: effect of a reset).
  void reset() {
    waiting_ = 0;
    application_bits_ = 0;
    service_errors_ = 0;
    inhibit_ = {};
  }

  /// Sends the EMCY before a requested reset, if the device has one, and records it in the history, which the reset
  /// keeps. The message is lost if the bus has no room.
  template <Bus BusType>
  void announce_reset([[maybe_unused]] ObjectStore<Device>& store, [[maybe_unused]] BusType& bus) const {
    if constexpr (has_cob_id && Device::options.reset_emergency != 0) {
      const std::uint16_t code = options_of<Device>(store).reset_emergency;
      if constexpr (has_sheet<Device>) {
        if (code == 0 || !Device::sheet_of(store).dictionary.has(0x1014, 0)) return;
      }
      const auto bits =
          static_cast<std::uint8_t>(error_register() | static_cast<std::uint8_t>(ErrorRegister::manufacturer));
      const EmergencyInfo info = emergency_info<Device>(store, code);
      (void)send(store, bus, message_of(code, bits, info));
      remember(store, code, info);
    }
  }

  /// Returns the number of EMCYs lost since power-on because too many were waiting; at most 65,535.
  [[nodiscard]] std::uint16_t lost() const { return lost_; }

  /// Discards all waiting messages except the last one.
  void keep_last() {
    if (waiting_ == 0) return;
    first_ = place(waiting_ - 1u);
    waiting_ = 1;
  }

  /// Ends the inhibit time if it has elapsed, in each NMT state and whether or not a message is waiting.
  void end_inhibit_time(TimePoint now) { static_cast<void>(is_inhibited(now)); }

  /// Sends waiting messages. Returns false if the bus had no room; they keep waiting.
  template <Bus BusType>
  bool serve(const ObjectStore<Device>& store, BusType& bus, TimePoint now) {
    if constexpr (has_cob_id) {
      while (waiting_ != 0 && !is_inhibited(now)) {
        if (CobId{store.template number<0x1014, 0>()}.valid()) {
          if (!send(store, bus, queue_[first_])) return false;
          start_inhibit_time(store, now);
        }
        --waiting_;
        first_ = place(1);
      }
    }
    return true;
  }

  /// Sets the elements of the history to 0.
  static void clear_history([[maybe_unused]] ObjectStore<Device>& store) {
    if constexpr (has_history) {
      std::ranges::fill_n(store.entries().ram(history_first), history_capacity * 4, std::uint8_t{0});
    }
  }

  /// Returns when the inhibit time ends, or when the next message is to be sent, if the NMT state allows it: not later
  /// than `now` if it can already be sent.
  [[nodiscard]] std::optional<TimePoint> next_deadline(TimePoint now, bool may_send) const {
    if constexpr (has_inhibit_time) {
      if (inhibit_.runs) return inhibit_.end.at();
    }
    return may_send && waiting_ != 0 ? std::optional{now} : std::nullopt;
  }

 private:
  struct Inhibit {
    Deadline end;
    bool runs;
  };
  struct Nothing {};

  static constexpr bool has_register = Device::dictionary.has(0x1001, 0);
  static constexpr bool has_cob_id = Device::dictionary.has(0x1014, 0);
  static constexpr bool has_inhibit_time = Device::dictionary.has(0x1015, 0);

  /// The history is served if count and elements of 1003h are in RAM.
  static constexpr entry::Word history_count = Device::dictionary.find(0x1003, 0);
  static constexpr entry::Word history_first = Device::dictionary.find(0x1003, 1);
  static constexpr bool has_history = (history_first > Dictionary::no_sub_index) &&
                                      entry::place_of(history_count) == entry::Place::ram &&
                                      entry::place_of(history_first) == entry::Place::ram;
  static constexpr std::uint8_t history_capacity = [] {
    std::uint8_t capacity = 0;
    while (has_history && capacity < 254 && Device::dictionary.has(0x1003, static_cast<std::uint8_t>(capacity + 1)))
      ++capacity;
    return capacity;
  }();

  /// Bit of `application_bits_` for errors that only set the generic bit. CiA 301 does not define such a bit.
  static constexpr std::uint8_t unnamed = 0x40;

  [[nodiscard]] static constexpr std::uint8_t held_by(ErrorRegister bits) {
    return bits == ErrorRegister::none ? unnamed : static_cast<std::uint8_t>(bits);
  }

  /// Returns 1001h for the present errors: the generic bit is set whenever there is one.
  [[nodiscard]] std::uint8_t error_register() const {
    const auto bits = static_cast<std::uint8_t>(
        application_bits_ | (service_errors_ != 0 ? static_cast<std::uint8_t>(ErrorRegister::communication) : 0));
    constexpr auto generic = static_cast<std::uint8_t>(ErrorRegister::generic);
    return static_cast<std::uint8_t>(bits != 0 ? (bits & ~unsigned{unnamed}) | generic : 0);
  }

  static constexpr EmergencyInfo no_info{};

  /// Manufacturer-specific bytes of the EMCYs of service errors; zero if the device does not define them.
  static constexpr auto infos = [] {
    std::array<EmergencyInfo, std::size(service_error_codes)> rows{};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = Device::emergency_info(service_error_codes[i]);
    return rows;
  }();
  static constexpr bool has_info =
      std::ranges::any_of(infos, [](const EmergencyInfo& info) { return info != no_info; });

  void note_reset(ObjectStore<Device>& store) { note(store, emergency_code::reset, no_info); }

  void note(ObjectStore<Device>& store, std::uint16_t code, const EmergencyInfo& info) {
    const std::uint8_t bits = error_register();
    if constexpr (has_register) store_register(store, bits);
    if (code != emergency_code::reset || options_of<Device>(store).error_history_keeps_resets)
      remember(store, code, info);
    if constexpr (has_cob_id) {
      if (waiting_ < depth) {
        ++waiting_;
      } else if (lost_ != 0xFFFF) {
        ++lost_;
      }
      queue_[place(waiting_ - 1u)] = message_of(code, bits, info);
    }
  }

  /// Returns the position of the message that is `offset` places after the first one.
  [[nodiscard]] std::uint8_t place(unsigned offset) const {
    return static_cast<std::uint8_t>((first_ + offset) % depth);
  }

  [[nodiscard]] static FrameWords message_of(std::uint16_t code, std::uint8_t bits, const EmergencyInfo& info) {
    return {code | std::uint32_t{bits} << 16 | std::uint32_t{info[0]} << 24, number_in(std::span{info}.subspan(1))};
  }

  template <Bus BusType>
  [[nodiscard]] static bool send(const ObjectStore<Device>& store, BusType& bus, FrameWords message) {
    return send_configured(bus, store.template number<0x1014, 0>(), 8, message.first, message.second);
  }

  static void store_register(ObjectStore<Device>& store, std::uint8_t bits) {
    constexpr entry::Word word = Device::dictionary.find(0x1001, 0);
    if constexpr (entry::place_of(word) == entry::Place::ram) *store.entries().ram(word) = bits;
  }

  /// Adds an error to the front of the history: code in the low half, the first two bytes of the information in the
  /// high half. The oldest one is removed if necessary.
  static void remember([[maybe_unused]] ObjectStore<Device>& store, [[maybe_unused]] std::uint16_t code,
                       [[maybe_unused]] const EmergencyInfo& info) {
    if constexpr (has_history) {
      std::uint8_t& count = *store.entries().ram(history_count);
      std::uint8_t* field = store.entries().ram(history_first);
      unsigned older = count;
      std::uint8_t capacity = history_capacity;
      if constexpr (has_sheet<Device>) {
        const Dictionary& dictionary = store.entries().dictionary();
        capacity = dictionary.highest_sub_index(dictionary.find_index(0x1003));
        if (capacity == 0) return;
      }
      if (older >= capacity) older = capacity - 1u;  // the application may set any number
      count = static_cast<std::uint8_t>(older + 1);
      std::uint32_t newest = code;
      if (options_of<Device>(store).error_history_has_info) {
        newest |= static_cast<std::uint32_t>(info[0] << 16) | (std::uint32_t{info[1]} << 24);
      }
      for (field += sizeof newest * older; older != 0; --older, field -= sizeof newest) {
        std::uint32_t moved;
        std::memcpy(&moved, assume_aligned<alignof(std::uint32_t)>(field - sizeof moved), sizeof moved);
        std::memcpy(assume_aligned<alignof(std::uint32_t)>(field), &moved, sizeof moved);
      }
      std::memcpy(assume_aligned<alignof(std::uint32_t)>(field), &newest, sizeof newest);
    }
  }

  void start_inhibit_time([[maybe_unused]] const ObjectStore<Device>& store, [[maybe_unused]] TimePoint now) {
    if constexpr (has_inhibit_time) {
      const Duration inhibit =
          from_hundred_microseconds(static_cast<std::uint16_t>(store.template number<0x1015, 0>()));
      inhibit_ = {now + inhibit, inhibit.count() != 0};
    }
  }

  /// Whether the inhibit time is running; ends it if it has elapsed.
  [[nodiscard]] bool is_inhibited([[maybe_unused]] TimePoint now) {
    if constexpr (has_inhibit_time) {
      inhibit_.runs = inhibit_.runs && inhibit_.end.is_ahead(now);
      return inhibit_.runs;
    }
    return false;
  }

  std::uint8_t waiting_ = 0;
  std::uint8_t first_ = 0;  ///< position of the first waiting message
  std::uint8_t application_bits_ = 0;
  ServiceErrors service_errors_ = 0;
  std::uint16_t lost_ = 0;
  [[no_unique_address]] std::conditional_t<has_inhibit_time, Inhibit, Nothing> inhibit_{};
  std::array<FrameWords, has_cob_id ? depth : 1> queue_{};
};

}  // namespace canopen
