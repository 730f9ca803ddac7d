// expect: position .*ReceivedBy
// A handler for a signal that the master sends.
#include <canopen_plant/plant.hpp>
#include <every_type/device.hpp>

namespace od = every_type::od;

namespace line {
template <std::uint32_t CobId>
struct Tpdo : canopen::Tpdo<od::unsigned16_value> {
  static constexpr std::uint16_t number = 1;
  static constexpr auto parameters = canopen::PdoParameters{.cob_id = CobId};
};
template <std::uint32_t CobId>
struct Rpdo : canopen::Rpdo<od::unsigned16_value> {
  static constexpr std::uint16_t number = 1;
  static constexpr auto parameters = canopen::PdoParameters{.cob_id = CobId};
};
namespace signals {
struct position : canopen::SentSignal<0, Tpdo<0x201>, 0, Rpdo<0x201>, 0> {};
struct speed : canopen::ReceivedSignal<0, Tpdo<0x181>, 0, Rpdo<0x181>, 0> {};
}  // namespace signals
struct Network {
  using Master = every_type::Device;
  static constexpr canopen::NodeId master_id{127};
  static constexpr canopen::NmtStartUp start_up{};
  static constexpr std::array<canopen::PlantNode, 1> nodes{{{"axis", canopen::NodeId{1}}}};
  static constexpr std::array<canopen::NmtSlave, 1> slaves{{{canopen::NodeId{1}, 0x5}}};
  using Received = canopen::SignalList<signals::speed>;
  using Sent = canopen::SignalList<signals::position>;
  template <class Plant>
  struct Nodes {
    explicit Nodes(Plant&) {}
  };
};
}  // namespace line

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

void listen(canopen::Plant<line::Network, Bus>& plant) {
#ifdef GOOD
  plant.on(line::signals::speed{}, [](std::uint16_t) {});
#else
  plant.on(line::signals::position{}, [](std::uint16_t) {});
#endif
}
