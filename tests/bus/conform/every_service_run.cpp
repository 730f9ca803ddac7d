#include "every_service_run.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "conform/sheet_findings.hpp"
#include "every_service_device.hpp"
#include "load/load_device.hpp"
#include "simulation_port.hpp"

namespace edsc::conform {
namespace {

struct Sheet {
  std::unique_ptr<LoadedDevice> loaded;
  SheetFindings findings;
};

Sheet load_sheet(const Mutant& mutant) {
  LoadSettings settings;
  settings.path = EDSC_SOURCE_DIR "/tests/fixtures/every_service.eds";
  settings.node_id = Wire::node_id;
  Diagnostics diagnostics;
  Sheet sheet{load_device(settings, diagnostics), sheet_findings(diagnostics)};
  if (mutant.of_eds) {
    std::string text{sheet.loaded->source->text()};
    mutant.of_eds(text);
    sheet.loaded->source = std::make_unique<SourceFile>(settings.path, std::move(text));
    Diagnostics of_change;
    resolve_and_check(*sheet.loaded, settings, of_change);
    sheet.findings = sheet_findings(of_change);
  }
  if (!sheet.loaded->device) throw std::runtime_error{"every_service.eds cannot be read"};
  return sheet;
}

}  // namespace

RunReport run_every_service(const Mutant& mutant, const std::vector<std::string>& only) {
  const canopen::SimulatedDevice device{"every_service", every_service_device()};
  SimulationPort::Simulation simulation{device, canopen::NodeId{Wire::node_id}};
  SimulationStimuli stimuli{simulation};
  LiveBus bus{std::make_unique<SimulationPort>(simulation, mutant)};
  RunSettings settings;
  settings.dut.node = canopen::NodeId{Wire::node_id};
  settings.dut.simulated = true;
  settings.dut.level = Level::hostile;
  settings.dut.permissions = Permission::store | Permission::application | Permission::outputs;
  settings.only = only;
  const Sheet sheet = load_sheet(mutant);
  settings.dut.findings = sheet.findings;
  RunReport report;
  run_cases(bus, *sheet.loaded->device, stimuli, settings, report);
  return report;
}

}  // namespace edsc::conform
