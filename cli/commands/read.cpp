#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "commands/commands.hpp"
#include "monitor/progress_line.hpp"
#include "online/live_bus.hpp"
#include "online/live_scales.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc read socketcan:can0 5 position_actual_value --eds drive.eds    by name, in the units of the EDS
  edsc read socketcan:can0 5 6064h identity_object.vendor_id --eds drive.eds
  edsc read socketcan:can0 5 1018h --eds drive.eds                    all entries of an object
  edsc read socketcan:can0 5 --all --eds drive.eds --format json      all that can be read
  edsc read socketcan:can0 5 1018h:02 --type u32                      without an EDS
  edsc read socketcan:can0 5 1021h --eds drive.eds -o stored.eds      a DOMAIN to a file)";

struct Settings : NodeSettings {
  std::vector<std::string> objects;
  const canopen::DataTypeRow* type = nullptr;
  std::string format = "text";
  std::string file;
  bool raw = false;
  bool all = false;
  bool block = false;
  bool segmented = false;
};

using Json = nlohmann::ordered_json;

/// Consecutive entries without response, after which the node is lost.
constexpr unsigned max_silent = 3;

/// An entry to read.
struct Chosen {
  LiveEntry entry;
  bool by_object = false;  ///< one of the entries of its object, which need not all have a value
};

/// All entries that tools may read (ObjFlags, CiA 306-1, 4.6.3.2); DOMAINs only if named.
std::vector<Chosen> all_entries(const Device& device) {
  constexpr std::uint32_t no_read = 2;
  std::vector<Chosen> entries;
  for (const Object& object : device.objects) {
    for (const Entry& entry : object.entries) {
      const bool flagged = ((entry.obj_flags | object.obj_flags) & no_read) != 0;
      if (!canopen::readable(entry.access) || flagged) continue;
      if (entry.type != nullptr && entry.type->kind == canopen::DataClass::domain) continue;
      entries.push_back({live_entry(device, object, entry), true});
    }
  }
  return entries;
}

std::vector<Chosen> choose_entries(const Settings& settings, const LoadedDevice* loaded) {
  if (settings.all) return all_entries(*loaded->device);
  std::vector<Chosen> chosen;
  for (const std::string& text : settings.objects) {
    std::vector<LiveEntry> entries = name_entries(loaded, text, settings.without_sheet);
    for (LiveEntry& entry : entries) {
      if (settings.type != nullptr) set_type(entry, *settings.type);
      chosen.push_back({std::move(entry), entries.size() > 1});
    }
  }
  return chosen;
}

/// The value of sub-index 0 of the current object.
class EntryCount {
 public:
  void take(const LiveEntry& entry, const SdoOutcome& outcome) {
    if (entry.sub_index != 0) return;
    index_ = entry.index;
    count_ = outcome.done() && outcome.bytes.size() == 1 ? std::optional{outcome.bytes.front()} : std::nullopt;
  }

  /// Whether the entry is above it.
  [[nodiscard]] bool leaves_out(const LiveEntry& entry) const {
    return count_ && entry.index == index_ && entry.sub_index > *count_;
  }

 private:
  std::uint16_t index_ = 0;
  std::optional<std::uint8_t> count_;
};

/// 1003h has the number of entries in its sub-index 0 (CiA 301, 7.5.2.4); the others are not read.
bool has_no_entry(const Chosen& chosen, const EntryCount& count) {
  constexpr std::uint16_t error_history = 0x1003;
  return chosen.by_object && chosen.entry.index == error_history && count.leaves_out(chosen.entry);
}

/// Whether the device may refuse to read the entry: it currently has no value, or it is a mapping entry above the
/// number of mapped objects.
bool may_be_refused(const Chosen& chosen, const EntryCount& count, const SdoOutcome& outcome) {
  if (!chosen.by_object || outcome.end != SdoEnd::refused) return false;
  const unsigned range = chosen.entry.index & 0xFE00U;
  return outcome.code == canopen::AbortCode::no_data ||
         ((range == 0x1600 || range == 0x1A00) && count.leaves_out(chosen.entry));
}

SdoOutcome read_entry(SdoAccess& node, const LiveEntry& entry, const Settings& settings) {
  ProgressLine progress;
  const bool block = !settings.segmented && (settings.block || best_transfer(entry) == SdoTransfer::block);
  const SdoProgress show = [&](std::size_t done, std::size_t) {
    if (progress.due()) progress.show(fmt::format("{}: {}", title(entry), counted(done, "byte")));
  };
  SdoOutcome outcome = upload(node, entry, block ? SdoTransfer::block : SdoTransfer::segmented, show);
  progress.hide();
  report_broken_block(entry, outcome);
  return outcome;
}

/// Values of the objects on which the fields of others depend, such as the mode of operation in 6061h. Each is read
/// once.
class Selectors {
 public:
  Selectors(SdoAccess& node, const Settings& settings) : node_{node}, settings_{settings} {}

