/// An encoder of CiA 406 as one object: a node, the measured values, and the sensor that the user writes.
///
///     struct Sensor {
///       std::int32_t position();  // measuring steps
///       std::int16_t speed();
///     };
///     canopen::cia406::EncoderNode<rk5c::Device, Bus, Sensor> encoder{bus, canopen::NodeId{5}};
///     encoder.on_time(now);  // at next_deadline(), and as often as the position is to be measured
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/node.hpp"
#include "canopen/profile/cia406.hpp"
#include "canopen/profile/profile_node.hpp"

namespace canopen::cia406 {

/// `Parts`: a device or a composition. `Handlers`: further parts of the node, such as an application class or a
/// storage.
template <class Parts, Bus BusType, class Sensor, class... Handlers>
class EncoderNode : public ProfileNode<EncoderNode<Parts, BusType, Sensor, Handlers...>> {
  friend ProfileNode<EncoderNode>;
  using Device = composition_detail::DeviceOf<Parts>;

 public:
  constexpr EncoderNode(BusType& bus, NodeId node_id, Handlers... handlers)
      : node_{bus, node_id, Written{&encoder_}, std::move(handlers)...} {}

  /// Measures, and sends what is due.
  void on_time(TimePoint now) {
    encoder_.measured(node_, sensor_.position(), sensor_.speed());
    node_.on_time(now);
  }

  [[nodiscard]] Sensor& sensor() { return sensor_; }
  [[nodiscard]] Encoder<Device>& encoder() { return encoder_; }
  [[nodiscard]] auto& node() { return node_; }
  [[nodiscard]] const auto& node() const { return node_; }

 private:
  void after_event(TimePoint) {}

  template <class Object>
  static constexpr bool is_preset = (Object::index == 0x6010 && Object::sub_index == 1) || Object::index == 0x6003;
  static_assert(Device::dictionary.has(0x6010, 1) || Device::dictionary.has(0x6003, 0),
                "the device of an encoder has a preset value, 6003h or 6010h:01");
  static constexpr bool has_timers = Device::dictionary.has(0x6200, 0) && Device::dictionary.has(0x1800, 5);

  /// The preset value changes the offset; the cyclic timer 6200h and the event timer of TPDO 1 stay equal.
  struct Written {
    Encoder<Device>* encoder;

    template <DictionaryObject Object>
    requires is_preset<Object>
    void written(Object, const typename Object::type& value) {
      encoder->preset(static_cast<std::int32_t>(to_raw(value)));
    }

    template <DictionaryObject Object>
    requires(has_timers&& Object::index == 0x6200) void written(Object, const typename Object::type& value,
                                                                auto& node) {
      cia406_detail::Copy<0x1800, 5>{}(node, to_raw(value));
    }
    template <DictionaryObject Object>
    requires(has_timers&& Object::index == 0x1800 &&
             Object::sub_index == 5) void written(Object, const typename Object::type& value, auto& node) {
      cia406_detail::Copy<0x6200, 0>{}(node, to_raw(value));
    }
  };

  Sensor sensor_{};
  Encoder<Device> encoder_{};
  composition_detail::NodeWith<Parts, BusType, composition_detail::Types<Written>, Handlers...> node_;
};

}  // namespace canopen::cia406
