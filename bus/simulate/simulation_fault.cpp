#include "simulate/simulation_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <system_error>

#include "diagnostics/quote.hpp"
#include "text/duration.hpp"

namespace edsc {
namespace {

/// Bounds are computed for whole milliseconds.
constexpr std::uint64_t min_error_interval = 1000;

std::string wrong_form(std::string_view text, const FaultRow& row) {
  return fmt::format("{} is not a fault; expected {}:{}, where TIME is {}", quote(text), row.name, row.form,
                     duration_form);
}

/// The text before and after the last separator; nothing without one.
std::optional<std::pair<std::string_view, std::string_view>> split(std::string_view text, char separator) {
  const std::size_t at = text.rfind(separator);
  if (at == std::string_view::npos) return std::nullopt;
  return std::pair{text.substr(0, at), text.substr(at + 1)};
}

std::string parse_node_fault(std::string_view rest, const FaultRow& row, const Network& network,
                             SimulationFault& fault) {
  const auto parts = split(rest, '@');
  const auto time = parts ? parse_simulated_time(parts->second) : std::nullopt;
  if (!time) return wrong_form(fault.text, row);
  const NetworkNode* const node = network.find(parts->first);
  if (node == nullptr) return network.unknown_node(parts->first);
  fault.node = static_cast<std::size_t>(node - network.nodes.data());
  fault.time_us = *time;
  return {};
}

std::string parse_errors(std::string_view rest, const FaultRow& row, SimulationFault& fault) {
  const auto parts = split(rest, '/');
  const auto time = parts ? parse_simulated_time(parts->second) : std::nullopt;
  std::uint32_t count = 0;
  if (time) (void)std::from_chars(parts->first.data(), parts->first.data() + parts->first.size(), count);
  if (count == 0 || std::to_string(count) != parts->first) return wrong_form(fault.text, row);
  fault.time_us = *time / count;
  if (fault.time_us >= min_error_interval) return {};
  return fmt::format("{}: errors must be at least {} us apart", quote(fault.text), min_error_interval);
}

}  // namespace

std::optional<std::uint64_t> parse_simulated_time(std::string_view text) {
  const auto time = parse_duration(text);
  return time && *time >= 1 && *time <= max_simulated_us ? time : std::nullopt;
}

std::string parse_fault(std::string_view text, const Network& network, SimulationFault& fault) {
  fault.text = text;
  const std::size_t colon = text.find(':');
  const auto* const row = std::ranges::find(fault_rows, text.substr(0, colon), &FaultRow::name);
  if (row == std::end(fault_rows) || colon == std::string_view::npos) {
    return fmt::format("{} is not a fault; expected {}", quote(text), fault_forms());
  }
  fault.kind = row->kind;
  const std::string_view rest = text.substr(colon + 1);
  return row->kind == FaultKind::errors ? parse_errors(rest, *row, fault)
                                        : parse_node_fault(rest, *row, network, fault);
}

std::string fault_forms() {
  std::string forms;
  for (const FaultRow& row : fault_rows) {
    forms += fmt::format("{}{}:{}", forms.empty() ? "" : ", ", row.name, row.form);
  }
  return forms;
}

}  // namespace edsc
