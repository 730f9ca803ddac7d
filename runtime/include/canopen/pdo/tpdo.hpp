/// The TPDOs of a device (CiA 301, 7.2.2): when they are sent, and with which data.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
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
#include "canopen/pdo/static_tpdos.hpp"
#include "canopen/pdo/tpdo_slot.hpp"
#include "canopen/pdo/transmission_type.hpp"
#include "canopen/sync/sync.hpp"

namespace canopen {

/// No values to read before a TPDO is sent.
struct NoRefresh {
  void operator()(std::size_t) const {}
};

/// All TPDOs of one device, with the present values of 1800h and the following parameters.
///
///   type 0         at the SYNC after a mapped object has changed
///   type 1..240    at every n-th SYNC, counted from the SYNC whose counter is the SYNC start value
///   type 252       on a remote frame, with the data of the last SYNC
///   type 253       on a remote frame
///   type 254, 255  when a mapped object has changed, when the event timer has elapsed, and once on entering
///                  Operational; never within the inhibit time after the last transmission
///
/// TPDOs of all types respond to a remote frame if bit 30 of their COB-ID allows it.
template <class Device>
class TpdoService {
 public:
  struct Listed : Device::Tpdos {};
  struct Pdos : ServedPdos<Device::dictionary, tpdo_indices, Listed> {};
  using Mapped = MappedPlaces<Device, tpdo_indices, Pdos>;
  using Static = StaticTpdos<Device, Pdos>;
  static constexpr std::size_t count = Pdos::count;
  static constexpr bool has_dynamic_mapping = Mapped::any;

  void enter_operational(ObjectStore<Device>& store, TimePoint now) {
    if constexpr (has_sheet<Device>) sends_changes_.of_node = options_of<Device>(store).event_driven_on_change;
    for (std::size_t i = 0; i < count; ++i) {
      slots_[i].flags = 0;
      activate(i, store, now);
      if (options_of<Device>(store).event_driven_on_change) slots_[i].flags |= changed_bit;
    }
  }

  /// Marks the TPDOs that map `Object` to be sent, because it has a new value. Returns false if there are none.
  template <DictionaryObject Object>
  bool changed([[maybe_unused]] EntryAccess<Device> entries) {
    bool carried = false;
    if constexpr (!Device::triggers_event(Object::index, Object::sub_index)) {
      // never sent because of this object
    } else if constexpr (count > few) {
      constexpr std::uint32_t key = object_key(Object::index, Object::sub_index);
      constexpr std::size_t first = Static::first_of(key), carriers = Static::count_of(key);
      for (std::size_t i = first; i < first + carriers; ++i) {
        slots_[Static::place_in(Static::sorted[i])].flags |= changed_bit;
        carried = true;
      }
      if constexpr (has_dynamic_mapping) {
        for (std::size_t i = 0; i < count; ++i) {
          if (!Mapped::is_dynamic(i) || !Mapped::carries(i, entries, key)) continue;
          slots_[i].flags |= changed_bit;
          carried = true;
        }
      }
    } else {
      Pdos::for_each([&]<class Pdo, std::size_t Position>() {
        if constexpr (Mapped::capacities[Position] != 0) {
          if (!Mapped::carries(Position, entries, object_key(Object::index, Object::sub_index))) return;
        } else if constexpr (!Pdo::template maps<Object>) {
          return;
        }
        slots_[Position].flags |= changed_bit;
        carried = true;
      });
    }
    return carried;
  }

  /// The same for an object that is known only by index and sub-index.
  void changed([[maybe_unused]] EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index) {
    if constexpr (has_sheet<Device>) {
      if (!Device::sheet_of(entries).triggers_event(index, sub_index)) return;
    } else {
      if (!Device::triggers_event(index, sub_index)) return;
    }
    const std::uint32_t key = object_key(index, sub_index);
    for (const auto row : Static::carriers) {
      if (Static::key_in(row) == key) slots_[Static::place_in(row)].flags |= changed_bit;
    }
    if constexpr (has_dynamic_mapping) {
      for (std::size_t i = 0; i < count; ++i) {
        if (Mapped::carries(i, entries, key)) slots_[i].flags |= changed_bit;
      }
    }
  }

