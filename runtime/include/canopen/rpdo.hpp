/// The PDOs that a device receives (CiA 301, 7.2.2).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/cob_id.hpp"
#include "canopen/communication_parameters.hpp"
#include "canopen/frame.hpp"
#include "canopen/mapped_places.hpp"
#include "canopen/object_store.hpp"
#include "canopen/parameter_column.hpp"
#include "canopen/pdo.hpp"
#include "canopen/pdo_list.hpp"
#include "canopen/sync.hpp"
#include "canopen/time.hpp"
#include "canopen/transmission_type.hpp"

namespace canopen {

/// What happens to an RPDO, by its number from 1.
enum class RpdoEvent : std::uint8_t {
  taken,         ///< its values have been taken over
  too_short,     ///< a frame has fewer bytes than are mapped; nothing was taken
  timeout,       ///< no frame has come for its event timer
  length_right,  ///< the first good frame after one that was too short
  in_time,       ///< the first good frame after a timeout
};

/// All RPDOs of one device, with the parameters of 1400h and following as they are at the moment. Those of types 254
/// and 255 are taken over at once, those of types 0..240 at the next SYNC. Of a frame longer than the mapping the first
/// bytes are used, a shorter one is not taken. With an event timer (sub-index 5, ms) an RPDO is missed when it stays
/// away for longer, from its first frame on.
///
/// A service asks the node around it (`host`, a reference to it that is copied freely):
///   entries(), now()
///   operational()                            a handler may end that
///   window_over()                            whether those of types 0..240 come too late
///   take<O>(value)                           a value for an object, where the mapping is static
///   take(index, sub_index, bytes)            the same for one known by number
///   happened(event, number)
template <class Device>
class RpdoService {
 public:
  using Pdos = ServedPdos<Device::dictionary, rpdo_indices, typename Device::Rpdos>;
  using Mapped = MappedPlaces<Device, rpdo_indices, Pdos>;
  static constexpr std::size_t count = Pdos::count;
  static constexpr bool has_dynamic_mapping = Mapped::any;

  /// `watched(mapped)` says of an object whether more has to be done with its value than to store it.
  template <class Watched>
  void enter_operational(EntryAccess<Device> entries, Watched watched) {
    for (std::size_t i = 0; i < count; ++i) activate(i, entries, watched);
  }

  /// A communication or mapping parameter, 1400h..17FFh, has a new value, which counts at once.
  template <class Watched>
  void parameter_changed(EntryAccess<Device> entries, std::uint16_t index, Watched watched) {
    const std::size_t i = place_of_pdo<Pdos>(index);
    if (i != count) activate(i, entries, watched);
  }

  /// The mapping of a TPDO has changed: other objects are watched now.
  template <class Watched>
  void watch_again([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] Watched watched) {
    if constexpr (has_dynamic_mapping) {
      for (std::size_t i = 0; i < count; ++i) {
        if (Mapped::capacities[i] != 0) slots_[i].size = look_up(i, entries, watched);
      }
    }
  }

  /// Takes a frame for each RPDO that it is.
  template <class Host>
  void on_frame(const Frame& frame, Host host) {
    const std::uint32_t cob_id = cob_id_of(frame);
    for (std::size_t i = 0; i < count; ++i) {
      // An RPDO's bit 30 means nothing; no frame has bit 31.
      const std::uint32_t own = Column<pdo_parameter::cob_id>::get(host.entries(), i, CobId::invalid_bit);
      if ((own & ~CobId::no_rtr_bit) == cob_id) receive(i, frame, host);
    }
  }

  /// A SYNC has come: what has been received since the last one counts now.
  template <class Host>
  void on_sync(Host host) {
    for (std::size_t i = 0; i < count && host.operational(); ++i) {
      if ((slots_[i].flags & buffered) == 0) continue;
      slots_[i].flags &= static_cast<std::uint8_t>(~buffered);
      Frame frame;
      frame.data = slots_[i].data;
      take(i, frame, host);
    }
  }

  /// Tells of those that have stayed away.
  template <class Host>
  void on_time([[maybe_unused]] Host host) {
    if constexpr (has_event_timer) {
      for (std::size_t i = 0; i < count && host.operational(); ++i) check_deadline(i, host);
    }
  }

  /// When the next one will have stayed away for too long.
  [[nodiscard]] std::optional<TimePoint> next_deadline() const {
    std::optional<TimePoint> next;
    if constexpr (has_event_timer) {
      for (const Slot& slot : slots_) {
        if ((slot.flags & monitored) != 0 && (!next || slot.deadline < *next)) next = slot.deadline;
      }
    }
    return next;
  }

