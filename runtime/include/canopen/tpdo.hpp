/// The PDOs that a device sends (CiA 301, 7.2.2): when, and with which data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "canopen/cob_id.hpp"
#include "canopen/communication_parameters.hpp"
#include "canopen/frame.hpp"
#include "canopen/object_store.hpp"
#include "canopen/pdo.hpp"
#include "canopen/pdo_list.hpp"
#include "canopen/time.hpp"
#include "canopen/transmission_type.hpp"

namespace canopen {

/// All TPDOs of one device. Event-driven ones (types 254 and 255) are sent when a mapped object has changed, when the
/// event timer has run out, and once on entering Operational; never sooner after the last time than the inhibit time
/// says. Parameters are those of 1800h and following, as they are at the moment.
template <class Device>
class TpdoService {
 public:
  using Pdos = ServedPdos<Device::dictionary, tpdo_communication, typename Device::Tpdos>;
  static constexpr std::size_t count = Pdos::count;

  void enter_operational(const EntryAccess& entries, TimePoint now) {
    for (std::size_t i = 0; i < count; ++i) {
      slots_[i].flags = 0;
      activate(i, entries, now);
      if (Device::options.event_driven_on_change) slots_[i].flags |= pending;
    }
  }

  void leave_operational() {
    for (Slot& slot : slots_) slot.flags = 0;
  }

