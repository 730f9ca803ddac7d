#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "device/bit_rates.hpp"
#include "online/lss_session.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_options.hpp"
#include "shared/node_names.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

using canopen::LssAddress;
using canopen::LssState;

constexpr const char* examples = R"(Examples:
  edsc lss socketcan:can0 fastscan                        devices without node-ID
  edsc lss socketcan:can0 assign --vendor 93h --product 43354B52h --revision 10001h --serial 15011234h --node-id 5 --store
  edsc lss socketcan:can0 assign --node-id 5 --store      the first device without node-ID that Fastscan finds
  edsc lss socketcan:can0 state configuration             step by step, with one device on the bus
  edsc lss socketcan:can0 inquire
  edsc lss socketcan:can0 node-id 5
  edsc lss socketcan:can0 bit-rate 250
  edsc lss socketcan:can0 store
  edsc lss socketcan:can0 activate --delay 500ms
  edsc lss socketcan:can0 state waiting)";

constexpr unsigned automatic = 0;

struct Settings {
  std::string bus;
  unsigned timeout_ms = 500;
  unsigned step_ms = 20;
  std::string format = "text";
  std::optional<std::uint32_t> vendor, product, revision, serial;
  std::string written_node;
  std::string network;
  std::uint8_t node_id = 0;
  std::optional<unsigned> kbit;
  bool store = false;
  unsigned delay_ms = 500;
  LssState state = LssState::waiting;
  std::string (*service)(LssSession&, const Settings&) = nullptr;  ///< the subcommand; see ServiceRow

  void resolve() {
    if (written_node.empty()) return;
    node_id = parse_count(written_node) == 255 ? std::uint8_t{255} : find_node_id("NODE", written_node, network);
  }
};

using Json = nlohmann::ordered_json;

/// `store: the device does not answer`; empty if the service succeeded.
std::string problem_of(std::string_view service, const LssResult& result) {
  return result.done() ? "" : fmt::format("{}: {}", service, result.failure);
}

Json address_json(const LssAddress& address) {
  return {{"vendor_id", address.vendor_id},
          {"product_code", address.product_code},
          {"revision_number", address.revision_number},
          {"serial_number", address.serial_number}};
}

void print(const Json& json) { fmt::print("{}\n", json_text(json)); }

LssAddress address_of(const Settings& settings) {
  return {settings.vendor.value_or(0), settings.product.value_or(0), settings.revision.value_or(0),
          settings.serial.value_or(0)};
}

/// The number of given address parts, from the first.
std::uint8_t known_numbers(const Settings& settings) {
  std::uint8_t known = 0;
  for (const auto* number : {&settings.vendor, &settings.product, &settings.revision, &settings.serial}) {
    if (!*number) break;
    ++known;
  }
  return known;
}

std::string select(LssSession& session, const Settings& settings) {
  return problem_of("select", session.select(address_of(settings)));
}

std::string switch_state(LssSession& session, const Settings& settings) {
  return problem_of("state", session.switch_state(settings.state));
}

std::string inquire(LssSession& session, const Settings& settings) {
  LssAddress address;
  const LssResult result = session.inquire_address(address);
  if (!result.done()) return problem_of("inquire", result);
  const LssResult node_id = session.inquire_node_id();
  const bool has_node_id = node_id.done() && node_id.value != canopen::unconfigured_node_id.value();
  if (settings.format == "json") {
    Json json{{"schema", 2}, {"address", address_json(address)}};
    json["node_id"] = has_node_id ? Json(node_id.value) : Json(nullptr);
    print(json);
  } else {
    print_visibly(stdout, "{}, {}\n", to_text(address),
                  !node_id.done() ? "node-ID not reported"
                  : has_node_id   ? fmt::format("node-ID {}", node_id.value)
                                  : "no node-ID");
  }
  return "";
}

std::string configure_node_id(LssSession& session, const Settings& settings) {
  return problem_of("node-id", session.configure_node_id(settings.node_id));
}

std::string configure_bit_rate(LssSession& session, const Settings& settings) {
  return problem_of("bit-rate", session.configure_bit_rate(*settings.kbit));
}

std::string activate(LssSession& session, const Settings& settings) {
  return problem_of("activate", session.activate(static_cast<std::uint16_t>(settings.delay_ms)));
}

std::string store(LssSession& session, const Settings& /*settings*/) { return problem_of("store", session.store()); }

void print_found(const std::vector<LssAddress>& found) {
  Json json{{"schema", 2}, {"unconfigured", Json::array()}};
  for (const LssAddress& address : found) json["unconfigured"].push_back(address_json(address));
  print(json);
}

