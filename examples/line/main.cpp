/// The master of docs/networks.md: the outputs follow the inputs while the encoder stands still.
#include <canopen/host/host_bus.hpp>
#include <canopen_plant/plant.hpp>
#include <canopen_plant/plant_text.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <line.hpp>

namespace {

using namespace canopen::literals;

void run(const char* address) {
  canopen::HostBus bus{address};
  canopen::Plant<line::Network, canopen::HostBus> plant{bus};
  plant.on(line::signals::inputs::read_input_8_bit_1{}, [&plant](auto levels) {
    const bool stands_still = plant.encoder.speed_value_1() == 0_mm_per_s;
    plant.outputs.write_output_8_bit_1(canopen::raw(stands_still ? levels.raw() : std::uint8_t{0}));
  });
  plant.on_booted = [](const canopen::PlantNode& node) {
    std::printf("%.*s: booted\n", static_cast<int>(node.name.size()), node.name.data());
    std::fflush(stdout);
  };
  plant.on_fault = [](const canopen::PlantNode& node, const canopen::PlantFault& fault) {
    std::fprintf(stderr, "%s\n", fault_text(node, fault, line::Network::places, line::Network::errors).c_str());
  };
  bus.run(plant);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    run(argv[1]);
  } catch (const std::exception& problem) {  // the bus does not exist, or is lost
    std::fprintf(stderr, "%s\n", problem.what());
  }
  return 1;
}
