#include <fmt/format.h>

#include "commands/commands.hpp"
#include "monitor/progress_line.hpp"
#include "online/live_bus.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc write socketcan:can0 5 target_velocity 1500 --eds drive.eds            by name
  edsc write socketcan:can0 5 producer_heartbeat_time "500 ms" --eds drive.eds --verify
  edsc write socketcan:can0 5 1017h 500 --type u16                            without an EDS
  edsc write socketcan:can0 5 1017h F4 01 --raw                               as bytes
  edsc write socketcan:can0 5 1F50h:01 --file firmware.bin --eds drive.eds    a DOMAIN from a file)";

struct Settings {
  std::string bus;
  std::uint8_t node = 0;
  std::string object;
  std::vector<std::string> value;
  std::string sheet;
  const canopen::DataTypeRow* type = nullptr;
  std::string file;
  bool raw = false;
  bool force = false;
  bool verify = false;
  bool block = false;
  bool segmented = false;
  SdoSettings sdo;
};

/// Minimum size for a block transfer.
constexpr std::size_t long_value = 128;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// The value to write, or an error message.
ParsedValue value_to_write(const Settings& settings, const LiveEntry& entry) {
  ParsedValue value;
  if (!settings.file.empty()) {
    (void)read_bytes(settings.file, value.bytes, value.problem);
    return value;
  }
  const std::string text = joined(settings.value);
  if (settings.raw) return parse_value_text(*find_type("octets"), text);
  if (entry.entry != nullptr && !settings.force) return parse_value_text(*entry.entry, text);
  if (entry.type != nullptr) return parse_value_text(*entry.type, text);
  value.problem = "without an EDS the value requires a type (--type u16), or bytes (--raw)";
  return value;
}

std::string access_problem(const LiveEntry& entry) {
  if (entry.entry == nullptr || canopen::writable(entry.entry->access)) return {};
  return fmt::format("{} is {}; not written (--force writes anyway)", title(entry),
                     canopen::row_of(entry.entry->access).name);
}

SdoOutcome download(SdoAccess& node, const LiveEntry& entry, const Settings& settings,
                    const std::vector<std::uint8_t>& bytes) {
  ProgressLine progress;
  const bool block = !settings.segmented && (settings.block || bytes.size() >= long_value);
  const SdoProgress show = [&](std::size_t done, std::size_t total) {
    if (progress.due()) progress.show(fmt::format("{}: {} of {}", title(entry), done, counted(total, "byte")));
  };
  return node.download(entry.index, entry.sub_index, bytes, block ? SdoTransfer::block : SdoTransfer::segmented,
                       bytes.size() >= long_value ? show : SdoProgress{});
}

int failed(const LiveEntry& entry, std::string_view what) {
  print_visibly(stderr, "edsc: {}: {}\n", title(entry), what);
  return exit_device_failed;
}

int write_entry(LiveBus& bus, const Settings& settings, const LiveEntry& entry,
                const std::vector<std::uint8_t>& bytes) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  const SdoOutcome outcome = download(node, entry, settings, bytes);
  report_broken_block(entry, outcome);
  if (!outcome.done()) return failed(entry, failure_text(outcome));
  if (settings.verify) {
    const SdoOutcome back = upload(node, entry, settings.segmented ? SdoTransfer::segmented : best_transfer(entry));
    report_broken_block(entry, back);
    if (!back.done()) return failed(entry, "written, but not read back: " + failure_text(back));
    if (!reads_back(back, bytes)) return failed(entry, "written, but it reads back as " + value_of(entry, back.bytes));
  }
  const std::string verified = settings.verify ? ", verified" : "";
  if (settings.file.empty()) {
    print_visibly(stdout, "{} = {}{}\n", title(entry), settings.raw ? hex_bytes(bytes) : value_of(entry, bytes),
                  verified);
  } else {
    print_visibly(stdout, "{}: {} from {}{}\n", title(entry), counted(bytes.size(), "byte"), settings.file, verified);
  }
  return exit_fine;
}

int run_write(const Settings& settings) {
  std::unique_ptr<LoadedDevice> loaded;
  if (!settings.sheet.empty()) {
    loaded = load_live_device(settings.sheet, settings.node);
    if (!loaded) return exit_wrong_usage;
  }
  NamedEntries named = name_entry(loaded ? &*loaded->device : nullptr, settings.object);
  ParsedValue value;
  std::string problem = named.problem;
  if (problem.empty() && settings.type != nullptr) set_type(named.entries.front(), *settings.type);
  if (problem.empty() && !settings.force) problem = access_problem(named.entries.front());
  if (problem.empty()) {
    value = value_to_write(settings, named.entries.front());
    problem = value.problem;
  }
  if (!problem.empty()) {
    print_visibly(stderr, "edsc: {}\n", problem);
    return exit_wrong_usage;
  }
  return with_bus(settings.bus,
                  [&](LiveBus& bus) { return write_entry(bus, settings, named.entries.front(), value.bytes); });
}

}  // namespace

void add_write_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("write", "write an object of a node over SDO");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  add_bus_argument(*command, settings->bus);
  add_node_argument(*command, settings->node);
  command->add_option("OBJECT", settings->object, "6064h, 1018h:02, or a name from the EDS")->required();
  auto* value = command->add_option("VALUE", settings->value, "1500, 5DCh, \"500 ms\", text; with --raw bytes");
  command->add_option("--eds", settings->sheet, "description of the node: EDS, DCF, XDD or XDC")->type_name("FILE");
  add_type_option(*command, settings->type);
  auto* raw = command->add_flag("--raw", settings->raw, "VALUE is bytes, as hexadecimal digits");
  command->add_option("--file", settings->file, "write the bytes of this file")
      ->type_name("FILE")
      ->excludes(value)
      ->excludes(raw);
  command->add_flag("--force", settings->force, "write regardless of access type and limits");
  command->add_flag("--verify", settings->verify, "read the value back and compare it");
  auto* block = command->add_flag("--block", settings->block, "block transfer also for short values");
  command->add_flag("--segmented", settings->segmented, "no block transfer")->excludes(block);
  add_timeout_option(*command, settings->sdo.timeout_ms);
  command->callback([settings, &exit_code] {
    if (settings->file.empty() && settings->value.empty()) throw CLI::RequiresError("VALUE or --file", 1);
    exit_code = run_write(*settings);
  });
}

}  // namespace edsc
