#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "online/lss_session.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_options.hpp"
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
  edsc lss socketcan:can0 activate --delay 500
  edsc lss socketcan:can0 state waiting)";

constexpr unsigned automatic = 0;

struct Settings {
  std::string bus;
  unsigned timeout_ms = 100;
  unsigned step_ms = 20;
  std::string format = "text";
  std::optional<std::uint32_t> vendor, product, revision, serial;
  unsigned node_id = 0;
  std::optional<unsigned> kbit;
  bool store = false;
  std::uint16_t delay_ms = 500;
  LssState state = LssState::waiting;
};

using Json = nlohmann::ordered_json;
using Step = std::function<int(LssSession&, const Settings&)>;

int failed(std::string_view service, const LssResult& result) {
  print_visibly(stderr, "edsc: {}: {}\n", service, result.failure);
  return exit_device_failed;
}

int done_or_failed(std::string_view service, const LssResult& result) {
  return result.done() ? exit_fine : failed(service, result);
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

int select(LssSession& session, const Settings& settings) {
  return done_or_failed("select", session.select(address_of(settings)));
}

int switch_state(LssSession& session, const Settings& settings) {
  return done_or_failed("state", session.switch_state(settings.state));
}

int inquire(LssSession& session, const Settings& settings) {
  LssAddress address;
  if (const LssResult result = session.inquire_address(address); !result.done()) return failed("inquire", result);
  const LssResult node_id = session.inquire_node_id();
  const bool has_node_id = node_id.done() && node_id.value != canopen::unconfigured_node_id.value();
  if (settings.format == "json") {
    Json json{{"version", 1}, {"address", address_json(address)}};
    json["node_id"] = has_node_id ? Json(node_id.value) : Json(nullptr);
    print(json);
  } else {
    print_visibly(stdout, "{}, {}\n", to_text(address),
                  !node_id.done() ? "node-ID not reported"
                  : has_node_id   ? fmt::format("node-ID {}", node_id.value)
                                  : "no node-ID");
  }
  return exit_fine;
}

int configure_node_id(LssSession& session, const Settings& settings) {
  return done_or_failed("node-id", session.configure_node_id(static_cast<std::uint8_t>(settings.node_id)));
}

int configure_bit_rate(LssSession& session, const Settings& settings) {
  return done_or_failed("bit-rate", session.configure_bit_rate(*settings.kbit));
}

int activate(LssSession& session, const Settings& settings) {
  return done_or_failed("activate", session.activate(settings.delay_ms));
}

int store(LssSession& session, const Settings& /*settings*/) { return done_or_failed("store", session.store()); }

void print_found(const std::vector<LssAddress>& found) {
  Json json{{"version", 1}, {"unconfigured", Json::array()}};
  for (const LssAddress& address : found) json["unconfigured"].push_back(address_json(address));
  print(json);
}

/// Prints the slaves found even if the search is interrupted or fails.
int fastscan(LssSession& session, const Settings& settings) {
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
  if (!result.done()) return failed("fastscan", result);
  if (!found.empty()) return exit_fine;
  return failed("fastscan", {session.reason_for_silence(), 0});
}

/// Configures the selected slave.
int assign_selected(LssSession& session, const Settings& settings) {
  if (const LssResult result = session.configure_node_id(static_cast<std::uint8_t>(settings.node_id)); !result.done()) {
    return failed("node-id", result);
  }
  if (settings.kbit) {
    if (const LssResult result = session.configure_bit_rate(*settings.kbit); !result.done()) {
      return failed("bit-rate", result);
    }
  }
  return settings.store ? done_or_failed("store", session.store()) : exit_fine;
}

/// Fastscan finds the numbers that are not given. All slaves are in waiting state before and after.
int assign(LssSession& session, const Settings& settings) {
  LssAddress address = address_of(settings);
  const std::uint8_t known = known_numbers(settings);
  session.switch_state(LssState::waiting);
  const LssResult found = known == 4 ? session.select(address) : session.fastscan(address, known);
  if (!found.done() && known != 4) return failed("fastscan", {session.reason_for_silence(), 0});
  if (!found.done()) return failed("select", found);
  if (known != 4) {
    if (const LssResult confirmed = session.confirm(address); !confirmed.done()) {
      session.switch_state(LssState::waiting);
      return failed("fastscan", confirmed);
    }
  }
  const int exit_code = assign_selected(session, settings);
  session.switch_state(LssState::waiting);
  if (exit_code != exit_fine) return exit_code;
  if (settings.format == "json") {
    print({{"version", 1}, {"address", address_json(address)}, {"node_id", settings.node_id}});
  } else {
    print_visibly(stdout, "{}: node-ID {}{}\n", to_text(address), settings.node_id, settings.store ? ", stored" : "");
  }
  return exit_fine;
}

int run_lss(const Settings& settings, const Step& step) {
  return with_bus(settings.bus, [&](LiveBus& bus) {
    canopen::LssTimeouts timeouts;
    timeouts.answer = canopen::Duration{settings.timeout_ms * 1000U};
    timeouts.store = std::max(timeouts.store, timeouts.answer);
    timeouts.fastscan_step = canopen::Duration{settings.step_ms * 1000U};
    LssSession session{bus, timeouts};
    const int exit_code = step(session, settings);
    bus.listen(canopen::from_milliseconds(10));  // the port may still hold the last frame
    return exit_code;
  });
}

void add_address_options(CLI::App& command, Settings& settings, bool required) {
  auto* vendor = add_count_option(command, "--vendor", settings.vendor, "vendor-ID, 1018h:01");
  auto* product = add_count_option(command, "--product", settings.product, "product code, 1018h:02")->needs(vendor);
  auto* revision =
      add_count_option(command, "--revision", settings.revision, "revision number, 1018h:03")->needs(product);
  auto* serial = add_count_option(command, "--serial", settings.serial, "serial number, 1018h:04")->needs(revision);
  for (CLI::Option* option : {vendor, product, revision, serial}) option->required(required);
}

CLI::Option* add_bit_rate(CLI::App& command, const std::string& name, Settings& settings) {
  return command
      .add_option_function<std::string>(
          name,
          [&settings](const std::string& text) {
            settings.kbit = text == "auto" ? automatic : parse_count(text).value_or(automatic);
          },
          "1000, 800, 500, 250, 125, 50, 20 or 10 kbit/s, or auto")
      ->check(CLI::IsMember({"1000", "800", "500", "250", "125", "50", "20", "10", "auto"}));
}

CLI::Option* add_new_node_id(CLI::App& command, const std::string& name, Settings& settings) {
  return command
      .add_option_function<std::string>(
          name, [&settings](const std::string& text) { settings.node_id = parse_count(text).value_or(0); },
          "the new node-ID: 1..127, or 255 to remove it")
      ->check([](const std::string& text) {
        const auto number = parse_count(text, 255).value_or(0);
        const bool known = (number >= 1 && number <= 127) || number == 255;
        return known ? std::string{} : "\"" + text + "\" is not a node-ID from 1 to 127 or 255";
      });
}

}  // namespace

