/// Multiplex PDOs (CiA 301, 7.2.2.5): a PDO with one object of up to 32 bits, which its data identify.
///
///   byte 0        bit 7: 1 destination, 0 source addressing mode (DAM, SAM); bits 6..0: node-ID, in DAM 0 for all
///   bytes 1 to 3  index and sub-index: in DAM of the receiver's object, in SAM of the sender's
///   bytes 4 to 7  the value, low byte first, padded with zeros
///
/// A PDO is multiplexed if sub-index 0 of its mapping parameter is 254 (SAM) or 255 (DAM). Its transmission type is 254
/// or 255; an event timer has no effect. Only devices with the option `mpdo` have this code in their image.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "canopen/abort_code.hpp"
#include "canopen/cob_id.hpp"
#include "canopen/communication_parameters.hpp"
#include "canopen/frame.hpp"
#include "canopen/node_id.hpp"
#include "canopen/object_store.hpp"
#include "canopen/pdo_list.hpp"
#include "canopen/pdo_mapping.hpp"
#include "canopen/rpdo.hpp"
#include "canopen/time.hpp"
#include "canopen/transmission_type.hpp"

namespace canopen {

/// Destination of a DAM-MPDO: an object of one node, or of all nodes (node-ID 0).
struct MpdoDestination {
  NodeId node_id;
  std::uint16_t index;
  std::uint8_t sub_index;
};

/// The data bytes of an MPDO.
class Mpdo {
 public:
  using Data = std::array<std::uint8_t, 8>;

  /// `value`: one to four bytes.
  [[nodiscard]] static Data source(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                                   std::span<const std::uint8_t> value) {
    Data data{node_id.value(), static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), sub_index};
    std::memcpy(&data[4], value.data(), value.size());
    return data;
  }

  [[nodiscard]] static Data destination(const MpdoDestination& to, std::uint32_t value) {
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    Data data = source(to.node_id, to.index, to.sub_index, bytes);
    data[0] |= destination_bit;
    return data;
  }

  explicit Mpdo(const Data& data) : data_{data} {}

  [[nodiscard]] bool addresses_destination() const { return (data_[0] & destination_bit) != 0; }
  [[nodiscard]] std::uint8_t node_id() const { return data_[0] & 0x7F; }
  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(data_[1] | data_[2] << 8); }
  [[nodiscard]] std::uint8_t sub_index() const { return data_[3]; }
  [[nodiscard]] const std::uint8_t* value() const { return &data_[4]; }

 private:
  static constexpr std::uint8_t destination_bit = 0x80;

  const Data& data_;
};

/// An element of an object scanner list, 1FA0h..1FCFh: objects of this device that are sent as SAM-MPDOs.
struct ScannedObjects {
  static constexpr std::uint16_t first_list = 0x1FA0;
  static constexpr std::uint16_t last_list = 0x1FCF;
  using Value = std::uint32_t;

  Value value;

  /// Number of consecutive sub-indices. A block of size 0 contains one object.
  [[nodiscard]] std::uint8_t size() const { return (value >> 24) != 0 ? static_cast<std::uint8_t>(value >> 24) : 1; }
  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(value >> 8); }
  [[nodiscard]] std::uint8_t sub_index() const { return static_cast<std::uint8_t>(value); }
};

/// An element of an object dispatching list, 1FD0h..1FFFh: destination of the values of received SAM-MPDOs.
struct DispatchedObjects {
  static constexpr std::uint16_t first_list = 0x1FD0;
  static constexpr std::uint16_t last_list = 0x1FFF;
  using Value = std::uint64_t;

  Value value;