  /// The value for an entry that was read; nothing if its fields depend on none, or the device does not return it.
  std::optional<std::int64_t> value_for(const LiveEntry& entry) {
    const std::optional<LiveEntry> selector = selector_of(entry);
    if (!selector) return std::nullopt;
    const auto [found, is_new] = values_.try_emplace({selector->index, selector->sub_index});
    if (is_new) {
      const SdoOutcome outcome = read_entry(node_, *selector, settings_);
      if (outcome.done()) found->second = integer_of(*selector, outcome.bytes);
    }
    return found->second;
  }

 private:
  SdoAccess& node_;
  const Settings& settings_;
  std::map<std::pair<std::uint16_t, std::uint8_t>, std::optional<std::int64_t>> values_;
};

void print_line(const LiveEntry& entry, const SdoOutcome& outcome, bool raw) {
  if (outcome.done()) {
    print_visibly(stdout, "{} = {}\n", title(entry), raw ? hex_bytes(outcome.bytes) : value_of(entry, outcome.bytes));
  } else {
    print_to_stderr("edsc: {}: {}\n", title(entry), failure_text(outcome));
  }
}

int save(const Settings& settings, const LiveEntry& entry, const SdoOutcome& outcome) {
  if (!outcome.done()) fail(title(entry) + ": " + failure_text(outcome), exit_device_failed);
  write_all_files({{settings.file, std::string{outcome.bytes.begin(), outcome.bytes.end()}}});
  print_visibly(stdout, "{}: {} to {}\n", title(entry), counted(outcome.bytes.size(), "byte"), settings.file);
  return exit_fine;
}

int read_entries(LiveBus& bus, const Settings& settings, const std::vector<Chosen>& entries) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  Json json{{"schema", 2}, {"node_id", settings.node}, {"entries", Json::array()}};
  int exit_code = exit_fine;
  unsigned silent = 0;
  bool heard = false;
  EntryCount count;
  Selectors selectors{node, settings};
  LiveScales scales{node};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    LiveEntry entry = entries[i].entry;
    if (has_no_entry(entries[i], count)) continue;
    const SdoOutcome outcome = read_entry(node, entry, settings);
    if (!settings.file.empty()) return save(settings, entry, outcome);
    count.take(entry, outcome);
    const bool shows_fields = !settings.raw || settings.format == "json";
    if (outcome.done() && shows_fields) {
      entry.other = selectors.value_for(entry);
      scales.apply(entry);
      static_cast<void>(report_live_scales(scales));
    }
    const bool excused = may_be_refused(entries[i], count, outcome);
    if (settings.format == "json") {
      json["entries"].push_back(as_json(entry, outcome, outcome.bytes));
    } else if (excused) {
      print_visibly(stdout, "{}: no value\n", title(entry));
    } else {
      print_line(entry, outcome, settings.raw);
    }
    if (!outcome.done() && !excused) exit_code = exit_device_failed;
    silent = outcome.end == SdoEnd::no_answer ? silent + 1 : 0;
    heard = heard || silent == 0;
    if (silent >= (heard ? max_silent : 1) && i + 1 != entries.size()) {
      print_to_stderr("edsc: node {} does not answer: {} more not read\n", settings.node, entries.size() - i - 1);
      break;
    }
  }
  if (settings.format == "json") fmt::print("{}\n", json_text(json));
  return exit_code;
}

int run_read(const Settings& settings) {
  if (!settings.all && settings.objects.empty()) throw_required("OBJECT or --all");
  if (settings.all && settings.sheet.empty()) throw_requires("--all", "--eds or --network");
  const auto loaded = settings.sheet.empty() ? nullptr : load_live_device(settings.sheet, settings.node);
  const std::vector<Chosen> entries = choose_entries(settings, loaded.get());
  if (!settings.file.empty() && entries.size() != 1) {
    fail(fmt::format("--output takes the value of one entry, not of {}", entries.size()));
  }
  return with_bus(settings.bus, [&](LiveBus& bus) { return read_entries(bus, settings, entries); });
}

}  // namespace

void add_read_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_read, exit_code);
  add_node_arguments(command, settings);
  const Option objects = command.add_option("OBJECT", settings.objects, "6064h, 1018h:02, or a name from the EDS");
  command.add_option("--eds", settings.sheet);
  const Option all = command.add_flag("--all", settings.all, "except DOMAINs; needs --eds");
  all.excludes(objects);
  add_type_option(command, settings.type);
  add_format_option(command, settings.format);
  const Option raw = command.add_flag("--raw", settings.raw, "print values like this");
  const Option file = command.add_option("--output", settings.file, "the bytes of one entry");
  file.excludes(all).excludes(raw);
  const Option block = command.add_flag("--block", settings.block);
  command.add_flag("--segmented", settings.segmented).excludes(block);
  command.add_option("--max-bytes", settings.sdo.max_bytes).range(1, std::uint64_t{1} << 30).show_default();
  add_timeout_option(command, settings.sdo.timeout_ms);
}

}  // namespace edsc
