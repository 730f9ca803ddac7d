#include <fmt/format.h>

#include <algorithm>
#include <canopen/host/file_storage.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commands/commands.hpp"
#include "commands/node_commands.hpp"
#include "device/behaving_node.hpp"
#include "device/entry_text.hpp"
#include "device/load_sheet.hpp"
#include "device/node_host.hpp"
#include "device/value_overlay.hpp"
#include "load/load_device.hpp"
#include "lookup/find_entry.hpp"
#include "server/candump_line.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/frame_log.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/node_behaviour.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc node socketcan:vcan0 drive.eds --node-id 5             until Ctrl-C
  edsc node socketcan:vcan0 drive.dcf                         with the node-ID of the DCF
  edsc node socketcan:vcan0 io.eds --node-id 10 --count 4     nodes 10, 11, 12 and 13
  edsc node socketcan:vcan0 --node 5=drive.eds --node 6=io.eds
  edsc node socketcan:vcan0 drive.eds --node-id 5 --set serial_number=1234 --set 1017h="500 ms"
  edsc node socketcan:vcan0 drive.eds --node-id 5 --memory drive.mem     keep what a master stores
  edsc node socketcan:vcan0 drive.eds --node-id 5 --device-profile       with a simulated axis
  edsc node socketcan:vcan0 drive.eds --node-id 5 --script drive.behaviour.json --start

Commands on standard input set values, start generators and inject faults; "help" lists them.)";

constexpr unsigned highest_node_id = 127;

struct Settings {
  std::string bus;
  std::string file;
  std::optional<std::uint8_t> node_id;
  std::uint64_t count = 1;
  std::vector<std::string> nodes;
  std::string options;
  std::vector<std::string> values;
  std::string memory;
  std::string script;
  std::string log;
  std::uint64_t seed = 0;
  bool start = false;
  bool device_profile = false;
  bool keep_going = false;
  bool quiet = false;
  ColorOption color;
};

/// A file, and the sheet that its nodes share.
struct File {
  std::unique_ptr<LoadedDevice> loaded;
  std::shared_ptr<const Sheet> sheet;
  std::unique_ptr<EntryFinder> names;
  NodeBehaviour behaviour;
};

struct PlannedNode {
  unsigned node_id;  ///< 255: LSS gives the node a node-ID
  const File* file;
};

std::string bad_value(const std::string& text) {
  const std::size_t at = text.find('=');
  if (at != std::string::npos && at != 0) return "";
  return fmt::format("\"{}\" is not OBJECT=VALUE", printable(text));
}

/// The value of an entry that has these bytes.
Value value_of_bytes(const canopen::DataTypeRow& type, const std::vector<std::uint8_t>& bytes) {
  Value value;
  if (type.bits == 0) {
    value.bytes.assign(bytes.begin(), bytes.end());
    return value;
  }
  value.bits = number_of(bytes);
  if (type.kind == canopen::DataClass::signed_integer)
    value.bits = static_cast<std::uint64_t>(sign_extended(value.bits, type.bits));
  return value;
}

/// Replaces default values by those of --set.
void set_values(LoadedDevice& loaded, const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  ValueOverlay values;
  for (const std::string& text : texts) {
    const std::size_t at = text.find('=');
    const LiveEntry named_entry = name_entry(&loaded, text.substr(0, at));
    const ParsedValue value = parse_value_text(*named_entry.entry, text.substr(at + 1));
    if (!value.ok()) fail(value.problem);
    values.set(*named_entry.entry, value_of_bytes(*named_entry.entry->type, value.bytes));
  }
  Diagnostics of_mapping;
  loaded.device = with_values(*loaded.device, values, loaded.options, of_mapping);
}

