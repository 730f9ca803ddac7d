/// The RPDOs of a device (CiA 301, 7.2.2).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/clock.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/mapped_places.hpp"
#include "canopen/pdo/parameter_column.hpp"
#include "canopen/pdo/pdo.hpp"
#include "canopen/pdo/pdo_list.hpp"
#include "canopen/pdo/transmission_type.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen {

/// Events of an RPDO, reported with its number (from 1).
enum class RpdoEvent : std::uint8_t {
  taken,         ///< its values have been applied
  too_short,     ///< a frame has fewer bytes than are mapped; it was ignored
  timeout,       ///< no frame was received within its event timer
  length_right,  ///< the first valid frame after one that was too short
  in_time,       ///< the first valid frame after a timeout
};

/// All RPDOs of one device, with the present values of 1400h and the following parameters. Those of transmission types
/// 254 and 255 are applied at once, those of types 0..240 at the next SYNC. If a frame is longer than the mapping, its
/// first bytes are used; a shorter one is ignored. The event timer (sub-index 5, ms) monitors the time between frames,
/// from the first one on.
///
/// Functions of the node that the service calls (`host`, a reference to it, cheap to copy):
///   entries(), now()
///   operational()                            a handler may end this state
///   window_over()                            whether RPDOs of types 0..240 are too late
///   take<O>(value)                           a value for an object with static mapping
///   take(index, sub_index, bytes)            the same by index and sub-index
///   happened(event, number)
/// and the constant mode_offset: see RpdoHooks.
template <class Device>
class RpdoService {
 public:
  struct Listed : Device::Rpdos {};
  struct Pdos : ServedPdos<Device::dictionary, rpdo_indices, Listed> {};
  using Mapped = MappedPlaces<Device, rpdo_indices, Pdos>;
  static constexpr std::size_t count = Pdos::count;
  static constexpr bool has_dynamic_mapping = Mapped::any;

  /// `watched(mapped)` returns whether a new value of an object needs more than to be stored.
  template <class Watched>
  void enter_operational(EntryAccess<Device> entries, Watched watched) {
    for (std::size_t i = 0; i < count; ++i) activate(i, entries, watched);
  }

  /// Applies a new value of a communication or mapping parameter, 1400h..17FFh.
  template <class Watched>
  void parameter_changed(EntryAccess<Device> entries, std::uint16_t index, Watched watched) {
    const std::size_t i = place_of_pdo<Device, rpdo_indices, Pdos>(index, entries);
    if (i != count) activate(i, entries, watched);
  }

  /// Looks up the mappings again after that of a TPDO has changed: other objects are watched now.
  template <class Watched>
  void watch_again([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] Watched watched) {
    if constexpr (has_dynamic_mapping) {
      for (std::size_t i = 0; i < count; ++i) {
        if (Mapped::is_dynamic(i)) slots_[i].size = look_up(i, entries, watched);
      }
      applied_.looked_up = true;
    }
  }

  /// Passes a frame to every RPDO that receives it. `cob_id` is that of the frame. Returns false if there is none.
  template <class Host>
  bool on_frame(const Frame& frame, std::uint32_t cob_id, Host host) {
    std::size_t i = 0;
    if constexpr (has_short_path) {
      i = find(cob_id, host.entries());
      if (i == count) return false;
      Slot& slot = slots_[i];
      const bool waits = (slot.flags & ~buffered) == at_sync && frame.size >= slot.size && !host.window_over();
      if (waits) {
        slot.data = frame.data;
        slot.flags = at_sync | buffered;
        return true;
      }
    }
    return receive_all(i, frame, cob_id, host);
  }

  /// Applies what has been received since the last SYNC.
  template <class Host>
  void on_sync(Host host) {
    for (std::size_t i = 0; i < count && host.operational(); ++i) {
      if ((slots_[i].flags & buffered) == 0) continue;
      slots_[i].flags &= static_cast<std::uint8_t>(~buffered);
      take(i, slots_[i].data, host);
    }
  }

  /// Reports RPDOs whose event timer has elapsed.
  template <class Host>
  void on_time([[maybe_unused]] Host host) {
    if constexpr (has_event_timer) {
      for (std::size_t i = 0; i < count && host.operational(); ++i) check_deadline(i, host);
    }
  }

