/// The multiplex PDOs of a device: which frames they take, and when they are sent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"
#include "canopen/pdo/communication_parameters.hpp"
#include "canopen/pdo/mpdo.hpp"
#include "canopen/pdo/mpdo_check.hpp"
#include "canopen/pdo/mpdo_lists.hpp"
#include "canopen/pdo/multiplexed_pdos.hpp"
#include "canopen/pdo/pdo_mapping.hpp"
#include "canopen/pdo/rpdo.hpp"

namespace canopen {

/// All MPDOs of one device, with the present values of their parameters and lists.
///
///   DAM consumer  writes the object of this device that the frame names. If no RPDO-mappable object exists there, the
///                 error 8230h is reported; it ends with the next frame for an existing one.
///   DAM producer  sends what the application passes to it
///   SAM producer  sends each object of the object scanner list that has a new value. A device has one.
///   SAM consumer  writes the objects that the object dispatching list assigns to the sender's object
///
/// Objects of more than 32 bits are not supported. Functions of the node that the service calls (`host`):
///   take(index, sub_index, bytes)   a received value
///   happened(event, number)         `taken`, `too_short` or `length_right`
///   destination_missing(missing)    the error 8230h begins or ends
template <class Device>
class MpdoService {
  using Features = MpdoFeatures<Device>;
  using Tpdos = typename Features::Tpdos;
  using Rpdos = typename Features::Rpdos;
  using Scanned = typename Features::Scanned;
  using Dispatched = typename Features::Dispatched;
  static constexpr std::size_t scannable = Features::scannable;

 public:
  static constexpr bool receives = Features::receives;
  static constexpr bool sends_destination = Features::sends_destination;
  static constexpr bool sends_source = Features::sends_source;
  static constexpr bool exists = Features::exists;

  /// Maximum number of waiting DAM-MPDOs.
  static constexpr std::size_t depth = 4;

  /// Clears pending MPDOs and error conditions.
  void enter_operational() { *this = MpdoService{}; }

  // Consumers

  /// Passes a frame to every MPDO that receives it.
  template <class Host>
  void on_frame([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] const Frame& frame,
                [[maybe_unused]] NodeId own, [[maybe_unused]] Host&& host) {
    if constexpr (receives) {
      for (const auto& row : Rpdos::rows) {
        const std::uint32_t mode = Rpdos::mode(entries, row);
        if (mode < source_multiplexed || !Rpdos::event_driven(entries, row)) continue;
        if ((entries.number(row.cob_id) & ~CobId::no_rtr_bit) != cob_id_of(frame)) continue;
        if (!right_length(frame.size >= 8, row.number, host)) continue;
        const Mpdo mpdo{frame.data};
        if (mpdo.addresses_destination() != (mode == destination_multiplexed)) continue;
        const bool taken = mpdo.addresses_destination() ? take_destination(entries, mpdo, own, host)
                                                        : take_source(entries, mpdo, host);
        if (taken) host.happened(RpdoEvent::taken, row.number);
      }
    }
  }

  /// Whether the last MPDO was too short.
  [[nodiscard]] bool too_short() const {
    if constexpr (receives) return consumer_.too_short;
    return false;
  }
  /// Whether the object of the last DAM-MPDO for this node does not exist.
  [[nodiscard]] bool destination_missing() const {
    if constexpr (receives) return consumer_.destination_missing;
    return false;
  }

  // Producers

  /// Marks an object that has a new value. Returns whether it is to be sent.
  bool changed([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] std::uint16_t index,
               [[maybe_unused]] std::uint8_t sub_index) {
    if constexpr (sends_source) {
      if (Scanned::contain(index)) source_.pending = {};  // the positions of the objects have changed
      if (!Device::triggers_event(index, sub_index)) return false;
      if (Tpdos::find(entries, source_multiplexed) == nullptr) return false;
      std::size_t first = 0;
      bool found = false;
      Scanned::for_each(entries, [&](ScannedObjects block, std::uint16_t, std::uint8_t) {
        const unsigned offset = static_cast<unsigned>(sub_index) - block.sub_index();
        if (!found && block.index() == index && offset < block.size()) found = mark(first + offset);
        first += block.size();
      });
      return found;
    }
    return false;
  }

  /// Queues a DAM-MPDO. Returns false if this device does not have a valid DAM-TPDO now, or `depth` of them
  /// are waiting.
  [[nodiscard]] bool put(EntryAccess<Device> entries, const MpdoDestination& to, std::uint32_t value) {
    static_assert(sends_destination, "no TPDO of this device is a multiplex PDO or can be made one");
    if (destination_.waiting == depth || Tpdos::find(entries, destination_multiplexed) == nullptr) return false;
    destination_.queue[destination_.waiting++] = Mpdo::destination(to, value);
    return true;
  }

