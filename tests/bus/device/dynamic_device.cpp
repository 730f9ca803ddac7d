/// A device whose EDS is loaded at run time, as a program in simulated time: `dynamic_device EDS [OPTIONS-FILE]`.
#include <fmt/format.h>

#include <canopen_sim/simulated_device.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "device/dynamic_node.hpp"
#include "device/load_sheet.hpp"
#include "diagnostics/diagnostics.hpp"
#include "load/load_device.hpp"

namespace {

/// The sheet of the program's device: `canopen::SimulatedDevice` has a plain function.
std::shared_ptr<const edsc::Sheet> the_sheet;

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  edsc::LoadSettings settings;
  settings.path = argv[1];
  if (argc > 2) settings.options_path = argv[2];
  settings.check = false;
  settings.keep_going = true;
  edsc::Diagnostics diagnostics;
  const std::unique_ptr<edsc::LoadedDevice> loaded = edsc::load_device(settings, diagnostics);
  if (!loaded->device) return 2;
  edsc::LoadedSheet made = edsc::load_sheet(*loaded->device, loaded->options);
  for (const std::string& note : made.notes) fmt::print(stderr, "{}\n", note);
  if (!made.sheet) return 2;
  the_sheet = std::move(made.sheet);
  const canopen::SimulatedDevice device{
      "device",
      [](canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory) -> std::unique_ptr<canopen::SimulatedNode> {
        return edsc::make_dynamic_node(the_sheet, bus, memory);
      }};
  return canopen::simulate_devices(1, argv, {&device, 1});
}
