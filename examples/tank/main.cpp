/// A tank on a simulated bus, with its node-ID from switches and two DOMAINs; a master reads it and gets its EMCY.
#include <array>
#include <canopen/master.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "tank.hpp"

using namespace canopen::literals;
using Bus = canopen::VirtualBus::Endpoint;
using TankNode = canopen::Node<TankParts, Bus, canopen::BoundTo<od::store_eds>, canopen::BoundTo<od::volume_table>>;

/// In flash; a device has the file that edsc check accepts.
constexpr std::string_view eds = "[FileInfo]\nFileName=tank.eds\n";
constexpr auto eds_bytes = [] {
  std::array<std::uint8_t, eds.size()> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(eds[i]);
  return bytes;
}();

/// Empty at power-on; a master writes it.
std::array<std::uint8_t, 42> volumes;

int main() {
  canopen::VirtualBus bus{500'000};
  auto& port = bus.attach();

  const canopen::NodeId node_id{board.switches};
  if (!node_id.valid()) return 1;  // 0, or above 127

  TankNode node{port, canopen::bound_to<od::volume_table>(volumes, 0)};
  bus.connect(port, node);
  node.bind_constant(od::store_eds{}, eds_bytes);
  node.start(node_id, bus.now());

  canopen::VirtualBusPort master_port{bus};
  canopen::Master master{master_port};
  canopen::EmergencyMessage last{};
  int emergencies = 0;
  master.on_emergency = [&](canopen::NodeId, const canopen::EmergencyMessage& message) {
    last = message;
    ++emergencies;
    std::printf("EMCY %04Xh, 1001h %02Xh\n", unsigned{message.code}, unsigned(message.error_register));
  };

  if (!master.command(canopen::NmtCommand::start, node_id)) return 2;
  board.sensor = 1.9_m;
  master.poll(canopen::from_milliseconds(200));
  if (emergencies != 1 || last.code != 0xFF01 || !board.run_led || board.error_led) return 3;
  board.sensor = 1.2_m;
  master.poll(canopen::from_milliseconds(200));
  if (emergencies != 2 || last.code != 0) return 4;

  auto remote = master.remote<tank::Device>(node_id);
  const auto level = remote.read(od::level{});
  if (!level || *level != 1.2_m) return 5;
  const auto uploaded = master.upload(node_id, od::store_eds::index, 0);
  if (!uploaded || uploaded.value().size() != eds.size()) return 6;
  const std::array<std::uint8_t, 4> table{0x00, 0x00, 0x64, 0x00};
  if (!master.download(node_id, od::volume_table::index, 0, table)) return 7;
  return volumes[2] == 0x64 ? 0 : 8;
}
