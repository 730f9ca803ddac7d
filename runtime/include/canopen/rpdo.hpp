/// The PDOs that a device receives (CiA 301, 7.2.2).
#pragma once

#include <cstdint>

#include "canopen/cob_id.hpp"
#include "canopen/communication_parameters.hpp"
#include "canopen/frame.hpp"
#include "canopen/object_store.hpp"
#include "canopen/pdo.hpp"
#include "canopen/pdo_list.hpp"
#include "canopen/transmission_type.hpp"

namespace canopen {

/// All RPDOs of one device. Those of types 254 and 255 are taken over at once. A frame shorter than the mapping is not
/// taken; of a longer one the first bytes are.
template <class Device>
class RpdoService {
 public:
  using Pdos = ServedPdos<Device::dictionary, rpdo_communication, typename Device::Rpdos>;
  static constexpr std::size_t count = Pdos::count;

  /// Gives the values of a frame to `take.template operator()<O>(value)`, object by object, for each RPDO that the
  /// frame is.
  template <class Take>
  static void on_frame(const ObjectStore<Device>& store, const Frame& frame, Take&& take) {
    Pdos::for_each([&]<class Pdo, std::size_t>() {
      constexpr std::uint16_t index = rpdo_communication + Pdo::number - 1;
      const std::uint32_t cob_id = store.template number<index, pdo_parameter::cob_id>();
      if ((cob_id & ~CobId::no_rtr_bit) != cob_id_of(frame))
        return;  // an RPDO's bit 30 means nothing; no frame has bit 31
      if (frame.size < Pdo::size) return;
      if (event_driven<index>(store)) unpack<Pdo>(frame, take);
    });
  }

 private:
  template <std::uint16_t Index>
  [[nodiscard]] static bool event_driven([[maybe_unused]] const ObjectStore<Device>& store) {
    if constexpr (Device::dictionary.has(Index, pdo_parameter::transmission_type)) {
      return transmission_of(store.template number<Index, pdo_parameter::transmission_type>()) ==
             Transmission::event_driven;
    } else {
      return true;
    }
  }

  template <class Pdo, class Take>
  static void unpack(const Frame& frame, Take& take) {
    Pdo::for_each([&]<class O, std::size_t I>() {
      if constexpr (!is_dummy<O>) take.template operator()<O>(Pdo::template get<I>(frame.data));
    });
  }
};

}  // namespace canopen
