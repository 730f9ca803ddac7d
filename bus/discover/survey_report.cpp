#include "discover/survey_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/append.hpp"
#include "values/nmt_text.hpp"

namespace edsc::discover {
namespace {

using json = nlohmann::ordered_json;

template <class Visit>
void for_each_node(const BusSurvey& survey, Visit&& visit) {
  for (const FoundNode& node : survey.found_nodes()) visit(node, survey.node(node.node_id));
}

std::string period_text(std::int64_t us) { return audit::milliseconds(us); }

/// `at each SYNC`, `every 50 ms`
std::string transmission_text(const GuessedPdo& guessed) {
  switch (guessed.transmission) {
    case Transmission::sync:
      return guessed.every_sync == 1 ? "at each SYNC" : fmt::format("every {} SYNCs", guessed.every_sync);
    case Transmission::timed: return "every " + period_text(*guessed.period_us);
    case Transmission::event: return "at events";
    case Transmission::unknown: break;
  }
  return "too few frames";
}

/// `TPDO 1 of node 5, by its default COB-ID`
std::string owner_text(const GuessedPdo& guessed) {
  if (guessed.source == PdoSource::none) return "sender unknown";
  return fmt::format(
      "{}PDO {} of node {}, by {}", guessed.is_tpdo ? 'T' : 'R', guessed.number, guessed.node_id,
      guessed.source == PdoSource::parameters ? "its parameters in SDO transfers" : "the pre-defined connection set");
}

std::string bytes_text(const SurveyedPdo& pdo) {
  if (pdo.min_bytes == pdo.max_bytes) return counted(unsigned{pdo.max_bytes}, "byte");
  return fmt::format("{} to {} bytes", pdo.min_bytes, pdo.max_bytes);
}

std::string can_id_text(const canopen::Frame& frame) {
  std::string text;
  append_can_id(text, frame);
  return text + "h";
}

std::string node_text(const BusSurvey& survey, const FoundNode& node, const SurveyedNode& seen) {
  std::string text = fmt::format("  node {}", node.node_id);
  if (seen.name) text += fmt::format(" \"{}\"", printable(*seen.name));
  text += ": ";
  text += seen.state ? nmt_state_text(*seen.state) : "NMT state unknown";
  if (const auto period = survey.heartbeat_period_us(node.node_id)) text += ", heartbeat every " + period_text(*period);
  if (seen.boot_ups > 0) text += ", " + counted(seen.boot_ups, "boot-up");
  if (seen.emergencies > 0) text += fmt::format(", {} EMCY", seen.emergencies);
  std::string_view separator = "; ";
  for (const IdentityNumber& number : identity_numbers) {
    const auto& value = node.identity.*number.value;
    if (!value) continue;
    text += fmt::format("{}{} {:08X}h", separator, number.name, *value);
    separator = ", ";
  }
  return text + '\n';
}

json or_null(bool has, json value) { return has ? std::move(value) : json(nullptr); }

json node_json(const BusSurvey& survey, const FoundNode& node, const SurveyedNode& seen) {
  const auto period = survey.heartbeat_period_us(node.node_id);
  json one = {{"node_id", node.node_id},
              {"state", seen.state ? json(nmt_state_text(*seen.state)) : json(nullptr)},
              {"heartbeat_period_us", period ? json(*period) : json(nullptr)},
              {"boot_ups", seen.boot_ups},
              {"emergencies", seen.emergencies},
              {"name", seen.name ? json(printable(*seen.name)) : json(nullptr)}};
  for (const IdentityNumber& number : identity_numbers) {
    const auto& value = node.identity.*number.value;
    one[std::string{number.key}] = value ? json(*value) : json(nullptr);
  }
  return one;
}

json pdo_json(const SurveyedPdo& pdo, const GuessedPdo& guessed) {
  constexpr std::string_view sources[] = {"", "parameters", "default_cob_id"};
  const bool is_known = guessed.source != PdoSource::none;
  return {{"can_id", pdo.frame.id},
          {"extended", pdo.frame.extended},
          {"text", fmt::format("{}, {}, {}", can_id_text(pdo.frame), transmission_text(guessed), owner_text(guessed))},
          {"min_bytes", pdo.min_bytes},
          {"max_bytes", pdo.max_bytes},
          {"frames", pdo.frames},
          {"transmission", to_text(guessed.transmission)},
          {"every_sync", or_null(guessed.transmission == Transmission::sync, guessed.every_sync)},
          {"period_us", guessed.period_us ? json(*guessed.period_us) : json(nullptr)},
          {"node_id", or_null(is_known, guessed.node_id)},
          {"direction", or_null(is_known, guessed.is_tpdo ? "transmit" : "receive")},
          {"number", or_null(is_known, guessed.number)},
          {"known_by", or_null(is_known, sources[static_cast<std::size_t>(guessed.source)])}};
}

/// Adds the members that the report and the network file have in common.
void add_guesses(const BusSurvey& survey, json& document) {
  document["sync"] = nullptr;
  if (survey.syncs() > 0) {
    const auto period = survey.sync_period_us();
    document["sync"] = {{"period_us", period ? json(*period) : json(nullptr)},
                        {"has_counter", survey.has_sync_counter()}};
  }
  document["nodes"] = json::array();
  for_each_node(survey, [&](const FoundNode& node, const SurveyedNode& seen) {
    document["nodes"].push_back(node_json(survey, node, seen));
  });
  document["pdos"] = json::array();
  for (const auto& [cob_id, pdo] : survey.pdos()) document["pdos"].push_back(pdo_json(pdo, survey.guess(pdo)));
}

}  // namespace

std::string text_report(const BusSurvey& survey, const std::string& source) {
  std::string text = fmt::format("{}: {}", printable(source), counted(survey.frames(), "frame"));
  if (const auto us = survey.duration_us()) text += fmt::format(" in {}.{:03} s", *us / 1'000'000, *us / 1000 % 1000);
  const std::size_t nodes = survey.found_nodes().size();
  text += fmt::format(", {}\n", counted(nodes, "node"));
  for_each_node(survey,
                [&](const FoundNode& node, const SurveyedNode& seen) { text += node_text(survey, node, seen); });
  if (survey.syncs() > 0) {
    const auto period = survey.sync_period_us();
    text += fmt::format("  SYNC: {}{}\n", period ? "every " + period_text(*period) : std::string{"period unknown"},
                        survey.has_sync_counter() ? ", with counter" : "");
  }
  if (survey.time_messages() > 0) text += fmt::format("  TIME: {}\n", counted(survey.time_messages(), "frame"));
  if (survey.nmt_commands() > 0) text += fmt::format("  NMT: {}\n", counted(survey.nmt_commands(), "command"));
  for (const auto& [cob_id, pdo] : survey.pdos()) {
    const GuessedPdo guessed = survey.guess(pdo);
    text += fmt::format("  CAN-ID {}: {} of {}, {}; {}\n", can_id_text(pdo.frame), counted(pdo.frames, "frame"),
                        bytes_text(pdo), transmission_text(guessed), owner_text(guessed));
  }
  return text;
}

std::string json_report(const BusSurvey& survey, const std::string& source) {
  const auto duration = survey.duration_us();
  json document = {{"schema", 2},
                   {"source", printable(source)},
                   {"frames", survey.frames()},
                   {"duration_us", duration ? json(*duration) : json(nullptr)},
                   {"nmt_commands", survey.nmt_commands()},
                   {"timestamps", survey.time_messages()}};
  add_guesses(survey, document);
  return json_text(document) + '\n';
}

std::string guessed_member(const BusSurvey& survey) {
  json document = json::object();
  add_guesses(survey, document);
  return json_text(document);
}

}  // namespace edsc::discover