  /// Sends pending MPDOs. Returns false if the bus had no room; they remain pending.
  template <Bus BusType>
  bool serve([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] NodeId own, [[maybe_unused]] BusType& bus,
             [[maybe_unused]] TimePoint now) {
    // Inhibit times end here even if no MPDO is waiting.
    if constexpr (sends_destination) {
      if (destination_.inhibit.over(now) && destination_.waiting != 0 && !serve_destination(entries, bus, now))
        return false;
    }
    if constexpr (sends_source) {
      if (source_.inhibit.over(now) && any_pending() && !serve_source(entries, own, bus, now)) return false;
    }
    return true;
  }

  /// Ends the inhibit times that have elapsed.
  void keep_deadlines([[maybe_unused]] TimePoint now) {
    if constexpr (sends_destination) static_cast<void>(destination_.inhibit.over(now));
    if constexpr (sends_source) static_cast<void>(source_.inhibit.over(now));
  }

  /// Returns when the next MPDO is to be sent, or an inhibit time ends; not later than `now` if one can already be
  /// sent.
  [[nodiscard]] std::optional<TimePoint> next_deadline([[maybe_unused]] TimePoint now) const {
    std::optional<TimePoint> next;
    if constexpr (sends_destination) next = destination_.inhibit.next_deadline(destination_.waiting != 0, now);
    if constexpr (sends_source) {
      const std::optional<TimePoint> other = source_.inhibit.next_deadline(any_pending(), now);
      if (other) next = next ? earlier_deadline(*next, *other, now) : *other;
    }
    return next;
  }

 private:
  /// The inhibit time of a TPDO.
  struct Inhibit {
    Deadline end{};
    bool runs = false;

    /// Whether an MPDO may be sent now.
    [[nodiscard]] bool over(TimePoint now) {
      runs = runs && end.is_ahead(now);
      return !runs;
    }
    void start(EntryAccess<Device> entries, entry::Word word, TimePoint now) {
      if (word <= Dictionary::no_sub_index) return;
      const Duration time = inhibit_duration(Device::options, static_cast<std::uint16_t>(entries.number(word)));
      runs = time.count() != 0;
      end = now + time;
    }
    [[nodiscard]] std::optional<TimePoint> next_deadline(bool waiting, TimePoint now) const {
      if (runs) return end.at();
      return waiting ? std::optional{now} : std::nullopt;
    }
  };

  struct Consumer {
    bool too_short = false;
    bool destination_missing = false;
  };
  struct DestinationProducer {
    std::array<Mpdo::Data, depth> queue{};
    std::size_t waiting = 0;
    Inhibit inhibit{};
  };
  struct SourceProducer {
    std::array<std::uint32_t, (scannable + 31) / 32> pending{};  ///< by the object's position in the scanner lists
    std::size_t next = 0;  ///< start of the next search, so that each object has its turn
    Inhibit inhibit{};
  };

  // Consumers

  template <class Host>
  [[nodiscard]] bool right_length(bool right, std::uint16_t number, Host& host) {
    if (right == consumer_.too_short) {
      consumer_.too_short = !right;
      host.happened(right ? RpdoEvent::length_right : RpdoEvent::too_short, number);
    }
    return right;
  }

  template <class Host>
  bool take_destination(EntryAccess<Device> entries, const Mpdo& mpdo, NodeId own, Host& host) {
    if (mpdo.node_id() != 0 && mpdo.node_id() != own.value()) return false;
    const bool found = take(entries, mpdo.index(), mpdo.sub_index(), mpdo.value(), host);
    if (found == consumer_.destination_missing) {
      consumer_.destination_missing = !found;
      host.destination_missing(!found);
    }
    return found;
  }

  template <class Host>
  static bool take_source(EntryAccess<Device> entries, const Mpdo& mpdo, Host& host) {
    bool taken = false;
    if constexpr (Dispatched::room > 0) {
      Dispatched::for_each(entries, [&](const DispatchedObjects& block, std::uint16_t, std::uint8_t) {
        if (!block.match(mpdo)) return;
        const auto sub_index = static_cast<std::uint8_t>(block.sub_index() + block.offset(mpdo));
        if (take(entries, block.index(), sub_index, mpdo.value(), host)) taken = true;
      });
    }
    return taken;
  }

