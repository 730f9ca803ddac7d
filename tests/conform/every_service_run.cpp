#include "every_service_run.hpp"

#include <memory>
#include <stdexcept>

#include "commands/load_device.hpp"
#include "every_service_device.hpp"
#include "simulation_port.hpp"

namespace edsc::conform {
namespace {

const Device& every_service_sheet() {
  static const std::unique_ptr<LoadedDevice> loaded = [] {
    Diagnostics diagnostics;
    LoadSettings settings;
    settings.path = EDSC_SOURCE_DIR "/tests/fixtures/every_service.eds";
    settings.node_id = Wire::node_id;
    return load_device(settings, diagnostics);
  }();
  if (!loaded->device) throw std::runtime_error{"every_service.eds cannot be read"};
  return *loaded->device;
}

}  // namespace

RunReport run_every_service(const Mutant& mutant, const std::vector<std::string>& only) {
  const canopen::SimulatedDevice device{"every_service", every_service_device()};
  SimulationPort::Simulation simulation{device, canopen::NodeId{Wire::node_id}};
  SimulationStimuli stimuli{simulation};
  LiveBus bus{std::make_unique<SimulationPort>(simulation, mutant)};
  RunSettings settings;
  settings.dut.node = canopen::NodeId{Wire::node_id};
  settings.dut.level = Level::all;
  settings.dut.permissions = Permission::store | Permission::application | Permission::outputs;
  settings.only = only;
  RunReport report;
  run_cases(bus, every_service_sheet(), stimuli, settings, report);
  return report;
}

}  // namespace edsc::conform