  [[nodiscard]] std::uint8_t size() const { return (value >> 56) != 0 ? static_cast<std::uint8_t>(value >> 56) : 1; }
  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(value >> 40); }
  [[nodiscard]] std::uint8_t sub_index() const { return static_cast<std::uint8_t>(value >> 32); }
  [[nodiscard]] std::uint16_t sender_index() const { return static_cast<std::uint16_t>(value >> 16); }
  [[nodiscard]] std::uint8_t sender_sub_index() const { return static_cast<std::uint8_t>(value >> 8); }
  [[nodiscard]] std::uint8_t sender() const { return static_cast<std::uint8_t>(value); }

  /// Whether an MPDO contains one of the objects; `offset()` is its position.
  [[nodiscard]] bool match(const Mpdo& mpdo) const {
    return sender() == mpdo.node_id() && sender_index() == mpdo.index() && mpdo.sub_index() >= sender_sub_index() &&
           offset(mpdo) < size();
  }
  [[nodiscard]] unsigned offset(const Mpdo& mpdo) const {
    return static_cast<unsigned>(mpdo.sub_index() - sender_sub_index());
  }
};

/// All lists of one kind, `ScannedObjects` or `DispatchedObjects`, that a dictionary has.
template <class Device, class Element>
class MpdoLists {
 public:
  [[nodiscard]] static constexpr bool contain(std::uint16_t index) {
    return index >= Element::first_list && index <= Element::last_list;
  }

  /// Returns how many elements an object can contain; 0: none, or it does not have the type of CiA 301.
  [[nodiscard]] static constexpr std::uint8_t capacity(std::uint16_t index) {
    const entry::Word count = Device::dictionary.find(index, 0);
    if (count <= Dictionary::no_sub_index || entry::wire_bytes(count) != 1) return 0;
    std::uint8_t capacity = 0;
    while (capacity < 254) {
      const entry::Word next = Device::dictionary.find(index, static_cast<std::uint8_t>(capacity + 1));
      if (next <= Dictionary::no_sub_index || entry::wire_bytes(next) != sizeof(typename Element::Value)) break;
      ++capacity;
    }
    return capacity;
  }

  static constexpr std::size_t room = [] {
    std::size_t sum = 0;
    for (unsigned index = Element::first_list; index <= Element::last_list; ++index) {
      sum += capacity(static_cast<std::uint16_t>(index));
    }
    return sum;
  }();

  /// Calls `visit(element, index, sub_index)`, with its position in the list, for each element that is not empty, up to
  /// the number in sub-index 0 of its list.
  template <class Visit>
  static void for_each(EntryAccess<Device> entries, Visit&& visit) {
    for (const List& list : lists) {
      const std::uint32_t used = entries.number(list.count);
      for (std::uint32_t i = 0; i < used && list.begin + i < list.end; ++i) {
        std::array<std::uint8_t, 8> scratch;
        Element element{};
        std::memcpy(&element.value, entries.read(words[list.begin + i], scratch).data(), sizeof element.value);
        if (element.value != 0) visit(element, list.index, static_cast<std::uint8_t>(i + 1));
      }
    }
  }

 private:
  struct List {
    entry::Word count;
    std::uint16_t index;
    std::uint16_t begin;  ///< position of its first element among all
    std::uint16_t end;
  };

  static constexpr std::size_t list_count = [] {
    std::size_t count = 0;
    for (unsigned index = Element::first_list; index <= Element::last_list; ++index) {
      count += capacity(static_cast<std::uint16_t>(index)) != 0 ? 1 : 0;
    }
    return count;
  }();

  static constexpr std::array<List, list_count> lists = [] {
    std::array<List, list_count> rows{};
    std::size_t i = 0;
    std::size_t begin = 0;
    for (unsigned at = Element::first_list; at <= Element::last_list; ++at) {
      const auto index = static_cast<std::uint16_t>(at);
      const std::size_t end = begin + capacity(index);
      if (end == begin) continue;
      rows[i++] = {Device::dictionary.find(index, 0), index, static_cast<std::uint16_t>(begin),
                   static_cast<std::uint16_t>(end)};
      begin = end;
    }
    return rows;
  }();

  static constexpr std::array<entry::Word, room> words = [] {
    std::array<entry::Word, room> rows{};
    for (const List& list : lists) {
      for (std::size_t i = list.begin; i < list.end; ++i) {
        rows[i] = Device::dictionary.find(list.index, static_cast<std::uint8_t>(i - list.begin + 1));
      }
    }
    return rows;
  }();
};

