#include "edit/network_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/place.hpp"
#include "document/network_drawings.hpp"
#include "network/network_members.hpp"
#include "network/timing/timing.hpp"
#include "system/path.hpp"

namespace edsc::edit {
namespace {

constexpr std::size_t max_network_findings = 500;
constexpr unsigned percent = 100;

std::string_view kind_text(MemberForm form) {
  switch (form) {
    case MemberForm::number: return "number";
    case MemberForm::flag: return "flag";
    case MemberForm::texts: return "list";
    default: return "text";
  }
}

Json offers_json(NamedInNetwork named) {
  switch (named) {
    case NamedInNetwork::nothing: return nullptr;
    case NamedInNetwork::nodes: return "nodes";
    case NamedInNetwork::entries: return "objects";
    case NamedInNetwork::receivers: return "receivers";
  }
  return nullptr;
}

/// A value of the file as the text of a form; an array as a list of texts.
Json form_value(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value;
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json list_of_form(const Json& value) {
  Json list = Json::array();
  if (!value.is_array()) {
    if (!value.is_null()) list.push_back(form_value(value));
    return list;
  }
  for (const Json& one : value) list.push_back(form_value(one));
  return list;
}

class NetworkView {
 public:
  NetworkView(const Network& network, const JsonRanges& ranges)
      : network_{network}, ranges_{ranges}, uses_{cob_id_uses(network)}, timing_{network_timing(network, uses_)} {}

  [[nodiscard]] Json view() const {
    Json groups = Json::array();
    groups.push_back(group("Network", {}));
    groups.push_back(group("SYNC", {"sync"}));
    groups.push_back(group("Assumed intervals", {"assume"}));
    return {{"groups", std::move(groups)},
            {"nodes", nodes()},
            {"signals", signals()},
            {"new_node", fields({"nodes", ""}, false)},
            {"new_signal", fields({"signals", "-"}, false)},
            {"drawing", drawing(false)},
            {"cycle", drawing(true)},
            {"load", load()}};
  }

 private:
  /// The value at a path; null if there is none.
  [[nodiscard]] Json value_at(const JsonPath& path) const {
    const auto at = ranges_.find(path);
    return at ? Json::parse(ranges_.value_text(ranges_[*at]), nullptr, false, true) : Json(nullptr);
  }

  [[nodiscard]] Json group(std::string_view title, const JsonPath& object) const {
    return {{"title", title}, {"pointer", json_pointer(object)}, {"fields", fields(object, true)}};
  }

  /// Fields of an object of the file; of a new one without pointers and values.
  [[nodiscard]] Json fields(const JsonPath& object, bool exists) const {
    Json list = Json::array();
    visit_network_members(object, [&](const auto& rows) {
      for (const auto& row : rows) {
        if (row.form() == MemberForm::values) continue;
        Json field{{"member", row.name}, {"kind", kind_text(row.form())}};
        if (exists) add_value(object, row.name, row.form(), field);
        field["hint"] = row.form() == MemberForm::number ? fmt::format("{} ({} to {})", row.meaning, row.min, row.max)
                                                         : std::string{row.meaning};
        field["offers"] = offers_json(named_in_network(object, row.name));
        list.push_back(std::move(field));
      }
    });
    return list;
  }

  void add_value(const JsonPath& object, std::string_view member, MemberForm form, Json& field) const {
    JsonPath path = object;
    path.emplace_back(member);
    const Json value = value_at(path);
    field["pointer"] = json_pointer(path);
    field["value"] = form == MemberForm::texts ? list_of_form(value) : form_value(value);
    field["present"] = ranges_.find(path).has_value();
  }

  /// The children of an object or array of the file, without members that a later one of their name replaces.
  [[nodiscard]] std::vector<JsonPath> children_of(const JsonPath& owner) const {
    std::vector<JsonPath> paths;
    const auto at = ranges_.find(owner);
    if (!at) return paths;
    const bool is_array = ranges_.is_array(ranges_[*at]);
    for (const std::size_t one : ranges_[*at].children) {
      JsonPath path = owner;
      path.push_back(is_array ? std::to_string(ranges_.place_of(one)) : ranges_[one].name);
      if (ranges_.find(path) == one) paths.push_back(std::move(path));
    }
    return paths;
  }

  [[nodiscard]] Json nodes() const {
    Json list = Json::array();
    for (const JsonPath& path : children_of({"nodes"})) {
      Json values = Json::array();
      for (const JsonPath& entry : children_of({path[0], path[1], "set"})) {
        values.push_back(
            {{"entry", entry.back()}, {"pointer", json_pointer(entry)}, {"value", form_value(value_at(entry))}});
      }
      list.push_back({{"name", path.back()},
                      {"pointer", json_pointer(path)},
                      {"fields", fields(path, true)},
                      {"values", std::move(values)},
                      {"objects", objects_of(path.back())}});
    }
    return list;
  }

  /// The entries that `set` and signals can name.
  [[nodiscard]] Json objects_of(std::string_view name) const {
    Json list = Json::array();
    const NetworkNode* const node = network_.find(name);
    if (node == nullptr || !node->has_file()) return list;
    std::map<std::pair<std::uint16_t, std::uint8_t>, const Entry*> entries;
    const auto add = [&](const std::vector<const Entry*>& some) {
      for (const Entry* one : some) entries.emplace(std::pair{one->index, one->sub_index}, one);
    };
    add(settable_entries(*node));
    add(mappable_entries(*node, canopen::Mappable::tpdo));
    add(mappable_entries(*node, canopen::Mappable::rpdo));
    for (const auto& [address, entry] : entries) {
      list.push_back({{"text", entry_label(address.first, address.second)}, {"name", entry->name}});
    }
    return list;
  }

  [[nodiscard]] Json signals() const {
    Json list = Json::array();
    for (const JsonPath& path : children_of({"signals"})) {
      list.push_back({{"title", signal_title(path)}, {"pointer", json_pointer(path)}, {"fields", fields(path, true)}});
    }
    return list;
  }

  /// `axis1.6041h to controller`; of a master without a file `controller to axis1.6040h`.
  [[nodiscard]] std::string signal_title(const JsonPath& path) const {
    const auto text = [&](const char* member) {
      return form_value(value_at({path[0], path[1], member})).get<std::string>();
    };
    std::string receivers;
    for (const Json& one : list_of_form(value_at({path[0], path[1], "to"}))) {
      receivers += (receivers.empty() ? "" : ", ") + one.get<std::string>();
    }
    const std::string from = text("from"), object = text("object");
    const NetworkNode* const sender = network_.find(from);
    if (sender == nullptr || sender->has_file()) return fmt::format("{}.{} to {}", from, object, receivers);
    return fmt::format("{} to {}{}{}", from, object, receivers.empty() ? "" : ", ", receivers);
  }

  [[nodiscard]] Json drawing(bool is_cycle) const {
    if (network_.nodes.empty()) return nullptr;
    for (const OutputFile& file : network_drawings(network_)) {
      if (file.path.ends_with("_cycle.svg") == is_cycle) return file.content;
    }
    return nullptr;
  }

  [[nodiscard]] Json load() const {
    if (timing_.messages.empty()) return nullptr;
    const double load = timing_.load.max * percent;
    const auto& max_load = network_.description.max_load;
    Json messages = Json::array();
    for (const TimedMessage& one : timing_.messages) messages.push_back(message(one));
    return {{"text", fmt::format("bus load {:.1f} % of {} kbit/s", load, network_.description.bit_rate->value)},
            {"percent", load},
            {"is_over", load > (max_load ? max_load->value : default_max_load)},
            {"messages", std::move(messages)}};
  }

  [[nodiscard]] Json message(const TimedMessage& one) const {
    const auto count = [](Nanoseconds time) { return static_cast<double>(time.count()); };
    const double period = count(one.message.period);
    constexpr double millisecond = 1e6;
    return {{"name", one.name},
            {"sender", sender_of(one)},
            {"can_id", can_id_text(one.message.can_id, one.message.extended)},
            {"load_percent", period > 0 ? count(one.response.transmission) / period * percent : 0.0},
            {"response_ms", one.response.worst ? Json(count(*one.response.worst) / millisecond) : Json(nullptr)}};
  }

  /// The node that transmits the message; empty for SDOs, which are counted once for all nodes.
  [[nodiscard]] std::string sender_of(const TimedMessage& one) const {
    if (one.service == FrameService::sdo) return "";
    const auto use = std::ranges::find_if(uses_, [&](const CobIdUse& use) {
      return use.transmits && use.service == one.service && use.can_id == one.message.can_id &&
             use.extended == one.message.extended && one.name.starts_with(use.node->name);
    });
    return use == uses_.end() ? "" : use->node->name;
  }

  const Network& network_;
  const JsonRanges& ranges_;
  std::vector<CobIdUse> uses_;
  NetworkTiming timing_;
};

/// The pointer of the member at a position.
std::string pointer_at(const SourceFile& source, const JsonRanges& ranges, const Position& position) {
  if (position.line == 0 || position.line > source.lines()) return "";
  const std::string_view line = source.line(position.line);
  const auto start = static_cast<std::size_t>(line.data() - source.text().data());
  return json_pointer(ranges.path_at(start + std::max<std::uint32_t>(position.column, 1) - 1));
}

}  // namespace

void add_network(const Network& network, const JsonRanges* ranges, EditParts& parts) {
  parts.set("network", ranges == nullptr ? Json(nullptr) : NetworkView{network, *ranges}.view());
}

Json network_finding_json(const SourceFile& source, const JsonRanges* ranges, const Diagnostic& one) {
  const Position origin = origin_of(one.position);
  const bool is_here = origin.file == &source;
  std::string message = one.message;
  if (one.places > 1) message += fmt::format(" (at {} places)", one.places);
  if (!is_here && origin.file != nullptr) {
    const std::string name = from_native(to_native(origin.file->name()).filename());
    message =
        origin.line == 0 ? fmt::format("{}: {}", name, message) : fmt::format("{}:{}: {}", name, origin.line, message);
  }
  return {{"severity", to_string(one.severity)},
          {"rule", one.rule.text()},
          {"message", std::move(message)},
          {"line", is_here ? origin.line : 0},
          {"section", is_here && ranges != nullptr ? pointer_at(source, *ranges, origin) : ""},
          {"object", ""},
          {"fixes", Json::array()}};
}

void add_network_findings(const SourceFile& source, const JsonRanges* ranges, const Diagnostics& diagnostics,
                          EditParts& parts) {
  Json list = Json::array();
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    for (const Diagnostic& one : diagnostics.all()) {
      if (one.severity != severity || list.size() == max_network_findings) continue;
      Json finding = network_finding_json(source, ranges, one);
      finding["id"] = list.size();
      list.push_back(std::move(finding));
    }
  }
  const std::size_t total = diagnostics.errors() + diagnostics.warnings() + diagnostics.notes();
  const std::size_t more = total - std::min(total, list.size());
  parts.set("findings", {{"errors", diagnostics.errors()},
                         {"warnings", diagnostics.warnings()},
                         {"list", std::move(list)},
                         {"more", more}});
}

}  // namespace edsc::edit
