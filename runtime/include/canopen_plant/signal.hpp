/// Signals of a plant as types: an entry of a TPDO of one node, and the entry of an RPDO of another one that receives
/// it. `edsc network generate` writes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/can/cob_id.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/pdo/pdo.hpp"
#include "canopen/pdo/pdo_compatible.hpp"

namespace canopen {

/// Whether two valid COB-IDs are those of the same frame. Bit 30 does not belong to the CAN-ID.
[[nodiscard]] constexpr bool is_same_frame(std::uint32_t producer, std::uint32_t consumer) {
  constexpr std::uint32_t identifier = 0x3FFF'FFFF;
  return CobId{producer}.valid() && CobId{consumer}.valid() && (producer & identifier) == (consumer & identifier);
}

/// A TPDO of a node and an RPDO of another one, both with `parameters` as configured: equal COB-IDs, and for each entry
/// of the RPDO an entry of the TPDO at the same bits, of the same kind. Does not compile otherwise; the compiler's
/// message names the PDOs with their nodes.
template <class Produced, class Consumed>
struct LinkedPdos {
  static_assert(is_same_frame(Produced::parameters.cob_id, Consumed::parameters.cob_id),
                "PDO link: the TPDO and the RPDO have different COB-IDs, or one of them is not valid");
  static constexpr bool hold = CompatiblePdos<Produced, Consumed>::hold;
};

/// Entry `Sent` of a TPDO (from 0), which is entry `Taken` of an RPDO.
template <class Produced, std::size_t Sent, class Consumed, std::size_t Taken>
struct LinkedEntry {
  using Tpdo = Produced;
  using Rpdo = Consumed;
  using sent_object = typename Produced::template Entry<Sent>;
  using taken_object = typename Consumed::template Entry<Taken>;
  /// The type of the receiver's object; that of the sender's if only this one has a meaning.
  using type = std::conditional_t<Meaningful<typename taken_object::type> || !Meaningful<typename sent_object::type>,
                                  typename taken_object::type, typename sent_object::type>;
  static_assert(std::is_same_v<RawOf<type>, RawOf<typename sent_object::type>> &&
                    std::is_same_v<RawOf<type>, RawOf<typename taken_object::type>>,
                "signal: the entry of the TPDO is of another type than that of the RPDO");
  static_assert(Produced::offsets[Sent] == Consumed::offsets[Taken] && sent_object::bits == taken_object::bits,
                "signal: the entry of the TPDO is at other bits than that of the RPDO");
};

/// A value that the master receives from node `Position` of the plant.
template <std::size_t Position, class Produced, std::size_t Sent, class Consumed, std::size_t Taken>
struct ReceivedSignal : LinkedEntry<Produced, Sent, Consumed, Taken> {
  static constexpr std::size_t node = Position;
  using object = typename Consumed::template Entry<Taken>;  ///< of the master
};

/// A value that the master sends to node `Position` of the plant.
template <std::size_t Position, class Produced, std::size_t Sent, class Consumed, std::size_t Taken>
struct SentSignal : LinkedEntry<Produced, Sent, Consumed, Taken> {
  static constexpr std::size_t node = Position;
  using object = typename Produced::template Entry<Sent>;     ///< of the master
  using receiver = typename Consumed::template Entry<Taken>;  ///< of the node, with its limits
};

template <class... Signals>
struct SignalList {
  static constexpr std::size_t count = sizeof...(Signals);

  template <class SignalType>
  static constexpr bool contains = (std::is_same_v<SignalType, Signals> || ...);

  /// Position of a signal in the list; `count` if it is not in it.
  template <class SignalType>
  static constexpr std::size_t position_of = [] {
    std::size_t position = 0;
    static_cast<void>(((std::is_same_v<SignalType, Signals> || (++position, false)) || ...));
    return position;
  }();

  template <template <class> class Slot>
  using Slots = std::tuple<Slot<Signals>...>;

  /// Calls `visit.template operator()<SignalType, Place>()` for each signal in order.
  template <class Visit>
  static constexpr void for_each([[maybe_unused]] Visit visit) {
    [&]<std::size_t... Place>(std::index_sequence<Place...>) { (visit.template operator()<Signals, Place>(), ...); }
    (std::index_sequence_for<Signals...>{});
  }
};

/// A signal that the master of a network receives.
template <class SignalType, class Network>
concept ReceivedBy = Network::Received::template contains<SignalType>;

/// A signal that the master of a network sends.
template <class SignalType, class Network>
concept SentBy = Network::Sent::template contains<SignalType>;

}  // namespace canopen