  /// Whether an RPDO is in this condition now: `too_short` or `timeout`.
  [[nodiscard]] bool any(RpdoEvent condition) const {
    const std::uint8_t flag = condition == RpdoEvent::too_short ? cut_short : missed;
    for (const Slot& slot : slots_) {
      if ((slot.flags & flag) != 0) return true;
    }
    return false;
  }

 private:
  enum Flag : std::uint8_t {
    buffered = 1,   ///< data wait for a SYNC
    cut_short = 2,  ///< the last frame was too short
    monitored = 4,  ///< deadline counts
    missed = 8,     ///< the deadline has passed
  };

  using Data = std::array<std::uint8_t, 8>;

  static constexpr std::array<std::uint8_t, count> sizes = [] {
    std::array<std::uint8_t, count> rows{};
    Pdos::for_each([&]<class Pdo, std::size_t I>() { rows[I] = Pdo::size; });
    return rows;
  }();

  template <std::uint8_t SubIndex>
  using Column = ParameterColumn<Device, Pdos, rpdo_indices.communication, SubIndex>;
  static constexpr bool has_event_timer = Column<pdo_parameter::event_timer>::exists;
  static constexpr std::uint32_t event_unit = from_milliseconds(1).count();

  struct NoTime {};
  struct Slot {
    alignas(4) Data data;
    [[no_unique_address]] std::conditional_t<has_event_timer, TimePoint, NoTime> deadline;
    std::uint8_t flags;
    std::uint8_t size;  ///< data bytes that are mapped
  };

  [[nodiscard]] static std::uint16_t number_of(std::size_t i) { return number_of_pdo<Pdos>(i); }

  template <class Watched>
  void activate(std::size_t i, EntryAccess<Device> entries, Watched watched) {
    slots_[i] = {};
    slots_[i].size = look_up(i, entries, watched);
  }

  template <class Watched>
  std::uint8_t look_up(std::size_t i, [[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] Watched watched) {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::capacities[i] != 0) {
        const std::uint8_t size = places_.look_up(i, entries);
        if (size != 0) mark_watched(i, entries, watched);
        return size;
      }
    }
    return sizes[i];
  }

  /// Marks those objects for which more is to be done than to store a value.
  template <class Watched>
  [[gnu::noinline]] void mark_watched(std::size_t i, EntryAccess<Device> entries, Watched watched) {
    const MappingParameter mapping = Mapped::parameter(i, entries);
    auto* const places = places_.of(i);
    for (std::size_t object = 0; object < mapping.count(); ++object) {
      if (watched(mapping[object])) places[object] = static_cast<typename Mapped::Place>(places[object] | Mapped::mark);
    }
  }

  template <class Host>
  [[gnu::noinline]] void receive(std::size_t i, const Frame& frame, Host host) {
    Slot& slot = slots_[i];
    if (slot.size == 0) return;
    if (frame.size < slot.size) return cut(i, host);
    if ((slot.flags & (cut_short | monitored | missed)) != 0) settle(i, host);
    start_deadline(i, host);
    const Transmission transmission = transmission_type(i, host.entries());
    if (transmission == Transmission::synchronous && !host.window_over()) {
      slot.data = frame.data;
      slot.flags |= buffered;
    }
    if (transmission == Transmission::event_driven) take(i, frame, host);
  }

  /// A frame is too short.
  template <class Host>
  void cut(std::size_t i, Host host) {
    const bool first = (slots_[i].flags & cut_short) == 0;
    slots_[i].flags |= cut_short;
    if (first) host.happened(RpdoEvent::too_short, number_of(i));
  }

  /// A good frame ends what was wrong, and the time that it has taken.
  template <class Host>
  void settle(std::size_t i, Host host) {
    end(i, cut_short, RpdoEvent::length_right, host);
    check_deadline(i, host);
    end(i, missed, RpdoEvent::in_time, host);
    slots_[i].flags &= static_cast<std::uint8_t>(~monitored);
  }

  /// Tells that a condition is over, if it was there.
  template <class Host>
  void end(std::size_t i, std::uint8_t condition, RpdoEvent event, Host host) {
    if ((slots_[i].flags & condition) == 0) return;
    slots_[i].flags &= static_cast<std::uint8_t>(~condition);
    host.happened(event, number_of(i));
  }

