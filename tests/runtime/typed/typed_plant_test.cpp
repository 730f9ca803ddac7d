#include <gtest/gtest.h>

#include <canopen_plant/plant.hpp>

#include <array>
#include <cstdint>
#include <type_traits>

#include <typed_drive/device.hpp>
#include <untyped_drive/device.hpp>
#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::NodeId;
using canopen::raw;
using namespace canopen::literals;
namespace od = typed_drive::od;
namespace own = untyped_drive::od;

template <template <class...> class Direction, class Object, std::uint32_t CobId>
struct Linked : Direction<Object> {
  static constexpr std::uint16_t number = 1;
  static constexpr auto parameters = canopen::PdoParameters{.cob_id = CobId};
};
template <class... Objects>
using Sends = canopen::Tpdo<Objects...>;
template <class... Objects>
using Receives = canopen::Rpdo<Objects...>;

/// A master whose own objects are numbers, and a node whose objects have a meaning.
struct Network {
  using Master = untyped_drive::Device;
  struct Setpoint
      : canopen::SentSignal<0, Linked<Sends, own::setpoint, 0x201>, 0, Linked<Receives, od::setpoint, 0x201>, 0> {};
  struct Mode : canopen::SentSignal<0, Linked<Sends, own::heater_state, 0x202>, 0,
                                    Linked<Receives, od::heater_state, 0x202>, 0> {};
  struct Temperature : canopen::ReceivedSignal<0, Linked<Sends, od::temperature, 0x181>, 0,
                                               Linked<Receives, own::setpoint, 0x181>, 0> {};
  static constexpr NodeId master_id{std::uint8_t{127}};
  static constexpr canopen::NmtStartUp start_up{};
  static constexpr std::array<canopen::PlantNode, 1> nodes{{{"heater", NodeId{std::uint8_t{1}}}}};
  static constexpr std::array<canopen::NmtSlave, 1> slaves{{{NodeId{std::uint8_t{1}}, 0x5}}};
  using Received = canopen::SignalList<Temperature>;
  using Sent = canopen::SignalList<Setpoint, Mode>;
  template <class Plant>
  struct Nodes {
    explicit Nodes(Plant&) {}
  };
};

static_assert(std::is_same_v<Network::Temperature::type, od::temperature::type>);
static_assert(std::is_same_v<Network::Setpoint::type, od::setpoint::type>);
static_assert(Network::nodes.size() == Network::slaves.size());

TEST(TypedPlant, SendsValuesOfTheNodesObjects) {
  bench::RecordingBus bus;
  canopen::Plant<Network, bench::RecordingBus> plant{bus};
  plant.set(Network::Setpoint{}, 21.5_degC);
  EXPECT_EQ(plant.device().get(own::setpoint{}), 215);
  EXPECT_TRUE(plant.get(Network::Setpoint{}) == 21.5_degC);
  EXPECT_EQ(plant.set(Network::Setpoint{}, od::setpoint::type{90.1_degC}), AbortCode::value_too_high);
  EXPECT_EQ(plant.set(Network::Setpoint{}, raw(std::int16_t{300})), canopen::ok);
  EXPECT_TRUE(plant.get(Network::Setpoint{}) == 30_degC);
  EXPECT_EQ(plant.set(Network::Mode{}, od::heater_state::value::cooling), canopen::ok);
  EXPECT_EQ(plant.set(Network::Mode{}, static_cast<od::heater_state::value>(3)), AbortCode::invalid_value);
  EXPECT_EQ(plant.get(Network::Mode{}), od::heater_state::value::cooling);
}

TEST(TypedPlant, HasNoValueBeforeTheFirstPdo) {
  bench::RecordingBus bus;
  canopen::Plant<Network, bench::RecordingBus> plant{bus};
  od::temperature::type last{};
  plant.on(Network::Temperature{}, [&](od::temperature::type value) { last = value; });
  EXPECT_FALSE(plant.get(Network::Temperature{}));
}

}  // namespace