/// Ends the command if the file has errors, unless --keep-going is given.
File load_file(const Settings& settings, const std::string& path) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LoadSettings load;
  load.path = path;
  load.options_path = settings.options;
  load.keep_going = settings.keep_going;
  File file;
  file.loaded = load_device(load, diagnostics);
  if (diagnostics.errors() > 0) print_findings(diagnostics, settings.color);
  if (!file.loaded->device || diagnostics.errors() > 0)
    throw Exit{file.loaded->unreadable ? exit_wrong_usage : exit_input_has_errors};
  set_values(*file.loaded, settings.values);
  LoadedSheet made = load_sheet(*file.loaded->device, file.loaded->options);
  for (const std::string& note : made.notes) {
    if (!settings.quiet || !made.sheet) print_to_stderr("edsc: {}: {}\n", printable(path), note);
  }
  if (!made.sheet) throw Exit{exit_input_has_errors};
  file.sheet = std::move(made.sheet);
  file.names = std::make_unique<EntryFinder>(file.loaded->named());
  if (!settings.script.empty()) add_script(file.behaviour, settings.script, *file.names, settings.color);
  const Device& device = *file.loaded->device;
  if (settings.device_profile && !add_device_profile(file.behaviour, device, *file.names)) {
    const unsigned profile = device_profile(device);
    fail(fmt::format(
        "{}: --device-profile is for modules of CiA 401 with inputs for their outputs, drives of CiA 402 and "
        "encoders of CiA 406; 1000h states {}",
        printable(path), profile == 0 ? "no profile" : fmt::format("CiA {}", profile)));
  }
  return file;
}

/// The node-ID of FILE: that of --node-id, else of the DCF, else 255 if the device has LSS.
unsigned first_node_id(const Settings& settings, const File& file) {
  if (settings.node_id) return *settings.node_id;
  if (file.loaded->device->node_id) return *file.loaded->device->node_id;
  if (file.sheet->lss_options && settings.count == 1) return canopen::unconfigured_node_id.value();
  fail(fmt::format("{}: the file does not state a node-ID; give it with --node-id", printable(settings.file)));
}

class Plan {
 public:
  explicit Plan(const Settings& settings) : settings_{settings} {
    if (!settings.file.empty()) add_file();
    for (const std::string& text : settings.nodes) {
      const std::optional<NodeFile> node = parse_node_file(text);
      if (!node) fail(fmt::format("\"{}\" is not NODE-ID=FILE", printable(text)));
      add(node->node_id, file(node->path));
    }
    if (nodes_.empty()) throw_required("FILE or --node");
    if (!settings.memory.empty() && nodes_.size() != 1) fail("--memory is the file of one node");
  }

  [[nodiscard]] const std::vector<PlannedNode>& nodes() const { return nodes_; }

  /// The files that the command reads.
  [[nodiscard]] std::vector<std::string> inputs() const {
    std::vector<std::string> all{settings_.script};
    for (const auto& [path, file] : files_) {
      for (std::string& name : input_files(*file.loaded)) all.push_back(std::move(name));
    }
    return all;
  }

 private:
  /// Each file is loaded once.
  const File& file(const std::string& path) {
    const auto at = files_.find(path);
    return at != files_.end() ? at->second : files_.emplace(path, load_file(settings_, path)).first->second;
  }

  void add_file() {
    const File& of_all = file(settings_.file);
    const unsigned first = first_node_id(settings_, of_all);
    for (unsigned i = 0; i < settings_.count; ++i) add(first + i, of_all);
  }

  void add(unsigned node_id, const File& of_node) {
    if (node_id > highest_node_id && node_id != canopen::unconfigured_node_id.value())
      fail(fmt::format("node-ID {} is above {}", node_id, highest_node_id));
    if (!node_ids_.insert(node_id).second) fail(fmt::format("two nodes have the node-ID {}", node_id));
    nodes_.push_back({node_id, &of_node});
  }

  const Settings& settings_;
  std::map<std::string, File> files_;
  std::vector<PlannedNode> nodes_;
  std::set<unsigned> node_ids_;
};

void report_ready(const PlannedNode& node, const std::string& bus) {
  const std::string id =
      node.node_id <= highest_node_id ? fmt::format("node {}", node.node_id) : std::string{"node without node-ID"};
  print_visibly(stdout, "{} \"{}\" on {}\n", id, node.file->loaded->device->product_name, bus);
}

/// Reports what an action of a script could not do.
void report_problem(unsigned node_id, const std::string& problem) {
  print_to_stderr("edsc: node {}: {}\n", node_id, problem);
}

