#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "network/describe_network.hpp"
#include "online/scan.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/file_arguments.hpp"
#include "shared/live_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "system/path.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc network scan socketcan:can0 --eds eds --bit-rate 500 -o plant.json
  edsc network scan socketcan:can0 --eds eds --nodes 1..10      a part of the bus, to standard output)";

struct Settings {
  std::string bus;
  std::vector<std::string> sheets;
  std::string output;
  ScanOptions scan;
  std::optional<unsigned> bit_rate;
};

int scan_network(LiveBus& bus, const Settings& settings, const SheetFiles& sheets) {
  std::vector<FoundNode> found;
  scan(bus, settings.scan.parsed(), found);
  if (found.empty()) fail("no node answers on " + settings.bus, exit_device_failed);
  DescribeSettings describe;
  describe.folder = from_native(to_native(settings.output).parent_path());
  describe.bit_rate = settings.bit_rate;
  const DescribedNetwork network = describe_network(found, sheets.files, describe);
  std::vector<std::string> inputs;
  for (const SheetFile& file : sheets.files) inputs.push_back(file.path);
  write_output(settings.output, network.text, inputs);
  for (const std::string& note : network.notes) print_to_stderr("edsc: {}\n", note);
  if (!settings.bit_rate) print_to_stderr("edsc: the bit rate is not known; --bit-rate states it\n");
  for (const std::string& error : network.errors) print_to_stderr("edsc: {}\n", error);
  if (!settings.output.empty()) {
    print_visibly(stdout, "{}: {} of {}\n", settings.output, network.nodes, counted(found.size(), "node"));
  }
  return network.errors.empty() ? exit_fine : exit_device_failed;
}

int run_scan(const Settings& settings) {
  const SheetFiles sheets = read_sheet_files(expand_folders(settings.sheets, sheet_extensions, WrittenByEdsc::skipped));
  for (const std::string& problem : sheets.problems) print_to_stderr("edsc: {}\n", problem);
  if (sheets.files.empty()) fail("--eds names no EDS, DCF or XDD file");
  return with_bus(settings.bus, [&](LiveBus& bus) { return scan_network(bus, settings, sheets); });
}

}  // namespace

void add_network_scan_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_scan, exit_code);
  add_bus_argument(command, settings.bus);
  command
      .add_option("--eds", settings.sheets,
                  "of nodes to find; or a folder with such files, except those that edsc has written")
      .one_value_each()
      .required();
  command.add_option("--output", settings.output, "the network file (default: standard output)");
  command.add_option("--bit-rate", settings.bit_rate).range(10, 1000);
  add_scanned_nodes(command, settings.scan);
}

}  // namespace edsc
