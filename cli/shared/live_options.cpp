#include "shared/live_options.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include "online/live_entry.hpp"

namespace edsc {
namespace {

std::optional<std::uint8_t> parse_node(const std::string& text) {
  const auto number = parse_count(text, 127);
  if (!number || *number == 0) return std::nullopt;
  return static_cast<std::uint8_t>(*number);
}

}  // namespace

CLI::Option* add_bus_argument(CLI::App& command, std::string& bus) {
  return command
      .add_option("BUS", bus,
                  "socketcan:can0, slcan:/dev/ttyACM0, socketcand:127.0.0.1:29536/vcan0, or "
                  "simulated:PROGRAM@NODE-ID for a device in simulated time")
      ->required();
}

CLI::Option* add_node_argument(CLI::App& command, std::uint8_t& node) {
  return command
      .add_option_function<std::string>(
          "NODE", [&node](const std::string& text) { node = parse_node(text).value_or(0); }, "node-ID, 1..127")
      ->required()
      ->check([](const std::string& text) {
        return parse_node(text) ? std::string{} : "\"" + text + "\" is not a node-ID from 1 to 127";
      });
}

CLI::Option* add_timeout_option(CLI::App& command, unsigned& milliseconds) {
  return command.add_option("--timeout", milliseconds, "ms to wait for a response of a device")
      ->check(CLI::Range(1, 600'000))
      ->capture_default_str();
}

CLI::Option* add_step_option(CLI::App& command, unsigned& milliseconds) {
  return command.add_option("--step", milliseconds, "ms to wait in each step of Fastscan; more on a slow bus")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
}

CLI::Option* add_format_option(CLI::App& command, std::string& format) {
  return command.add_option("--format", format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
}

CLI::Option* add_type_option(CLI::App& command, const canopen::DataTypeRow*& type) {
  return command
      .add_option_function<std::string>(
          "--type", [&type](const std::string& text) { type = find_type(text); },
          "data type instead of that of the EDS: bool, u8..u64, i8..i64, f32, f64, string, unicode, octets, time, "
          "span, domain")
      ->check([](const std::string& text) {
        return find_type(text) != nullptr ? std::string{} : "\"" + text + "\" is not a data type";
      });
}

std::optional<std::uint32_t> parse_count(const std::string& text, std::uint32_t most) {
  std::string_view digits{text};
  int base = 10;
  if (digits.starts_with("0x") || digits.starts_with("0X")) {
    digits.remove_prefix(2);
    base = 16;
  } else if (digits.ends_with('h') || digits.ends_with('H')) {
    digits.remove_suffix(1);
    base = 16;
  }
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
  if (error != std::errc{} || end != digits.data() + digits.size() || number > most) return std::nullopt;
  return number;
}

std::vector<std::uint8_t> parse_node_list(const std::string& text) {
  std::set<std::uint8_t> nodes;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, comma - begin);
    const std::size_t dots = part.find("..");
    const auto first = parse_node(part.substr(0, dots));
    const auto last = dots == std::string::npos ? first : parse_node(part.substr(dots + 2));
    if (!first || !last || *first > *last) return {};
    for (unsigned node = *first; node <= *last; ++node) nodes.insert(static_cast<std::uint8_t>(node));
    begin = comma + 1;
  }
  return {nodes.begin(), nodes.end()};
}

CLI::Option* add_count_option(CLI::App& command, const std::string& name, std::optional<std::uint32_t>& number,
                              const std::string& description) {
  return command
      .add_option_function<std::string>(
          name, [&number](const std::string& text) { number = parse_count(text); }, description)
      ->check([](const std::string& text) {
        return parse_count(text) ? std::string{} : "\"" + text + "\" is not a number; expected 31, 0x1F or 1Fh";
      });
}

}  // namespace edsc
