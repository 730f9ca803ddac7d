/// Tests `vm_node` with the SDO client of the runtime over sockets: `vm_client BUS NODE-ID`. Exit code 0: passed.
#include <canopen/host/blocking_sdo.hpp>
#include <canopen/host/host_bus.hpp>
#include <cstdio>
#include <cstdlib>
#include <every_service/device.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace od = every_service::od;

namespace {

constexpr std::size_t file_bytes = 20'000;

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error{what};
}

std::vector<std::uint8_t> some_file() {
  std::vector<std::uint8_t> bytes(file_bytes);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return bytes;
}

void talk(canopen::HostBus& bus, canopen::NodeId id, bool blocks) {
  canopen::BlockingSdo sdo{bus, {.timeout = std::chrono::seconds{60}, .block_transfer = blocks}};
  auto node = sdo.remote<every_service::Device>(id);
  const auto name = node.read<od::manufacturer_device_name>();
  require(name && name->view() == "Every service", "the device name");
  require(bool{node.write<od::word>(std::uint16_t{0x1234})}, "a number is written");
  const auto word = node.read<od::word>();
  require(word && *word == 0x1234, "and read");
  require(bool{node.write<od::text>("over a socket")}, "a string is written");
  const auto text = node.read<od::text>();
  require(text && text->view() == "over a socket", "and read");
  const std::vector<std::uint8_t> file = some_file();
  require(bool{node.write<od::file>(file)}, "a DOMAIN is written");
  const auto read = node.read<od::file>();
  require(read && *read == file, "and read");
  const auto missing = sdo.upload(id, 0x5FFF, 0);
  require(missing.abort_code() == canopen::AbortCode::no_object, "an object that is not there: 0602 0000h");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    canopen::HostBus bus{argv[1]};
    const canopen::NodeId id{static_cast<std::uint8_t>(std::atoi(argv[2]))};
    talk(bus, id, false);
    talk(bus, id, true);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "does not hold: %s\n", problem.what());
    return 1;
  }
  return 0;
}