/// Prints the slaves found even if the search is interrupted or fails.
std::string fastscan(LssSession& session, const Settings& settings) {
  const bool text = settings.format == "text";
  std::vector<LssAddress> found;
  LssResult result;
  const auto show = [&](const LssAddress& address) {
    found.push_back(address);
    if (!text) return;
    print_visibly(stdout, "{}\n", to_text(address));
    flush_output();
  };
  try {
    result = session.find_unconfigured(show, address_of(settings), known_numbers(settings));
  } catch (...) {
    if (!text) print_found(found);
    throw;
  }
  if (!text) print_found(found);
  if (result.done() && found.empty()) result.failure = session.reason_for_silence();
  return problem_of("fastscan", result);
}

/// Configures the selected slave.
std::string assign_selected(LssSession& session, const Settings& settings) {
  std::string problem = configure_node_id(session, settings);
  if (problem.empty() && settings.kbit) problem = configure_bit_rate(session, settings);
  if (problem.empty() && settings.store) problem = store(session, settings);
  return problem;
}

/// Selects the slave with these numbers; Fastscan finds those that are not given, in `address`.
std::string select_or_find(LssSession& session, LssAddress& address, std::uint8_t known) {
  if (known == 4) return problem_of("select", session.select(address));
  LssResult found = session.find(address, known);
  if (found.is_silence) found.failure = session.reason_for_silence();
  return problem_of("fastscan", found);
}

bool is_node_id(const LssResult& inquired) {
  return inquired.done() && inquired.value != canopen::unconfigured_node_id.value();
}

/// Checks that the device has the new node-ID, after the slaves are in waiting state. A device that had another one
/// uses the new one after a reset of its communication.
std::string confirm_node_id(LssSession& session, const Settings& settings, const LssResult& before,
                            const LssResult& after) {
  constexpr canopen::Duration boot_time = canopen::from_milliseconds(2000);
  if (settings.node_id == canopen::unconfigured_node_id.value()) return "";
  if (is_node_id(before) && before.value != settings.node_id) {
    if (is_node_id(after) && after.value != settings.node_id && after.value != before.value) {
      return fmt::format("the device accepted node-ID {}, but reports {}", settings.node_id, after.value);
    }
    print_to_stderr("edsc: node-ID {} is used after \"edsc nmt BUS reset-communication {}\"\n", settings.node_id,
                    before.value);
    return "";
  }
  if (session.responds(settings.node_id, boot_time)) return "";
  return fmt::format(
      "the device accepted node-ID {}, but no node with it has sent a boot-up message or a heartbeat in two seconds, or "
      "responds to SDO",
      settings.node_id);
}

/// All slaves are in waiting state before and after.
std::string assign(LssSession& session, const Settings& settings) {
  LssAddress address = address_of(settings);
  session.switch_state(LssState::waiting);
  std::string problem = select_or_find(session, address, known_numbers(settings));
  if (!problem.empty()) return problem;
  const LssResult before = session.inquire_node_id();
  problem = assign_selected(session, settings);
  const LssResult after = problem.empty() ? session.inquire_node_id() : LssResult{};
  session.switch_state(LssState::waiting);
  if (problem.empty()) problem = confirm_node_id(session, settings, before, after);
  if (!problem.empty()) return problem;
  if (settings.format == "json") {
    print({{"schema", 2}, {"address", address_json(address)}, {"node_id", settings.node_id}});
  } else {
    print_visibly(stdout, "{}: node-ID {}{}\n", to_text(address), settings.node_id, settings.store ? ", stored" : "");
  }
  return "";
}

int run_lss(const Settings& settings) {
  return with_bus(settings.bus, [&](LiveBus& bus) {
    canopen::LssTimeouts timeouts;
    timeouts.answer = canopen::Duration{settings.timeout_ms * 1000U};
    timeouts.store = std::max(timeouts.store, timeouts.answer);
    timeouts.fastscan_step = canopen::Duration{settings.step_ms * 1000U};
    LssSession session{bus, timeouts};
    const std::string problem = settings.service(session, settings);
    if (!problem.empty()) print_to_stderr("edsc: {}\n", problem);
    bus.listen(canopen::from_milliseconds(10));  // the port may still hold the last frame
    return problem.empty() ? exit_fine : exit_device_failed;
  });
}