  /// `O` has a new value: those that carry it are to be sent. False when none does.
  template <DictionaryObject O>
  bool changed() {
    if constexpr (!Device::options.event_driven_on_change) return false;
    bool carried = false;
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      if constexpr (Pdo::template maps<O>) {
        slots_[I].flags |= pending;
        carried = true;
      }
    });
    return carried;
  }

  /// The same for an object known by number only.
  void changed(std::uint16_t index, std::uint8_t sub_index) {
    if constexpr (!Device::options.event_driven_on_change) return;
    const std::uint32_t key = object_key(index, sub_index);
    for (const std::uint32_t row : carriers) {
      if (row >> 8 == key) slots_[row & 0xFF].flags |= pending;
    }
  }

  /// A communication parameter, 1800h..19FFh, has a new value, which counts at once.
  void parameter_changed(const EntryAccess& entries, std::uint16_t index, std::uint8_t sub_index, TimePoint now) {
    for (std::size_t i = 0; i < count; ++i) {
      if (parameters[i].index != index) continue;
      if (sub_index == pdo_parameter::event_timer) {
        start_event_timer(i, entries, now);
      } else if (sub_index != pdo_parameter::inhibit_time) {
        slots_[i].flags &= static_cast<std::uint8_t>(inhibited);
        activate(i, entries, now);
      }
    }
  }

  /// Sends what is due. False when the bus had no room: it stays due.
  template <Bus B>
  bool serve(ObjectStore<Device>& store, B& bus, TimePoint now) {
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = slots_[i];
      if ((slot.flags & inhibited) != 0 && now >= slot.inhibit_end) slot.flags &= static_cast<std::uint8_t>(~inhibited);
      if ((slot.flags & active) == 0 || (slot.flags & inhibited) != 0) continue;
      if ((slot.flags & pending) == 0 && !event_timer_expired(slot, now)) continue;
      if (!send(i, store, bus)) return false;
      sent(i, store.entries(), now);
    }
    return true;
  }

  /// When the next one is to be sent; a moment not after `now` when one waits already.
  [[nodiscard]] std::optional<TimePoint> next_deadline(TimePoint now) const {
    std::optional<TimePoint> next;
    for (const Slot& slot : slots_) {
      if ((slot.flags & active) == 0 || (slot.flags & (pending | timed)) == 0) continue;
      TimePoint due = (slot.flags & pending) != 0 ? now : slot.event_due;
      if ((slot.flags & inhibited) != 0 && slot.inhibit_end > due) due = slot.inhibit_end;
      if (!next || due < *next) next = due;
    }
    return next;
  }

 private:
  enum Flag : std::uint8_t {
    active = 1,     ///< valid and event-driven
    pending = 2,    ///< to be sent as soon as the inhibit time allows
    timed = 4,      ///< event_due counts
    inhibited = 8,  ///< inhibit_end counts
  };

  struct NoTime {};
  static constexpr bool has_parameter(std::uint8_t sub_index) {
    bool has = false;
    Pdos::for_each([&]<class Pdo, std::size_t>() {
      has = has || Device::dictionary.has(tpdo_communication + Pdo::number - 1, sub_index);
    });
    return has;
  }
  static constexpr bool has_inhibit_time = has_parameter(pdo_parameter::inhibit_time);
  static constexpr bool has_event_timer = has_parameter(pdo_parameter::event_timer);

  struct Slot {
    TimePoint event_due;
    TimePoint inhibit_end;
    std::uint8_t flags;
  };

  /// Where the parameters of a TPDO are; 0 or 1 stand for one that does not exist.
  struct Parameters {
    std::uint16_t index;
    entry::Word cob_id;
    entry::Word transmission_type;
    entry::Word inhibit_time;
    entry::Word event_timer;
  };

  static constexpr std::array<Parameters, count> parameters = [] {
    std::array<Parameters, count> rows{};
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      constexpr std::uint16_t index = tpdo_communication + Pdo::number - 1;
      const Dictionary& dictionary = Device::dictionary;
      rows[I] = {index, dictionary.find(index, pdo_parameter::cob_id),
                 dictionary.find(index, pdo_parameter::transmission_type),
                 dictionary.find(index, pdo_parameter::inhibit_time),
                 dictionary.find(index, pdo_parameter::event_timer)};
    });
    return rows;
  }();

  static constexpr std::size_t mapped_objects = [] {
    std::size_t sum = 0;
    Pdos::for_each([&]<class Pdo, std::size_t>() { sum += Pdo::entries; });
    return sum;
  }();

  /// index << 16 | sub-index << 8 | position of the TPDO, for each mapped object.
  static constexpr std::array<std::uint32_t, mapped_objects> carriers = [] {
    static_assert(count <= 0x100);
    std::array<std::uint32_t, mapped_objects> rows{};
    std::size_t at = 0;
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      Pdo::for_each([&]<class O, std::size_t>() {
        rows[at++] = (object_key(O::index, O::sub_index) << 8) | static_cast<std::uint32_t>(I);
      });
    });
    return rows;
  }();

  [[nodiscard]] static std::uint16_t parameter(const EntryAccess& entries, entry::Word word) {
    return word > Dictionary::no_sub_index ? static_cast<std::uint16_t>(entries.number(word)) : std::uint16_t{0};
  }

  void activate(std::size_t i, const EntryAccess& entries, TimePoint now) {
    if (!CobId{entries.number(parameters[i].cob_id)}.valid()) return;
    switch (transmission_of(parameter_or_event_driven(entries, parameters[i].transmission_type))) {
      case Transmission::event_driven:
        slots_[i].flags |= active;
        start_event_timer(i, entries, now);
        break;
      case Transmission::synchronous:
      case Transmission::remote_synchronous:
      case Transmission::remote:
      case Transmission::reserved: break;
    }
  }

  [[nodiscard]] static std::uint16_t parameter_or_event_driven(const EntryAccess& entries, entry::Word word) {
    return word > Dictionary::no_sub_index ? static_cast<std::uint16_t>(entries.number(word)) : std::uint16_t{255};
  }

  void start_event_timer([[maybe_unused]] std::size_t i, [[maybe_unused]] const EntryAccess& entries,
                         [[maybe_unused]] TimePoint from) {
    if constexpr (has_event_timer) {
      const Duration period = from_milliseconds(parameter(entries, parameters[i].event_timer));
      slots_[i].flags &= static_cast<std::uint8_t>(~timed);
      if (period.count() != 0) slots_[i].flags |= timed;
      slots_[i].event_due = from + period;
    }
  }

  [[nodiscard]] static bool event_timer_expired(const Slot& slot, TimePoint now) {
    return has_event_timer && (slot.flags & timed) != 0 && now >= slot.event_due;
  }

  template <Bus B>
  [[nodiscard]] static bool send(std::size_t which, ObjectStore<Device>& store, B& bus) {
    const CobId cob_id{store.entries().number(parameters[which].cob_id)};
    Frame frame{};
    frame.id = cob_id.can_id();
    frame.extended = cob_id.extended();
    Pdos::for_each([&]<class Pdo, std::size_t I>() {
      if (I == which) pack<Pdo>(frame, store);
    });
    return bus.send(frame);
  }

  template <class Pdo>
  static void pack(Frame& frame, const ObjectStore<Device>& store) {
    frame.size = Pdo::size;
    Pdo::for_each([&]<class O, std::size_t I>() { Pdo::template put<I>(frame.data, store.template get<O>()); });
  }

  /// The inhibit time begins, and the event timer starts again: from when it ran out, so that the period does not
  /// drift, or from now.
  void sent(std::size_t i, const EntryAccess& entries, TimePoint now) {
    Slot& slot = slots_[i];
    slot.flags &= static_cast<std::uint8_t>(~pending);
    if constexpr (has_inhibit_time) {
      const Duration inhibit = from_hundred_microseconds(parameter(entries, parameters[i].inhibit_time));
      if (inhibit.count() != 0) slot.flags |= inhibited;
      slot.inhibit_end = now + inhibit;
    }
    if constexpr (has_event_timer) {
      start_event_timer(i, entries, event_timer_expired(slot, now) ? slot.event_due : now);
      if (event_timer_expired(slot, now)) start_event_timer(i, entries, now);
    }
  }

  std::array<Slot, count> slots_{};
};

}  // namespace canopen