void add_lss_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("lss", "configure node-ID and bit rate of devices (CiA 305)");
  command->footer(examples);
  command->require_subcommand(1);
  auto settings = std::make_shared<Settings>();
  add_bus_argument(*command, settings->bus);
  add_timeout_option(*command, settings->timeout_ms);
  add_step_option(*command, settings->step_ms);
  const auto add = [&](const char* name, const char* description, const Step& step) {
    CLI::App* service = command->add_subcommand(name, description);
    service->fallthrough();
    service->callback([settings, step, &exit_code] { exit_code = run_lss(*settings, step); });
    return service;
  };
  const auto with_json = [&](CLI::App* service) { add_format_option(*service, settings->format); };

  CLI::App* assigned = add("assign", "select or find one device and configure its node-ID", assign);
  add_address_options(*assigned, *settings, false);
  add_new_node_id(*assigned, "--node-id", *settings)->required();
  add_bit_rate(*assigned, "--bit-rate", *settings);
  assigned->add_flag("--store", settings->store, "store the node-ID in the device");
  with_json(assigned);
  CLI::App* found = add("fastscan", "find devices without node-ID, all or those with these numbers", fastscan);
  add_address_options(*found, *settings, false);
  with_json(found);
  add_address_options(*add("select", "switch one device to configuration state", select), *settings, true);
  add("state", "switch all devices to a state", switch_state)
      ->add_option_function<std::string>(
          "STATE",
          [settings](const std::string& text) {
            settings->state = text == "waiting" ? LssState::waiting : LssState::configuration;
          },
          "waiting or configuration")
      ->required()
      ->check(CLI::IsMember({"waiting", "configuration"}));
  with_json(add("inquire", "inquire the LSS address and node-ID of the device in configuration state", inquire));
  add_new_node_id(*add("node-id", "configure the node-ID of the device in configuration state", configure_node_id),
                  "NODE", *settings)
      ->required();
  add_bit_rate(*add("bit-rate", "configure the bit rate of the device in configuration state", configure_bit_rate),
               "KBIT", *settings)
      ->required();
  add("store", "store node-ID and bit rate in the device in configuration state", store);
  add("activate", "activate the new bit rate of the devices in configuration state", activate)
      ->add_option("--delay", settings->delay_ms, "switch delay in ms, before and after the switch")
      ->capture_default_str();
}

}  // namespace edsc
