#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands/commands.hpp"
#include "device/entry_text.hpp"
#include "device/meaning/profile_scales.hpp"
#include "monitor/progress_line.hpp"
#include "online/live_bus.hpp"
#include "online/live_scales.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc write socketcan:can0 5 target_velocity 1500 --eds drive.eds            by name
  edsc write socketcan:can0 5 producer_heartbeat_time "500 ms" --eds drive.eds --verify
  edsc write socketcan:can0 5 1017h 500 --type u16                            without an EDS
  edsc write socketcan:can0 5 1017h F4 01 --raw                               as bytes
  edsc write socketcan:can0 5 1F50h:01 --file firmware.bin --eds drive.eds    a DOMAIN from a file)";

struct Settings : NodeSettings {
  std::string object;
  std::vector<std::string> value;
  const canopen::DataTypeRow* type = nullptr;
  std::string file;
  bool raw = false;
  bool force = false;
  bool verify = false;
  bool block = false;
  bool segmented = false;
};

/// Minimum size for a block transfer.
constexpr std::size_t long_value = 128;

/// The value to write, or an error message.
ParsedValue value_to_write(const Settings& settings, const LiveEntry& entry) {
  ParsedValue value;
  if (!settings.file.empty()) {
    (void)read_bytes(settings.file, value.bytes, value.problem);
    return value;
  }
  const std::string text = fmt::format("{}", fmt::join(settings.value, " "));
  if (settings.raw) return parse_value_text(*find_type("octets"), text);
  if (entry.entry != nullptr) {
    return settings.force ? parse_unchecked(*entry.entry, text) : parse_value_text(*entry.entry, text);
  }
  if (entry.type != nullptr) return parse_value_text(*entry.type, text);
  value.problem = "without an EDS the value requires a type (--type u16), or bytes (--raw)";
  return value;
}

void check_access(const LiveEntry& entry) {
  if (entry.entry == nullptr || canopen::writable(entry.entry->access)) return;
  fail(fmt::format("{} is {}; not written (--force writes anyway)", title(entry),
                   canopen::row_of(entry.entry->access).name));
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

/// Ends the command.
[[noreturn]] void fail_at(const LiveEntry& entry, const std::string& what) {
  fail(title(entry) + ": " + what, exit_device_failed);
}

int write_entry(SdoAccess& node, const Settings& settings, const LiveEntry& entry,
                const std::vector<std::uint8_t>& bytes) {
  const SdoOutcome outcome = download(node, entry, settings, bytes);
  report_broken_block(entry, outcome);
  if (!outcome.done()) fail_at(entry, failure_text(outcome));
  if (settings.verify) {
    const SdoOutcome back = upload(node, entry, settings.segmented ? SdoTransfer::segmented : best_transfer(entry));
    report_broken_block(entry, back);
    if (!back.done()) fail_at(entry, "written, but not read back: " + failure_text(back));
    if (!reads_back(back, bytes)) fail_at(entry, "written, but it reads back as " + value_of(entry, back.bytes));
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

/// Whether other objects of the device state the unit and scale of the value.
bool depends_on_device(const Settings& settings, const LiveEntry& entry) {
  return !settings.raw && settings.file.empty() && entry.entry != nullptr &&
         has_profile_scale(*entry.device, *entry.entry);
}

/// Writes a value in the unit that the device states.
int write_scaled(LiveBus& bus, const Settings& settings, LiveEntry entry) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  LiveScales scales{node};
  scales.apply(entry);
  const bool is_known = report_live_scales(scales);
  const ParsedValue value = value_to_write(settings, entry);
  if (!value.ok()) fail(value.problem, is_known ? exit_wrong_usage : exit_device_failed);
  return write_entry(node, settings, entry, value.bytes);
}

int run_write(const Settings& settings) {
  if (settings.file.empty() && settings.value.empty()) throw_required("VALUE or --file");
  const auto loaded = settings.sheet.empty() ? nullptr : load_live_device(settings.sheet, settings.node);
  LiveEntry entry = name_entry(loaded.get(), settings.object, settings.without_sheet);
  if (settings.type != nullptr) set_type(entry, *settings.type);
  if (!settings.force) check_access(entry);
  if (depends_on_device(settings, entry)) {
    return with_bus(settings.bus, [&](LiveBus& bus) { return write_scaled(bus, settings, entry); });
  }
  const ParsedValue value = value_to_write(settings, entry);
  if (!value.ok()) fail(value.problem);
  return with_bus(settings.bus, [&](LiveBus& bus) {
    SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
    return write_entry(node, settings, entry, value.bytes);
  });
}

}  // namespace

void add_write_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_write, exit_code);
  add_node_arguments(command, settings);
  command.add_option("OBJECT", settings.object, "6064h, 1018h:02, or a name from the EDS").required();
  const Option value = command.add_option("VALUE", settings.value, "1500, 5DCh, \"500 ms\", text; with --raw bytes");
  command.add_option("--eds", settings.sheet);
  add_type_option(command, settings.type);
  const Option raw = command.add_flag("--raw", settings.raw);
  command.add_option("--file", settings.file).excludes(value).excludes(raw);
  command.add_flag("--force", settings.force, "access type or limits do not allow the value");
  command.add_flag("--verify", settings.verify);
  const Option block = command.add_flag("--block", settings.block);
  command.add_flag("--segmented", settings.segmented).excludes(block);
  add_timeout_option(command, settings.sdo.timeout_ms);
}

}  // namespace edsc