  /// Whether a TPDO maps an object now, or can do so: `changed` must be called for it.
  [[nodiscard]] static bool carries(EntryAccess<Device> entries, std::uint32_t key) {
    for (const auto row : Static::carriers) {
      if (Static::key_in(row) == key) return true;
    }
    if constexpr (has_dynamic_mapping) {
      for (std::size_t i = 0; i < count; ++i) {
        if (Mapped::carries(i, entries, key)) return true;
      }
    }
    return false;
  }

  /// Applies a new value of a communication or mapping parameter, 1800h..1BFFh.
  void parameter_changed(ObjectStore<Device>& store, std::uint16_t index, std::uint8_t sub_index, TimePoint now) {
    const std::size_t i = place_of_pdo<Device, tpdo_indices, Pdos>(index, store);
    if (i == count) return;
    if (!has_dynamic_mapping || !is_tpdo_mapping(index)) {
      if (sub_index == pdo_parameter::inhibit_time) return;
      if (sub_index == pdo_parameter::event_timer) return start_event_timer(slots_[i], i, store.entries(), now);
    }
    const bool sends_changes = (slots_[i].flags & event_driven) != 0;
    slots_[i].flags &= static_cast<std::uint8_t>(sends_changes ? inhibited | changed_bit : inhibited);
    activate(i, store, now);
  }