/// The PDOs of one direction that are MPDOs or can become one by SDO; `Pdos` is the device's list. With a static
/// mapping, a PDO is an MPDO if it does not have a layout.
template <class Device, PdoIndices Indices, class Pdos>
class MultiplexedPdos {
  template <class Pdo>
  [[nodiscard]] static constexpr bool may_be() {
    constexpr std::uint16_t mapping = Indices.mapping + Pdo::number - 1;
    if (!Device::options.mpdo) return false;
    if (!Device::dictionary.has(Indices.communication + Pdo::number - 1, pdo_parameter::cob_id)) return false;
    if (entry::wire_bytes(Device::dictionary.find(mapping, 0)) != 1) return false;
    return Pdo::entries == 0 || mapping_capacity(Device::dictionary, mapping) != 0;
  }

 public:
  /// Location of its parameters; 0 or 1 is one that does not exist.
  struct Parameters {
    std::uint16_t number;
    entry::Word mapped_objects;
    entry::Word cob_id;
    entry::Word transmission_type;
    entry::Word inhibit_time;
  };

  static constexpr std::size_t count = [] {
    std::size_t sum = 0;
    Pdos::for_each([&]<class Pdo, std::size_t>() { sum += may_be<Pdo>() ? 1 : 0; });
    return sum;
  }();

  static constexpr std::array<Parameters, count> rows = [] {
    std::array<Parameters, count> found{};
    std::size_t i = 0;
    Pdos::for_each([&]<class Pdo, std::size_t>() {
      constexpr std::uint16_t index = Indices.communication + Pdo::number - 1;
      const Dictionary& dictionary = Device::dictionary;
      if (!may_be<Pdo>()) return;
      found[i++] = {Pdo::number, dictionary.find(Indices.mapping + Pdo::number - 1, 0),
                    dictionary.find(index, pdo_parameter::cob_id),
                    dictionary.find(index, pdo_parameter::transmission_type),
                    dictionary.find(index, pdo_parameter::inhibit_time)};
    });
    return found;
  }();

  /// Returns the one with this communication or mapping parameter; null if it cannot be an MPDO.
  [[nodiscard]] static const Parameters* with_parameter(std::uint16_t index) {
    for (const Parameters& row : rows) {
      if (((static_cast<unsigned>(row.number - 1) ^ index) & 0x1FF) == 0) return &row;
    }
    return nullptr;
  }

  /// Returns `source_multiplexed`, `destination_multiplexed`, or the number of mapped objects.
  [[nodiscard]] static std::uint32_t mode(EntryAccess<Device> entries, const Parameters& row) {
    return entries.number(row.mapped_objects);
  }

  [[nodiscard]] static bool event_driven(EntryAccess<Device> entries, const Parameters& row) {
    return row.transmission_type <= Dictionary::no_sub_index ||
           transmission_of(entries.number(row.transmission_type)) == Transmission::event_driven;
  }