CommandedNode add_node(NodeHost& host, const PlannedNode& node, const Settings& settings) {
  BehavingNode* added = nullptr;
  host.add(canopen::NodeId{static_cast<std::uint8_t>(node.node_id)},
           [&](canopen::SimulatedBus& port, canopen::SimulatedMemory& memory) {
             BehavingNodeSettings of_node{node.file->sheet, settings.memory, settings.seed + node.node_id,
                                          settings.start, node.file->behaviour.profile};
             auto made = std::make_unique<BehavingNode>(std::move(of_node), port, memory);
             added = made.get();
             return made;
           });
  added->behaviour().report = [node_id = node.node_id](const std::string& problem) {
    report_problem(node_id, problem);
  };
  added->behaviour().add(node.file->behaviour.script);
  return {added, node.file->names.get()};
}

/// Why a node cannot keep its stored values in a file; empty: it can. The file need not exist.
std::string problem_of_memory(const std::string& path) {
  canopen::FileStorage storage{path};
  if (storage.open() == canopen::StorageState::damaged)
    return storage.error() ? storage.error().message() : "is not a file of stored values, or is damaged";
  const std::filesystem::path folder = to_native(path).parent_path();
  std::error_code error;
  const bool has_folder = folder.empty() || std::filesystem::is_directory(folder, error);
  return has_folder ? "" : "the folder does not exist";
}

/// Ends the command if it would write one of its inputs, or if --memory is not a file of stored values.
void check_written_files(const Settings& settings, std::vector<std::string> inputs) {
  refuse_input(settings.memory, inputs);
  inputs.push_back(settings.memory);
  refuse_input(settings.log, inputs);
  if (settings.memory.empty()) return;
  const std::string problem = problem_of_memory(settings.memory);
  if (!problem.empty()) fail(fmt::format("{}: {}", printable(settings.memory), problem));
}

/// How often standard input is read while it is open: without it, an idle node does not use the computer.
constexpr canopen::Duration command_wait{20'000}, idle_wait{100'000};

int run_node(const Settings& settings) {
  const Plan plan{settings};
  check_written_files(settings, plan.inputs());
  return with_bus(settings.bus, [&](LiveBus& bus) {
    NodeHost host{bus};
    std::optional<FrameLog> log;
    if (!settings.log.empty()) {
      log.emplace(settings.log, interface_of(settings.bus));
      host.on_frame = [&](const canopen::Frame& frame) {
        const bool is_written = log->write(frame, bus.now(), bus.now()) && log->flush();
        if (!is_written) fail(fmt::format("{}: {}", printable(settings.log), std::strerror(errno)));
      };
    }
    std::vector<CommandedNode> nodes;
    for (const PlannedNode& node : plan.nodes()) nodes.push_back(add_node(host, node, settings));
    NodeCommands commands{std::move(nodes), settings.color};
    host.start();
    if (!settings.quiet) {
      for (const PlannedNode& node : plan.nodes()) report_ready(node, settings.bus);
    }
    flush_output();
    host.run([&] { return commands.serve(); }, [&] { return commands.is_open() ? command_wait : idle_wait; });
    return exit_fine;
  });
}

}  // namespace

void add_node_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_node, exit_code);
  add_bus_argument(command, settings.bus);
  command.add_option("FILE", settings.file, "EDS, DCF, XDD or XDC of the nodes");
  add_node_id_option(command, settings.node_id);
  command.add_option("--count", settings.count, "with consecutive node-IDs").range(1, highest_node_id);
  command.add_option("--node", settings.nodes);
  add_options_option(command, settings.options);
  command.add_option("--set", settings.values).check(bad_value);
  command.add_option("--memory", settings.memory);
  command.add_option("--script", settings.script);
  command.add_flag(
      "--device-profile", settings.device_profile,
      "modules (CiA 401) read their outputs, drives (CiA 402) move a simulated axis, encoders (CiA 406) move");
  command.add_option("--seed", settings.seed);
  command.add_flag("--start", settings.start, "the nodes become Operational after each boot-up");
  command.add_option("--log", settings.log);
  command.add_flag("--keep-going", settings.keep_going);
  command.add_flag("--quiet", settings.quiet);
  settings.color.add_to(command);
}

}  // namespace edsc
