#include "online/scan.hpp"

#include <fmt/color.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "online/device_profile.hpp"
#include "online/identity.hpp"
#include "online/lss_session.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/file_arguments.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"
#include "text/text_table.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc scan socketcan:can0                                   all nodes that answer or send heartbeats
  edsc scan socketcan:can0 --nodes 1..10 --for 3s            some of them; three seconds for slow heartbeats
  edsc scan socketcan:can0 --eds drive.eds --eds io.eds      and which EDS matches each
  edsc scan slcan:/dev/ttyACM0 --lss                         and the devices without node-ID, by LSS Fastscan
  edsc scan socketcand:127.0.0.1:29536/vcan0 --format json   for a program)";

struct Settings {
  std::string bus;
  ScanOptions scan;
  std::vector<std::string> sheets;
  bool lss = false;
  unsigned lss_step_ms = 20;
  std::string format = "text";
  ColorOption color;
};

/// An EDS to compare devices with.
struct Candidate {
  std::string path;
  Identity identity;
};

struct Findings {
  std::vector<FoundNode> nodes;
  std::vector<canopen::LssAddress> unconfigured;
  std::string lss_failure;
};

using Json = nlohmann::ordered_json;

std::string hex_or_dash(std::optional<std::uint32_t> number) { return number ? fmt::format("{:08X}h", *number) : "-"; }

std::string fits_text(const FoundNode& node, const std::vector<Candidate>& candidates) {
  std::string text;
  for (const Candidate& candidate : candidates) {
    const IdentityMatch match = compare_identity(candidate.identity, node.identity);
    if (!fits(match)) continue;
    text += (text.empty() ? "" : ", ") + candidate.path;
    std::string remark{match == IdentityMatch::same ? "" : to_text(match)};
    if (const auto missing = not_compared(candidate.identity, node.identity); !missing.empty()) {
      remark += fmt::format("{}{} not compared", remark.empty() ? "" : "; ", names_of(missing));
    }
    if (!remark.empty()) text += fmt::format(" ({})", remark);
  }
  return text.empty() ? "none" : text;
}

/// The most similar node for a file that does not match any node.
struct Nearest {
  const FoundNode* node = nullptr;
  unsigned differences = 0;
};

/// Nothing if the file matches a node, or if no node states a number.
std::optional<Nearest> nearest_misfit(const std::vector<FoundNode>& nodes, const Candidate& candidate) {
  std::optional<Nearest> nearest;
  for (const FoundNode& node : nodes) {
    if (fits(compare_identity(candidate.identity, node.identity))) return std::nullopt;
    const unsigned differences = count_differences(candidate.identity, node.identity);
    if (differences == 0 || (nearest && nearest->differences <= differences)) continue;
    nearest = Nearest{&node, differences};
  }
  return nearest;
}

/// Prints why files do not match any node.
void print_misfits(const std::vector<FoundNode>& nodes, const std::vector<Candidate>& candidates) {
  for (const Candidate& candidate : candidates) {
    const auto nearest = nearest_misfit(nodes, candidate);
    if (!nearest) continue;
    print_visibly(stdout, "{} does not match any node; node {}{}: {}\n", candidate.path, nearest->node->node_id,
                  nodes.size() > 1 ? " is the closest" : "",
                  identity_differences(candidate.identity, nearest->node->identity));
  }
}