  /// Returns when the next event timer elapses.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next;
    if constexpr (has_event_timer) {
      for (const Slot& slot : slots_) {
        if ((slot.flags & monitored) != 0 && (!next || slot.deadline < *next)) next = slot.deadline;
      }
    }
    return next;
  }

  /// Error conditions of the RPDOs.
  struct Conditions {
    bool too_short;
    bool timeout;
  };
  [[nodiscard]] Conditions conditions() const {
    std::uint8_t flags = 0;
    for (const Slot& slot : slots_) flags |= slot.flags;
    return {(flags & cut_short) != 0, (flags & missed) != 0};
  }

 private:
  enum Flag : std::uint8_t {
    buffered = 1,   ///< data wait for a SYNC
    cut_short = 2,  ///< the last frame was too short
    monitored = 4,  ///< the deadline is valid
    missed = 8,     ///< the deadline has passed
    at_sync = 16,   ///< of types 0..240
    at_once = 32,   ///< of types 254 and 255
    timed = 64,     ///< its event timer is not 0
    shared = 128,   ///< another RPDO may have the same CAN-ID
  };

  /// Whether the frame of an RPDO that only waits for the SYNC has a path of its own: on a Cortex-M4 it saves 53
  /// instructions of each frame, on a Cortex-M0+ it takes 224 bytes.
  static constexpr bool has_short_path = !prefers_size;

  static constexpr std::uint8_t unmapped = 0xFF;  ///< a size that no frame reaches

  using Data = std::array<std::uint8_t, 8>;

  static constexpr std::array<std::uint8_t, count> sizes = Pdos::sizes;

  template <std::uint8_t SubIndex>
  using Column = ParameterColumn<Device, Pdos, rpdo_indices.communication, SubIndex>;
  static constexpr bool has_event_timer = Column<pdo_parameter::event_timer>::exists;
  static constexpr std::uint32_t event_unit = from_milliseconds(1).count();

  struct NoTime {};
  struct Slot {
    alignas(4) Data data;
    [[no_unique_address]] std::conditional_t<has_event_timer, TimePoint, NoTime> deadline;
    std::uint8_t flags;
    std::uint8_t size;  ///< mapped data bytes, or `unmapped`
  };

  /// Returns the COB-ID in the format of `cob_id_of`: bit 30 is ignored for an RPDO, and bit 31 is never set
  /// in a frame.
  [[nodiscard]] static std::uint32_t cob_id_at(std::size_t i, EntryAccess<Device> entries) {
    return Column<pdo_parameter::cob_id>::get(entries, i, CobId::invalid_bit) & ~CobId::no_rtr_bit;
  }

  /// Returns the first RPDO with a CAN-ID; `count` if there is none. Up to this number, the loop is unrolled.
  static constexpr std::size_t few = 8;
  template <std::size_t Position = 0>
  [[nodiscard, gnu::always_inline]] static std::size_t find(std::uint32_t cob_id, EntryAccess<Device> entries) {
    if constexpr (count > few) {
      std::size_t i = 0;
      while (i < count && cob_id_at(i, entries) != cob_id) ++i;
      return i;
    } else if constexpr (Position == count) {
      return count;
    } else {
      return cob_id_at(Position, entries) == cob_id ? Position : find<Position + 1>(cob_id, entries);
    }
  }

  template <class Host>
  [[nodiscard]] static std::uint16_t number_of(std::size_t i, [[maybe_unused]] Host host) {
    if constexpr (has_sheet<Device>) {
      return number_of_pdo<Device, rpdo_indices, Pdos>(i, host.entries());
    } else {
      return number_of_pdo<Pdos>(i);
    }
  }

  template <class Watched>
  void activate(std::size_t i, EntryAccess<Device> entries, Watched watched) {
    if constexpr (has_dynamic_mapping) {
      if (applied_.pdo == i + 1) applied_ = {0, true};
    }
    Slot& slot = slots_[i];
    slot.size = look_up(i, entries, watched);
    constexpr std::uint32_t event_driven = 255;
    const std::uint32_t type = Column<pdo_parameter::transmission_type>::get(entries, i, event_driven);
    slot.flags = type <= 240 ? at_sync : type >= 254 ? at_once : 0;
    if (event_timer(i, entries) != 0) slot.flags |= timed;
    if constexpr (has_short_path) mark_shared(i, entries);
  }

  /// Marks an RPDO and those that have the same CAN-ID.
  void mark_shared(std::size_t i, EntryAccess<Device> entries) {
    for (std::size_t other = 0; other < count; ++other) {
      if (other == i || cob_id_at(other, entries) != cob_id_at(i, entries)) continue;
      slots_[other].flags |= shared;
      slots_[i].flags |= shared;
    }
  }

  template <class Watched>
  std::uint8_t look_up(std::size_t i, [[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] Watched watched) {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::is_dynamic(i)) {
        const std::uint8_t size = places_.look_up(i, entries, watched);
        return size != 0 ? size : unmapped;
      }
    }
    return sizes[i];
  }

  /// Passes a frame to those of RPDO `i` and the following ones that have its CAN-ID. Returns whether there are any.
  template <class Host>
  [[gnu::noinline]] bool receive_all(std::size_t i, const Frame& frame, std::uint32_t cob_id, Host host) {
    bool received = false;
    for (; i < count; ++i) {
      if (cob_id_at(i, host.entries()) != cob_id) continue;
      if (received && !host.operational()) break;
      receive(i, frame, host);
      received = true;
    }
    return received;
  }

  template <class Host>
  void receive(std::size_t i, const Frame& frame, Host host) {
    Slot& slot = slots_[i];
    if (frame.size < slot.size) return cut(i, host);
    if ((slot.flags & (cut_short | monitored | missed)) != 0) {
      settle(i, host);
      if (!host.operational()) return;
    }
    start_deadline(i, host);
    if ((slot.flags & at_sync) != 0 && !host.window_over()) {
      slot.data = frame.data;
      slot.flags |= buffered;
    }
    if ((slot.flags & at_once) != 0) take(i, frame.data, host);
  }

  /// Handles a frame that is too short.
  template <class Host>
  void cut(std::size_t i, Host host) {
    if (slots_[i].size == unmapped) return;
    const bool first = (slots_[i].flags & cut_short) == 0;
    slots_[i].flags |= cut_short;
    if (first) host.happened(RpdoEvent::too_short, number_of(i, host));
  }

  /// Ends the error conditions after a valid frame, and reports an event timer that had elapsed before it.
  template <class Host>
  void settle(std::size_t i, Host host) {
    end(i, cut_short, RpdoEvent::length_right, host);
    check_deadline(i, host);
    end(i, missed, RpdoEvent::in_time, host);
    slots_[i].flags &= static_cast<std::uint8_t>(~monitored);
  }

  /// Ends a condition and reports it, if it was set.
  template <class Host>
  void end(std::size_t i, std::uint8_t condition, RpdoEvent event, Host host) {
    if ((slots_[i].flags & condition) == 0) return;
    slots_[i].flags &= static_cast<std::uint8_t>(~condition);
    host.happened(event, number_of(i, host));
  }

  /// Reports an RPDO whose event timer has elapsed.
  template <class Host>
  void check_deadline([[maybe_unused]] std::size_t i, [[maybe_unused]] Host host) {
    if constexpr (has_event_timer) {
      if ((slots_[i].flags & monitored) == 0 || is_ahead(slots_[i].deadline, event_unit, host.now())) return;
      slots_[i].flags = static_cast<std::uint8_t>((slots_[i].flags & ~monitored) | missed);
      host.happened(RpdoEvent::timeout, number_of(i, host));
    }
  }

  template <class Host>
  void start_deadline([[maybe_unused]] std::size_t i, [[maybe_unused]] Host host) {
    if constexpr (has_event_timer) {
      if ((slots_[i].flags & timed) == 0) return;
      slots_[i].flags |= monitored;
      slots_[i].deadline = host.now() + from_milliseconds(event_timer(i, host.entries()));
    }
  }

  /// In ms; 0 if it does not exist.
  [[nodiscard]] static std::uint16_t event_timer(std::size_t i, EntryAccess<Device> entries) {
    return static_cast<std::uint16_t>(Column<pdo_parameter::event_timer>::get(entries, i, 0));
  }

  template <class Host>
  void take(std::size_t which, const Data& data, Host host) {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::is_dynamic(which)) take_mapped(which, data, host);
    }
    if constexpr (Mapped::any_static) take_static(which, data, host, Pdos{}, std::make_index_sequence<count>{});
    host.happened(RpdoEvent::taken, number_of(which, host));
  }

  template <class Host, class... Pdo, std::size_t... Position>
  static void take_static([[maybe_unused]] std::size_t which, [[maybe_unused]] const Data& data,
                          [[maybe_unused]] Host host, PdoList<Pdo...>, std::index_sequence<Position...>) {
    // Not a fold: Clang accepts 256 operands at most.
    [[maybe_unused]] const bool tried[] = {
        true, (take_if<Pdo, Mapped::capacities[Position] == 0>(which == Position, data, host), true)...};
  }

  template <class Pdo, bool IsStatic, class Host>
  static void take_if([[maybe_unused]] bool it_is, [[maybe_unused]] const Data& data, [[maybe_unused]] Host host) {
    if constexpr (IsStatic) {
      if (it_is) take_objects<Pdo>(data, host, std::make_index_sequence<Pdo::entries>{});
    }
  }

  template <class Pdo, class Host, std::size_t... Position>
  static void take_objects([[maybe_unused]] const Data& data, [[maybe_unused]] Host host,
                           std::index_sequence<Position...>) {
    (take_object<typename Pdo::template Entry<Position>>(Pdo::template get_from_words<Position>(data), host), ...);
  }

  template <class Object, class Host>
  static void take_object([[maybe_unused]] const typename Object::type& value, [[maybe_unused]] Host host) {
    if constexpr (!is_dummy<Object>) host.template take<Object>(value);
  }

  /// A handler may change mappings: if it changes that of this PDO, the rest of the frame is discarded.
  template <class Host>
  void take_mapped(std::size_t which, const Data& data, Host host) {
    using Runs = typename Mapped::Runs;
    const EntryAccess<Device> entries = host.entries();
    if constexpr (Host::may_change_mappings) applied_ = {static_cast<std::uint16_t>(which + 1), false};
    const auto* run = places_.of(which);
    for (unsigned at = 0, end = slots_[which].size * 8u / Runs::unit; at < end; ++run) {
      const unsigned length = Runs::length(*run);
      if ((*run & Runs::apart) == 0) {
        std::uint8_t* const to = entries.ram(static_cast<entry::Word>(Runs::offset(*run)));
        take_bits_into(to, data.data(), at * Runs::unit, length * Runs::unit);
      } else if ((*run & Runs::nothing) != Runs::nothing && !repeats_mode<Host>(*run, entries, data, at)) {
        take_watched(which, data, at * Runs::unit, host);
        if (Host::may_change_mappings && applied_.looked_up) {
          if (applied_.pdo == 0) return;
          applied_.looked_up = false;
          run = places_.of(which);
          for (unsigned before = 0; before < at; ++run) before += Runs::length(*run);
        }
      }
      at += length;
    }
    if constexpr (Host::may_change_mappings) applied_ = {};
  }

  /// Whether a run is 6060h with the value that it already has, and no function is called for it. Saves 151
  /// instructions of a Cortex-M4, takes 28 bytes of a Cortex-M0+.
  template <class Host>
  [[nodiscard]] static bool repeats_mode([[maybe_unused]] typename Mapped::Place run,
                                         [[maybe_unused]] EntryAccess<Device> entries,
                                         [[maybe_unused]] const Data& data, [[maybe_unused]] unsigned at) {
    if constexpr (prefers_size || Host::mode_offset == Host::no_offset) {
      return false;
    } else {
      const unsigned bit = at * Mapped::Runs::unit;
      const auto offset = static_cast<entry::Word>(Mapped::Runs::offset(run));
      return offset == Host::mode_offset && bit % 8 == 0 && data[bit / 8] == *entries.ram(offset);
    }
  }

  /// Passes on the value of the object that begins at a bit.
  template <class Host>
  [[gnu::noinline]] static void take_watched(std::size_t which, const Data& data, unsigned at, Host host) {
    const MappingParameter mapping = Mapped::parameter(which, host.entries());
    std::size_t i = 0;
    for (unsigned bits = at; bits != 0; ++i) bits -= mapping.bits(i);
    const MappedObject mapped = mapping[i];
    alignas(8) std::array<std::uint8_t, 8> bytes;
    take_bits_into(bytes.data(), data.data(), at, mapped.bits());
    host.take(mapped.index(), mapped.sub_index(), std::span{bytes}.first((mapped.bits() + 7u) / 8u));
  }

  /// Copies values from a bit of the data on; unused bits of the last byte are 0.
  static void take_bits_into(std::uint8_t* to, const std::uint8_t* data, unsigned at, unsigned bits) {
    if (!Mapped::Runs::has_bits || ((at | bits) & 7) == 0) return copy_value(to, data + at / 8, bits / 8);
    const std::uint64_t value = take_bits(data, at, bits);
    const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
    copy_value(to, from, (bits + 7) / 8);
  }

  struct Applied {
    std::uint16_t pdo;  ///< whose values are being applied, from 1; 0: none
    bool looked_up;     ///< a handler has changed a mapping
  };

  std::array<Slot, count> slots_{};
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<has_dynamic_mapping, Applied, Nothing> applied_{};
  [[no_unique_address]] std::conditional_t<has_dynamic_mapping, Mapped, Nothing> places_{};
};

}  // namespace canopen