  /// Tells of one that has stayed away.
  template <class Host>
  void check_deadline([[maybe_unused]] std::size_t i, [[maybe_unused]] Host host) {
    if constexpr (has_event_timer) {
      if ((slots_[i].flags & monitored) == 0 || is_ahead(slots_[i].deadline, event_unit, host.now())) return;
      slots_[i].flags = static_cast<std::uint8_t>((slots_[i].flags & ~monitored) | missed);
      host.happened(RpdoEvent::timeout, number_of(i));
    }
  }

  template <class Host>
  void start_deadline([[maybe_unused]] std::size_t i, [[maybe_unused]] Host host) {
    if constexpr (has_event_timer) {
      const auto time = static_cast<std::uint16_t>(Column<pdo_parameter::event_timer>::get(host.entries(), i, 0));
      if (time == 0) return;
      slots_[i].flags |= monitored;
      slots_[i].deadline = host.now() + from_milliseconds(time);
    }
  }

  [[nodiscard]] static Transmission transmission_type(std::size_t i, EntryAccess<Device> entries) {
    constexpr std::uint32_t event_driven = 255;
    return transmission_of(Column<pdo_parameter::transmission_type>::get(entries, i, event_driven));
  }

  template <class Host>
  void take(std::size_t which, const Frame& frame, Host host) {
    if constexpr (has_dynamic_mapping) {
      if (Mapped::capacities[which] != 0) take_mapped(which, frame.data, host);
    }
    take_static(which, frame, host, Pdos{}, std::make_index_sequence<count>{});
    host.happened(RpdoEvent::taken, number_of(which));
  }

  template <class Host, class... Pdo, std::size_t... I>
  static void take_static([[maybe_unused]] std::size_t which, [[maybe_unused]] const Frame& frame,
                          [[maybe_unused]] const Host& host, PdoList<Pdo...>, std::index_sequence<I...>) {
    (take_if<Pdo, Mapped::capacities[I] == 0>(which == I, frame, host), ...);
  }

  template <class Pdo, bool IsStatic, class Host>
  static void take_if([[maybe_unused]] bool it_is, [[maybe_unused]] const Frame& frame, [[maybe_unused]] Host host) {
    if constexpr (IsStatic) {
      if (it_is) take_objects<Pdo>(frame, host, std::make_index_sequence<Pdo::entries>{});
    }
  }

  template <class Pdo, class Host, std::size_t... I>
  static void take_objects([[maybe_unused]] const Frame& frame, [[maybe_unused]] Host host, std::index_sequence<I...>) {
    (take_object<typename Pdo::template Entry<I>>(Pdo::template get<I>(frame), host), ...);
  }

  template <class O, class Host>
  static void take_object([[maybe_unused]] const typename O::type& value, [[maybe_unused]] Host host) {
    if constexpr (!is_dummy<O>) host.template take<O>(value);
  }

  template <class Host>
  void take_mapped(std::size_t which, const Data& data, Host host) {
    const EntryAccess<Device> entries = host.entries();
    const MappingParameter mapping = Mapped::parameter(which, entries);
    const auto* const places = places_.of(which);
    const std::size_t objects = mapping.count();
    unsigned at = 0;
    for (std::size_t i = 0; i < objects; ++i) {
      const unsigned bits = mapping.bits(i);
      const auto place = places[i];
      const bool whole_bytes = !Mapped::has_bits || ((at | bits) & 7) == 0;
      if (whole_bytes && (place & Mapped::mark) == 0) {
        copy_value(entries.ram(place), data.data() + at / 8, bits / 8);
      } else if (place != Mapped::no_place) {  // no dummy
        take_watched(mapping[i], data, at, host);
      }
      at += bits;
    }
  }

  template <class Host>
  [[gnu::noinline]] static void take_watched(MappedObject mapped, const Data& data, unsigned at, Host host) {
    alignas(8) std::array<std::uint8_t, 8> bytes;
    if constexpr (Mapped::has_bits) {
      const std::uint64_t value = take_bits(data.data(), at, mapped.bits());
      std::memcpy(bytes.data(), &value, sizeof value);
    } else {
      copy_value(bytes.data(), data.data() + at / 8, mapped.bits() / 8u);
    }
    host.take(mapped.index(), mapped.sub_index(), std::span{bytes}.first((mapped.bits() + 7u) / 8u));
  }

  std::array<Slot, count> slots_{};
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<has_dynamic_mapping, Mapped, Nothing> places_{};
};

}  // namespace canopen