void print_text(const Findings& found, const std::vector<Candidate>& candidates, bool colour) {
  TextTable table;
  std::vector<std::string> head{"node", "state", "vendor-ID", "product", "revision", "serial", "device type", "name"};
  if (!candidates.empty()) head.emplace_back("EDS");
  table.add(std::move(head));
  for (const FoundNode& node : found.nodes) {
    const Identity& identity = node.identity;
    std::vector<std::string> row{
        fmt::format("{:>4}", node.node_id),    std::string{node.state ? nmt_state_text(*node.state) : "-"},
        hex_or_dash(identity.vendor_id),       hex_or_dash(identity.product_code),
        hex_or_dash(identity.revision_number), hex_or_dash(identity.serial_number)};
    row.push_back(!node.answers_sdo ? "no answer over SDO"
                  : identity.device_type
                      ? fmt::format("{:08X}h {}", *identity.device_type, profile_text(*identity.device_type))
                      : "-");
    row.push_back(node.name ? *node.name : "-");
    if (!candidates.empty()) row.push_back(fits_text(node, candidates));
    table.add(std::move(row));
  }
  const std::vector<std::string> lines = table.lines();
  for (std::size_t i = found.nodes.empty() ? lines.size() : 0; i < lines.size(); ++i) {
    fmt::print("{}\n", fmt::format(colour && i == 0 ? fmt::emphasis::bold : fmt::text_style{}, "{}", lines[i]));
  }
  print_misfits(found.nodes, candidates);
  for (const FoundNode& node : found.nodes) {
    if (node.has_extra_responses) {
      print_visibly(stdout, "node {}: {}\n", node.node_id, extra_responses_text(node.node_id));
    }
  }
  for (const canopen::LssAddress& address : found.unconfigured) {
    print_visibly(stdout, "without node-ID: {}\n", to_text(address));
  }
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json as_json(const FoundNode& node, const std::vector<Candidate>& candidates) {
  Json json{{"node_id", node.node_id}};
  json["state"] = node.state ? Json(nmt_state_text(*node.state)) : Json(nullptr);
  json["answers_sdo"] = node.answers_sdo;
  json["extra_responses"] = node.has_extra_responses;
  const Identity& identity = node.identity;
  json["device_type"] = or_null(identity.device_type);
  json["profile"] = identity.device_type ? Json(*identity.device_type & 0xFFFF) : Json(nullptr);
  json["vendor_id"] = or_null(identity.vendor_id);
  json["product_code"] = or_null(identity.product_code);
  json["revision_number"] = or_null(identity.revision_number);
  json["serial_number"] = or_null(identity.serial_number);
  json["name"] = or_null(node.name);
  json["data_sheets"] = Json::array();
  json["misfits"] = Json::array();
  for (const Candidate& candidate : candidates) {
    const IdentityMatch match = compare_identity(candidate.identity, node.identity);
    if (!fits(match)) {
      const std::string differences = identity_differences(candidate.identity, node.identity);
      json["misfits"].push_back({{"file", candidate.path}, {"differences", differences}});
      continue;
    }
    Json sheet{{"file", candidate.path}, {"fit", to_text(match)}, {"not_compared", Json::array()}};
    for (const NotCompared& number : not_compared(candidate.identity, node.identity)) {
      sheet["not_compared"].push_back(number.key);
    }
    json["data_sheets"].push_back(std::move(sheet));
  }
  return json;
}

void print_json(const Findings& found, const std::vector<Candidate>& candidates) {
  Json json{{"schema", 2}, {"nodes", Json::array()}, {"unconfigured", Json::array()}};
  for (const FoundNode& node : found.nodes) json["nodes"].push_back(as_json(node, candidates));
  for (const canopen::LssAddress& address : found.unconfigured) {
    json["unconfigured"].push_back({{"vendor_id", address.vendor_id},
                                    {"product_code", address.product_code},
                                    {"revision_number", address.revision_number},
                                    {"serial_number", address.serial_number}});
  }
  fmt::print("{}\n", json_text(json));
}

constexpr std::uint8_t any_node = 1;  ///< the identity of a device does not depend on its node-ID

std::vector<Candidate> load_candidates(const Settings& settings) {
  std::vector<Candidate> candidates;
  for (const std::string& path : expand_folders(settings.sheets)) {
    candidates.push_back({path, identity_of(*load_live_device(path, any_node)->device)});
  }
  return candidates;
}

void find_nodes(LiveBus& bus, const Settings& settings, Findings& found) {
  scan(bus, settings.scan.parsed(), found.nodes);
  if (!settings.lss) return;
  canopen::LssTimeouts timeouts;
  timeouts.answer = canopen::Duration{settings.scan.times.timeout_ms * 1000U};
  timeouts.fastscan_step = canopen::Duration{settings.lss_step_ms * 1000U};
  const LssResult result = LssSession{bus, timeouts}.find_unconfigured(
      [&](const canopen::LssAddress& address) { found.unconfigured.push_back(address); });
  found.lss_failure = result.failure;
}

int run_scan(const Settings& settings) {
  const std::vector<Candidate> candidates = load_candidates(settings);
  return with_bus(settings.bus, [&](LiveBus& bus) {
    Findings found;
    const auto show = [&] {
      if (settings.format == "json") {
        print_json(found, candidates);
      } else {
        print_text(found, candidates, settings.color.on(stdout));
      }
      std::fflush(stdout);
    };
    try {
      find_nodes(bus, settings, found);
    } catch (...) {
      show();  // what was found so far
      throw;
    }
    show();
    if (!found.lss_failure.empty()) fail("fastscan: " + found.lss_failure, exit_device_failed);
    if (!found.nodes.empty() || !found.unconfigured.empty()) return exit_fine;
    fail("no node answers on " + settings.bus, exit_device_failed);
  });
}

}  // namespace

void add_scan_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_scan, exit_code);
  add_bus_argument(command, settings.bus);
  add_scanned_nodes(command, settings.scan);
  command.add_option("--eds", settings.sheets, "of nodes to find; or a folder with such files").one_value_each();
  const Option lss = command.add_flag("--lss", settings.lss);
  add_step_option(command, settings.lss_step_ms).needs(lss);
  add_format_option(command, settings.format);
  settings.color.add_to(command);
}

}  // namespace edsc