  /// Calls `visit(key)` for each object that a TPDO maps.
  template <class Visit>
  static void for_each_object(std::size_t which, [[maybe_unused]] EntryAccess<Device> entries, Visit&& visit) {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::is_dynamic(which)) return Mapped::for_each_object(which, entries, visit);
    }
    for (const auto row : Static::carriers) {
      if (Static::place_in(row) == which) visit(Static::key_in(row));
    }
  }

  /// Handles a SYNC: the TPDOs that wait for it are sent if `now` is set, otherwise they become due. Those of type 252
  /// sample their data. Returns false if any is due. `refresh(which)` is called before the values of a TPDO are read.
  template <Bus BusType, class Refresh = NoRefresh>
  [[nodiscard]] bool on_sync(ObjectStore<Device>& store, BusType& bus, Sync sync, bool now, Refresh refresh = {}) {
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = slots_[i];
      if (slot.type > last_cyclic) {
        if (!has_samples || slot.type != remote_synchronous) continue;
        refresh(i);
        sample(i, store);
      } else if (wants_sync(i, store.entries(), sync)) {
        if (now) refresh(i);
        now = now && send(slot, i, store, bus);
        slot.flags = static_cast<std::uint8_t>(now ? slot.flags & ~(changed_bit | due | asked) : slot.flags | due);
      }
    }
    return now;
  }

  /// Discards the TPDOs of the last SYNC, because the synchronous window has elapsed.
  void miss_sync() {
    for (Slot& slot : slots_) {
      if (slot.type <= last_cyclic) slot.flags &= static_cast<std::uint8_t>(~due);
    }
  }

  /// Handles a remote frame that requests the TPDO with this CAN-ID.
  void on_remote(EntryAccess<Device> entries, std::uint32_t can_id) {
    if (options_of<Device>(entries).tpdo_remote_frames) {
      for (std::size_t i = 0; i < count; ++i) {
        if (slots_[i].type != inactive && cob_id_of(i, entries) == can_id) slots_[i].flags |= asked;
      }
    }
  }

  /// Sends what is due. Returns false if the bus had no room; the rest remains due.
  template <Bus BusType, class Refresh = NoRefresh>
  bool serve(ObjectStore<Device>& store, BusType& bus, TimePoint now, Refresh refresh = {}) {
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = slots_[i];
      // A TPDO that waits for a SYNC: saves 7 instructions of a Cortex-M4, takes 12 bytes of a Cortex-M0+.
      if (!prefers_size && (slot.flags & (due | asked | timed | inhibited | event_driven)) == 0) continue;
      if (is_inhibited(slot, now) || (!wanted(slot) && !event_timer_expired(slot, now))) continue;
      const bool is_sampled = has_samples && slot.type == remote_synchronous;
      if (!is_sampled) refresh(i);
      if (!(is_sampled ? send_sample(slot, i, store, bus) : send(slot, i, store, bus))) return false;
      sent(slot, i, store.entries(), now);
    }
    return true;
  }

  /// Keeps the deadlines of TPDOs that the bus has no room for.
  void keep_deadlines([[maybe_unused]] TimePoint now) {
    if constexpr (has_event_timer || has_inhibit_time) {
      for (Slot& slot : slots_) {
        if (has_samples && (slot.flags & event_driven) == 0) continue;
        slot.times.event_due.keep(now);
        slot.times.inhibit_end.keep(now);
      }
    }
  }

  /// Returns when the next TPDO is to be sent, or an inhibit time ends; not later than `now` if one can already be
  /// sent.
  [[nodiscard]] std::optional<TimePoint> next_deadline(TimePoint now) const {
    std::optional<TimePoint> next;
    for (const Slot& slot : slots_) {
      if (!wanted(slot) && (slot.flags & (timed | inhibited)) == 0) continue;
      TimePoint at = now;
      if ((slot.flags & inhibited) != 0 && slot.times.inhibit_end.is_ahead(now)) {
        at = slot.times.inhibit_end.at();
      } else if (!wanted(slot) && !event_timer_expired(slot, now) && (slot.flags & timed) != 0) {
        at = slot.times.event_due.at();
      }
      next = next ? earlier_deadline(*next, at, now) : at;
    }
    return next;
  }

 private:
  /// Up to this number of TPDOs, `changed` is compiled for each of them: it is faster, but the number of functions is
  /// that of objects times that of TPDOs.
  static constexpr std::size_t few = 16;

  static constexpr std::uint8_t last_cyclic = 240;
  static constexpr std::uint8_t inactive = 251;  ///< not valid, not mapped, or the node is not Operational
  static constexpr std::uint8_t remote_synchronous = 252;
  static constexpr std::uint8_t first_event_driven = 254;
  static constexpr std::uint8_t event_driven_type = 255;  ///< of a TPDO without a transmission type

  template <std::uint8_t SubIndex>
  using Column = ParameterColumn<Device, Pdos, tpdo_indices.communication, SubIndex>;
  static constexpr bool has_inhibit_time = Column<pdo_parameter::inhibit_time>::exists;
  static constexpr bool has_event_timer = Column<pdo_parameter::event_timer>::exists;
  static constexpr bool has_sync_start = Column<pdo_parameter::sync_start>::exists;
  static constexpr bool has_samples = Device::options.tpdo_remote_frames && SyncConsumer<Device>::exists;

  using Data = std::array<std::uint8_t, 8>;
  using Slot = TpdoSlot;
  using enum TpdoSlot::Flag;

  /// Data bytes of TPDOs with static mapping.
  static constexpr std::array<std::uint8_t, count> sizes = Pdos::sizes;

  [[nodiscard]] static std::uint32_t cob_id_of(std::size_t i, EntryAccess<Device> entries) {
    return Column<pdo_parameter::cob_id>::get(entries, i, CobId::invalid_bit);
  }

  /// Returns one of the other parameters; 0 if it does not exist.
  template <std::uint8_t SubIndex>
  [[nodiscard]] static std::uint16_t parameter(std::size_t i, EntryAccess<Device> entries) {
    return static_cast<std::uint16_t>(Column<SubIndex>::get(entries, i, 0));
  }

  /// Looks up the mapping and returns its data bytes.
  std::uint8_t look_up(std::size_t i, [[maybe_unused]] EntryAccess<Device> entries) {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::is_dynamic(i)) return places_.look_up(i, entries, [](MappedObject) { return false; });
    }
    return sizes[i];
  }

  [[nodiscard]] static bool may_use(CobId cob_id, EntryAccess<Device> entries) {
    return with_sheet<Device>(entries,
                              [&](auto... of_node) { return may_be_used_by_pdo<Device>(cob_id, true, of_node...); });
  }

  void activate(std::size_t i, ObjectStore<Device>& store, TimePoint now) {
    Slot& slot = slots_[i];
    const EntryAccess<Device> entries = store.entries();
    slot.type = inactive;
    slot.size = look_up(i, entries);
    const CobId cob_id{cob_id_of(i, entries)};
    if (slot.size == 0 || !cob_id.valid() || !may_use(cob_id, entries)) return;
    slot.type = static_cast<std::uint8_t>(Column<pdo_parameter::transmission_type>::get(entries, i, event_driven_type));
    if (slot.type >= first_event_driven) {
      slot.flags |= event_driven;
      return start_event_timer(slot, i, entries, now);
    }
    slot.flags &= static_cast<std::uint8_t>(~inhibited);
    if (slot.type <= last_cyclic) {
      slot.syncs = slot.type;
      if (has_sync_start && parameter<pdo_parameter::sync_start>(i, entries) != 0) slot.flags |= before_start;
    } else if (slot.type == remote_synchronous) {
      sample(i, store);
    }
  }

  /// Whether a TPDO of types 0..240 is to be sent at this SYNC.
  [[nodiscard]] bool wants_sync(std::size_t i, EntryAccess<Device> entries, Sync sync) {
    Slot& slot = slots_[i];
    if (slot.type == 0) return (slot.flags & changed_bit) != 0 || !options_of<Device>(entries).tpdo_acyclic_on_change;
    if (has_sync_start && (slot.flags & before_start) != 0) {
      if (sync.counter != 0 && sync.counter != parameter<pdo_parameter::sync_start>(i, entries)) return false;
      slot.flags &= static_cast<std::uint8_t>(~before_start);
    }
    if (slot.syncs > 1) {
      --slot.syncs;
      return false;
    }
    slot.syncs = slot.type;
    return true;
  }

  /// Whether a TPDO is to be sent for any reason except its event timer.
  [[nodiscard]] bool wanted(const Slot& slot) const {
    if ((slot.flags & (due | asked)) != 0) return true;
    constexpr std::uint8_t event = event_driven | changed_bit;
    return sends_changes_.of_node && (slot.flags & event) == event;
  }

  static void start_event_timer(Slot& slot, std::size_t i, EntryAccess<Device> entries, TimePoint now) {
    slot.flags &= static_cast<std::uint8_t>(~timed);
    if ((slot.flags & event_driven) != 0) go_on_with_event_timer(slot, i, entries, now);
  }

  /// Sets the event timer to one period after the last time, so that it does not drift; to one period from now if that
  /// has passed or the timer was not running.
  [[gnu::noinline]] static void go_on_with_event_timer([[maybe_unused]] Slot& slot, [[maybe_unused]] std::size_t i,
                                                       [[maybe_unused]] EntryAccess<Device> entries,
                                                       [[maybe_unused]] TimePoint now) {
    if constexpr (has_event_timer) {
      const Duration period = from_milliseconds(parameter<pdo_parameter::event_timer>(i, entries));
      Deadline next = slot.times.event_due.at() + period;
      if ((slot.flags & timed) == 0 || !is_within(next.at(), period, now)) next = now + period;
      slot.times.event_due = next;
      slot.flags &= static_cast<std::uint8_t>(~timed);
      if (period.count() != 0) slot.flags |= timed;
    }
  }

  [[nodiscard]] static bool event_timer_expired(const Slot& slot, TimePoint now) {
    return has_event_timer && (slot.flags & timed) != 0 && slot.times.event_due.has_passed(now);
  }

  /// Whether the inhibit time is running; ends it if it has elapsed.
  [[nodiscard]] static bool is_inhibited(Slot& slot, TimePoint now) {
    if ((slot.flags & inhibited) == 0) return false;
    if (slot.times.inhibit_end.is_ahead(now)) return true;
    slot.flags &= static_cast<std::uint8_t>(~inhibited);
    return false;
  }

  template <Bus BusType>
  [[nodiscard]] bool send(const Slot& slot, std::size_t which, ObjectStore<Device>& store, BusType& bus) {
    const std::uint32_t cob_id = cob_id_of(which, store.entries());
    // Saves 212 bytes of a Cortex-M0+, takes 11 to 23 instructions of a Cortex-M4.
    if constexpr (prefers_size) {
      FrameWords words;
      pack(which, store, reinterpret_cast<Data&>(words));
      if (is_in(options_of<Device>(store).pdo_allowed_can_ids, cob_id)) {
        return send_words(bus, cob_id, slot.size, words.first, words.second);
      }
      return send_configured(bus, cob_id, slot.size, words.first, words.second);
    } else {
      if (!is_usable_by_pdo<Device>(cob_id, store)) return true;
      Frame frame;
      frame.id = cob_id & 0x1FFF'FFFF;
      frame.extended = (cob_id & CobId::extended_bit) != 0;
      frame.size = slot.size;
      pack(which, store, frame.data);
      return bus.send(frame);
    }
  }

  /// Sends the data of the last SYNC.
  template <Bus BusType>
  [[nodiscard]] bool send_sample(const Slot& slot, std::size_t which, ObjectStore<Device>& store, BusType& bus) {
    std::array<std::uint32_t, 2> sampled;
    std::memcpy(sampled.data(), &slot.times, sizeof sampled);
    return send_configured(bus, cob_id_of(which, store.entries()), slot.size, sampled[0], sampled[1]);
  }

  void sample([[maybe_unused]] std::size_t which, [[maybe_unused]] ObjectStore<Device>& store) {
    if constexpr (has_samples) {
      using Times = TpdoSlot::Times;  // whose bytes are written: type 252 does not use them as times
      static_assert(sizeof(Times) >= sizeof(Data) && alignof(Times) % 4 == 0 && std::is_trivially_copyable_v<Times>);
      slots_[which].times = {};
      pack(which, store, reinterpret_cast<Data&>(slots_[which].times));
    }
  }

  /// Writes the values of the mapped objects to data, which must be zero and aligned to four bytes.
  void pack(std::size_t which, ObjectStore<Device>& store, Data& data) const {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::is_dynamic(which)) return pack_mapped(which, store.entries(), data);
    }
    if constexpr (Mapped::any_static) Static::pack(which, store, data, Pdos{}, std::make_index_sequence<count>{});
  }

  void pack_mapped(std::size_t which, EntryAccess<Device> entries, Data& data) const {
    using Runs = typename Mapped::Runs;
    const auto* run = places_.of(which);
    for (unsigned at = 0, end = slots_[which].size * 8u / Runs::unit; at < end; ++run) {
      const unsigned length = Runs::length(*run);
      const auto offset = static_cast<entry::Word>(Runs::offset(*run));
      const std::uint8_t* const from = (*run & Runs::apart) == 0 ? entries.ram(offset) : entries.constant(offset);
      if constexpr (!Runs::has_bits) {
        copy_value(data.data() + at, from, length);
      } else if ((*run & Runs::nothing) != Runs::nothing) {
        put_bits(data.data(), at, length, take_bits(from, 0, length));
      }
      at += length;
    }
  }

  /// Starts the inhibit time, and the event timer again: from when it elapsed, so that the period does not drift,
  /// or from now.
  void sent(Slot& slot, std::size_t i, EntryAccess<Device> entries, TimePoint now) {
    slot.flags &= static_cast<std::uint8_t>(~(changed_bit | due | asked));
    if ((slot.flags & event_driven) == 0) return;
    if constexpr (has_inhibit_time) {
      const Duration inhibit =
          inhibit_duration(options_of<Device>(entries), parameter<pdo_parameter::inhibit_time>(i, entries));
      if (inhibit.count() != 0) slot.flags |= inhibited;
      slot.times.inhibit_end = now + inhibit;
    }
    go_on_with_event_timer(slot, i, entries, now);
  }

  struct Nothing {};
  /// The option event_driven_on_change.
  struct OfType {
    static constexpr bool of_node = has_sheet<Device> || Device::options.event_driven_on_change;
  };
  struct OfSheet {
    bool of_node = true;
  };

  std::array<Slot, count> slots_{};
  [[no_unique_address]] std::conditional_t<has_sheet<Device>, OfSheet, OfType> sends_changes_{};
  [[no_unique_address]] std::conditional_t<has_dynamic_mapping, Mapped, Nothing> places_{};
};

}  // namespace canopen