  /// Writes a received value. Returns false if an MPDO cannot write this object.
  template <class Host>
  static bool take(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index, const std::uint8_t* value,
                   Host& host) {
    const entry::Word word = entries.find(index, sub_index);
    if (!Features::carries(word, entry::rpdo)) return false;
    alignas(4) std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), value, bytes.size());
    host.take(index, sub_index, std::span{bytes}.first(entry::wire_bytes(word)));
    return true;
  }

  // Producers

  template <Bus BusType>
  [[nodiscard]] static bool send(EntryAccess<Device> entries, const typename Tpdos::Parameters& tpdo,
                                 const Mpdo::Data& data, BusType& bus) {
    const CobId cob_id{entries.number(tpdo.cob_id)};
    Frame frame{};
    frame.id = cob_id.can_id();
    frame.extended = cob_id.extended();
    frame.size = 8;
    frame.data = data;
    return bus.send(frame);
  }

  template <Bus BusType>
  bool serve_destination(EntryAccess<Device> entries, BusType& bus, TimePoint now) {
    const auto* const tpdo = Tpdos::find(entries, destination_multiplexed);
    if (tpdo == nullptr) destination_.waiting = 0;
    while (destination_.waiting != 0 && destination_.inhibit.over(now)) {
      if (!send(entries, *tpdo, destination_.queue[0], bus)) return false;
      --destination_.waiting;
      for (std::size_t i = 0; i < destination_.waiting; ++i) destination_.queue[i] = destination_.queue[i + 1];
      destination_.inhibit.start(entries, tpdo->inhibit_time, now);
    }
    return true;
  }

  template <Bus BusType>
  bool serve_source(EntryAccess<Device> entries, NodeId own, BusType& bus, TimePoint now) {
    const auto* const tpdo = Tpdos::find(entries, source_multiplexed);
    if (tpdo == nullptr) source_.pending = {};
    while (any_pending() && source_.inhibit.over(now)) {
      const std::size_t place = next_pending();
      const ScannedObjects object = scanned_at(entries, place);
      const entry::Word word = entries.find(object.index(), object.sub_index());
      if (Features::carries(word, entry::tpdo)) {
        std::array<std::uint8_t, 8> scratch;
        const auto data = Mpdo::source(own, object.index(), object.sub_index(), entries.read(word, scratch));
        if (!send(entries, *tpdo, data, bus)) return false;
        source_.inhibit.start(entries, tpdo->inhibit_time, now);
      }
      source_.pending[place / 32] &= ~(std::uint32_t{1} << place % 32);
      source_.next = place + 1;
    }
    return true;
  }

  /// Marks the object at a position. Lists with duplicate or non-existing objects can have more positions than bits.
  [[nodiscard]] bool mark(std::size_t place) {
    if (place >= source_.pending.size() * 32) return false;
    source_.pending[place / 32] |= std::uint32_t{1} << place % 32;
    return true;
  }

  [[nodiscard]] bool any_pending() const {
    std::uint32_t any = 0;
    for (const std::uint32_t bits : source_.pending) any |= bits;
    return any != 0;
  }

  /// Returns the position of a pending object, from `next` on and then from the beginning.
  [[nodiscard]] std::size_t next_pending() const {
    std::size_t place = source_.next;
    for (;; ++place) {
      if (place >= source_.pending.size() * 32) place = 0;
      if ((source_.pending[place / 32] >> place % 32 & 1) != 0) return place;
    }
  }

  /// Returns the object at a position in the scanner lists, as a block of one.
  [[nodiscard]] static ScannedObjects scanned_at(EntryAccess<Device> entries, std::size_t place) {
    ScannedObjects object{};
    std::size_t first = 0;
    Scanned::for_each(entries, [&](ScannedObjects block, std::uint16_t, std::uint8_t) {
      if (place >= first && place - first < block.size()) {
        object.value = (block.value & 0x00FF'FFFF) + static_cast<std::uint32_t>(place - first);
      }
      first += block.size();
    });
    return object;
  }

  struct NoConsumer {};
  struct NoDestinationProducer {};
  struct NoSourceProducer {};

  [[no_unique_address]] std::conditional_t<receives, Consumer, NoConsumer> consumer_{};
  [[no_unique_address]] std::conditional_t<sends_destination, DestinationProducer, NoDestinationProducer>
      destination_{};
  [[no_unique_address]] std::conditional_t<sends_source, SourceProducer, NoSourceProducer> source_{};
};

}  // namespace canopen