void add_address_options(Command command, Settings& settings, bool required) {
  const Option vendor = add_count_option(command, "--vendor", settings.vendor);
  const Option product = add_count_option(command, "--product", settings.product).needs(vendor);
  const Option revision = add_count_option(command, "--revision", settings.revision).needs(product);
  const Option serial = add_count_option(command, "--serial", settings.serial).needs(revision);
  for (const Option& option : {vendor, product, revision, serial}) option.required(required);
}

/// Highest first.
std::vector<std::string> bit_rate_words() {
  std::vector<std::string> words;
  for (auto rate = bit_rates.rbegin(); rate != bit_rates.rend(); ++rate) words.push_back(fmt::format("{}", *rate));
  return words;
}

void add_bit_rate(Command command, const std::string& name, Settings& settings, bool required) {
  std::vector<std::string> words = bit_rate_words();
  const std::string description =
      fmt::format("{}, {} or auto", fmt::join(std::span{words}.first(words.size() - 1), ", "), words.back());
  words.emplace_back("auto");
  command
      .add_text_option(
          name,
          [&settings](const std::string& text) {
            settings.kbit = text == "auto" ? automatic : parse_count(text).value_or(automatic);
          },
          name.starts_with("--") ? "" : description)
      .one_of(words)
      .required(required);
}

void add_node_id_arguments(Command command, Settings& settings) {
  add_node_argument(command, settings.written_node,
                    "the new node-ID: 1..127, a name from the network file, or 255 to remove it");
  add_network_option(command, settings.network);
}

void add_new_node_id(Command command, Settings& settings) {
  const auto parse = [](const std::string& text) {
    return parse_count(text) == 255 ? std::optional<std::uint8_t>{255} : parse_node(text);
  };
  add_parsed(command, "--node-id", settings.node_id, parse, "a node-ID from 1 to 127 or 255", "255 removes it")
      .required();
}

void add_assign_options(Command command, Settings& settings) {
  add_address_options(command, settings, false);
  add_new_node_id(command, settings);
  add_bit_rate(command, "--bit-rate", settings, false);
  command.add_flag("--store", settings.store);
  add_format_option(command, settings.format);
}

void add_fastscan_options(Command command, Settings& settings) {
  add_address_options(command, settings, false);
  add_format_option(command, settings.format);
}

void add_state_argument(Command command, Settings& settings) {
  const auto set = [&settings](const std::string& text) {
    settings.state = text == "waiting" ? LssState::waiting : LssState::configuration;
  };
  command.add_text_option("STATE", set, "waiting or configuration").required().one_of({"waiting", "configuration"});
}

void add_delay_option(Command command, Settings& settings) {
  command.add_milliseconds("--delay", settings.delay_ms, 0, std::numeric_limits<std::uint16_t>::max());
}

/// A subcommand.
struct ServiceRow {
  const char* name;
  const char* description;
  std::string (*perform)(LssSession& session, const Settings& settings);  ///< returns an error message, or nothing
  void (*add_options)(Command command, Settings& settings);
};

constexpr ServiceRow services[] = {
    {"assign", "select or find one device and configure its node-ID", assign, add_assign_options},
    {"fastscan", "find devices without node-ID, all or those with these numbers", fastscan, add_fastscan_options},
    {"select", "switch one device to configuration state", select,
     [](Command command, Settings& settings) { add_address_options(command, settings, true); }},
    {"state", "switch all devices to a state", switch_state, add_state_argument},
    {"inquire", "inquire the LSS address and node-ID of the device in configuration state", inquire,
     [](Command command, Settings& settings) { add_format_option(command, settings.format); }},
    {"node-id", "configure the node-ID of the device in configuration state", configure_node_id, add_node_id_arguments},
    {"bit-rate", "configure the bit rate of the device in configuration state", configure_bit_rate,
     [](Command command, Settings& settings) { add_bit_rate(command, "KBIT", settings, true); }},
    {"store", "store node-ID and bit rate in the device in configuration state", store, nullptr},
    {"activate", "activate the new bit rate of the devices in configuration state", activate, add_delay_option},
};

}  // namespace

void add_lss_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_lss, exit_code);
  add_bus_argument(command, settings.bus);
  add_timeout_option(command, settings.timeout_ms);
  add_step_option(command, settings.step_ms);
  for (const ServiceRow& row : services) {
    const Command service = command.add_subcommand(row.name, row.description);
    service.take_options_of_parent();
    service.on_chosen([&settings, &row] { settings.service = row.perform; });
    if (row.add_options != nullptr) row.add_options(service, settings);
  }
}

}  // namespace edsc