  /// Returns the first usable one with this mode; null if there is none.
  [[nodiscard]] static const Parameters* find(EntryAccess<Device> entries, std::uint8_t wanted) {
    for (const Parameters& row : rows) {
      if (mode(entries, row) == wanted && is_usable(entries.number(row.cob_id)) && event_driven(entries, row)) {
        return &row;
      }
    }
    return nullptr;
  }
};

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
  using Rpdos = MultiplexedPdos<Device, rpdo_indices, typename Device::Rpdos>;
  using Tpdos = MultiplexedPdos<Device, tpdo_indices, typename Device::Tpdos>;
  using Scanned = MpdoLists<Device, ScannedObjects>;
  using Dispatched = MpdoLists<Device, DispatchedObjects>;

  [[nodiscard]] static constexpr bool carries(entry::Word word, entry::Word direction) {
    const std::uint8_t bytes = entry::wire_bytes(word);
    return word > Dictionary::no_sub_index && (word & direction) != 0 && bytes >= 1 && bytes <= 4;
  }

  /// Number of objects that a SAM-MPDO can contain.
  static constexpr std::size_t scannable = [] {
    std::size_t count = 0;
    if (!Device::options.mpdo) return count;
    Device::dictionary.for_each_entry(
        [&](std::uint16_t, std::uint8_t, entry::Word word) { count += carries(word, entry::tpdo) ? 1 : 0; });
    return count;
  }();

 public:
  static constexpr bool receives = Rpdos::count > 0;
  static constexpr bool sends_destination = Tpdos::count > 0;
  static constexpr bool sends_source = sends_destination && Scanned::room > 0 && scannable > 0;
  static constexpr bool exists = receives || sends_destination;

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
  template <Bus B>
  bool serve([[maybe_unused]] EntryAccess<Device> entries, [[maybe_unused]] NodeId own, [[maybe_unused]] B& bus,
             [[maybe_unused]] TimePoint now) {
    // Inhibit times end here even if no MPDO is waiting: later, the end would seem to be ahead again.
    if constexpr (sends_destination) {
      if (destination_.inhibit.over(now) && destination_.waiting != 0 && !serve_destination(entries, bus, now))
        return false;
    }
    if constexpr (sends_source) {
      if (source_.inhibit.over(now) && any_pending() && !serve_source(entries, own, bus, now)) return false;
    }
    return true;
  }

  /// Returns when the next MPDO is to be sent; not later than `now` if one is already waiting.
  [[nodiscard]] std::optional<TimePoint> next_deadline([[maybe_unused]] TimePoint now) const {
    std::optional<TimePoint> next;
    if constexpr (sends_destination) {
      if (destination_.waiting != 0) next = destination_.inhibit.earliest(now);
    }
    if constexpr (sends_source) {
      if (any_pending() && (!next || source_.inhibit.earliest(now) < *next)) next = source_.inhibit.earliest(now);
    }
    return next;
  }

  // Parameters

  /// Checks whether these bytes, whose length is correct, may be written to 1000h..1FFFh, in addition to the checks of
  /// other PDOs.
  ///   0604 0042h  254 or 255 mapped objects in a PDO of another transmission type, 254 without a list, or a second SAM
  ///               producer (or the abort code of the device options); a scanner list with more objects than there are
  ///   0609 0030h  another transmission type for an MPDO, or more elements than the list can contain
  ///   0604 0041h  an element of a list is an object that does not exist, cannot be mapped or has more than 32 bits
  [[nodiscard]] static AbortCode check(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                       std::span<const std::uint8_t> bytes) {
    if (is_rpdo_communication(index) || is_rpdo_mapping(index)) {
      return check_pdo<Rpdos>(entries, index, sub_index, bytes[0]);
    }
    if (is_tpdo_communication(index) || is_tpdo_mapping(index)) {
      return check_pdo<Tpdos>(entries, index, sub_index, bytes[0]);
    }
    if constexpr (sends_source) {
      if (Scanned::contain(index)) return check_scanned(entries, index, sub_index, bytes);
    }
    if constexpr (receives && Dispatched::room > 0) {
      if (Dispatched::contain(index))
        return check_list<Dispatched, DispatchedObjects>(index, sub_index, bytes, entry::rpdo);
    }
    return ok;
  }

 private:
  /// The inhibit time of a TPDO.
  struct Inhibit {
    TimePoint end{};
    bool runs = false;

    /// Whether an MPDO may be sent now.
    [[nodiscard]] bool over(TimePoint now) {
      if (runs && !is_ahead(end, Device::options.inhibit_time_unit, now)) runs = false;
      return !runs;
    }
    void start(EntryAccess<Device> entries, entry::Word word, TimePoint now) {
      if (word <= Dictionary::no_sub_index) return;
      const Duration time = inhibit_duration(Device::options, static_cast<std::uint16_t>(entries.number(word)));
      runs = time.count() != 0;
      end = now + time;
    }
    [[nodiscard]] TimePoint earliest(TimePoint now) const {
      return runs && is_ahead(end, Device::options.inhibit_time_unit, now) ? end : now;
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
    if (!carries(word, entry::rpdo)) return false;
    alignas(4) std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), value, bytes.size());
    host.take(index, sub_index, std::span{bytes}.first(entry::wire_bytes(word)));
    return true;
  }

  // Producers

  template <Bus B>
  [[nodiscard]] static bool send(EntryAccess<Device> entries, const typename Tpdos::Parameters& tpdo,
                                 const Mpdo::Data& data, B& bus) {
    const CobId cob_id{entries.number(tpdo.cob_id)};
    Frame frame{};
    frame.id = cob_id.can_id();
    frame.extended = cob_id.extended();
    frame.size = 8;
    frame.data = data;
    return bus.send(frame);
  }

  template <Bus B>
  bool serve_destination(EntryAccess<Device> entries, B& bus, TimePoint now) {
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

  template <Bus B>
  bool serve_source(EntryAccess<Device> entries, NodeId own, B& bus, TimePoint now) {
    const auto* const tpdo = Tpdos::find(entries, source_multiplexed);
    if (tpdo == nullptr) source_.pending = {};
    while (any_pending() && source_.inhibit.over(now)) {
      const std::size_t place = next_pending();
      const ScannedObjects object = scanned_at(entries, place);
      const entry::Word word = entries.find(object.index(), object.sub_index());
      if (carries(word, entry::tpdo)) {
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

  // Parameters

  template <class Pdos>
  [[nodiscard]] static AbortCode check_pdo(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                           std::uint8_t value) {
    const auto* const row = Pdos::with_parameter(index);
    if (row == nullptr) return ok;
    const bool mapping = is_rpdo_mapping(index) || is_tpdo_mapping(index);
    if (mapping && sub_index == 0 && value >= source_multiplexed) {
      const bool possible = value == destination_multiplexed || check_source<Pdos>(entries, *row);
      if (possible && Pdos::event_driven(entries, *row)) return ok;
      return static_cast<AbortCode>(Device::options.pdo_mapping_abort_code);
    }
    if (!mapping && sub_index == pdo_parameter::transmission_type && Pdos::mode(entries, *row) >= source_multiplexed) {
      return transmission_of(value) == Transmission::event_driven ? ok : AbortCode::invalid_value;
    }
    return ok;
  }

  /// Whether a PDO can become a SAM-MPDO.
  template <class Pdos>
  [[nodiscard]] static bool check_source(EntryAccess<Device> entries, const typename Pdos::Parameters& wanted) {
    if constexpr (std::is_same_v<Pdos, Rpdos>) return Dispatched::room > 0;
    for (const auto& row : Pdos::rows) {
      if (row.number != wanted.number && Pdos::mode(entries, row) == source_multiplexed) return false;
    }
    return sends_source;
  }

  template <class Lists, class Element>
  [[nodiscard]] static AbortCode check_list(std::uint16_t index, std::uint8_t sub_index,
                                            std::span<const std::uint8_t> bytes, entry::Word direction) {
    const std::uint8_t capacity = Lists::capacity(index);
    if (sub_index == 0) return bytes[0] <= capacity ? ok : AbortCode::invalid_value;
    if (sub_index > capacity) return ok;
    Element element{};
    std::memcpy(&element.value, bytes.data(), sizeof element.value);
    for (unsigned i = 0; element.value != 0 && i < element.size(); ++i) {
      const unsigned at = element.sub_index() + i;
      if (at > 0xFF) return AbortCode::not_mappable;
      const entry::Word word = Device::dictionary.find(element.index(), static_cast<std::uint8_t>(at));
      if (!carries(word, direction)) return AbortCode::not_mappable;
    }
    return ok;
  }

  [[nodiscard]] static AbortCode check_scanned(EntryAccess<Device> entries, std::uint16_t index, std::uint8_t sub_index,
                                               std::span<const std::uint8_t> bytes) {
    const AbortCode code = check_list<Scanned, ScannedObjects>(index, sub_index, bytes, entry::tpdo);
    if (code != ok || sub_index == 0 || sub_index > Scanned::capacity(index)) return code;
    ScannedObjects element{};
    std::memcpy(&element.value, bytes.data(), sizeof element.value);
    std::size_t objects = element.value != 0 ? element.size() : 0;
    Scanned::for_each(entries, [&](ScannedObjects block, std::uint16_t list, std::uint8_t at) {
      if (list != index || at != sub_index) objects += block.size();
    });
    return objects <= scannable ? ok : AbortCode::pdo_length;
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
