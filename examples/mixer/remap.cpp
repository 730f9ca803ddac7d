/// A master opens the valves of a mixer with RPDO 1, loads a recipe, and gives TPDO 2 a new mapping.
#include <canopen/master.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>
#include <cstdio>
#include <string_view>

#include "mixer.hpp"

using Delivery = canopen::Tpdo<od::litres_delivered, od::zone_temperature<2>>;
static_assert(Delivery::bits == 48);

int main() {
  canopen::VirtualBus bus{500'000};
  auto& port = bus.attach();
  canopen::Node<MixerParts, canopen::VirtualBus::Endpoint> node{port, canopen::NodeId{5}};
  bus.connect(port, node);
  node.start(bus.now());

  canopen::VirtualBusPort master_port{bus};
  canopen::Master master{master_port};
  auto remote = master.remote<mixer::Device>(canopen::NodeId{5});

  if (!remote.write(od::recipe{}, std::string_view{"water, 40 deg"})) return 1;
  const auto refused = remote.write(od::recipe{}, std::string_view{"oil"});
  std::printf("oil: %s\n", std::string{to_text(refused.abort_code())}.c_str());

  if (const auto mapped = remote.map<2, Delivery>(); !mapped) return 2;
  od::litres_delivered::type litres{};
  od::zone_temperature<2>::type temperature{};
  const auto listening = remote.on_pdo<2, Delivery>([&](auto new_litres, auto new_temperature) {
    litres = new_litres;
    temperature = new_temperature;
  });
  if (!listening) return 3;

  if (!master.command(canopen::NmtCommand::start, canopen::NodeId{5})) return 4;
  node.application<Mixer>().litres = 12_l;
  const od::valve<1>::type closed = 0_percent, half_open = 50_percent;
  if (!remote.send<mixer::Rpdo1>(closed, closed, closed, half_open)) return 4;
  master.poll(canopen::from_milliseconds(10));
  std::printf("%.0f l, zone 2: %.1f °C\n", litres.in(), temperature.in());
  return litres == 12_l && temperature == 25_degC ? 0 : 5;
}
