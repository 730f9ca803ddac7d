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

class NetworkView {
 public:
  NetworkView(const Network& network, const JsonRanges& ranges)
      : network_{network}, ranges_{ranges}, uses_{cob_id_uses(network)}, timing_{network_timing(network, uses_)} {}

  [[nodiscard]] Json view() {
    Json groups = Json::array();
    groups.push_back(group("Network", {}));
    groups.push_back(group("SYNC", {"sync"}));
    groups.push_back(group("Assumed intervals", {"assume"}));
    return {{"groups", std::move(groups)},
            {"nodes", nodes()},
            {"signals", signals()},
            {"new_node", fields_of_new({"nodes", ""})},
            {"new_signal", fields_of_new({"signals", "-"})},
            {"drawing", drawing(false)},
            {"cycle", drawing(true)},
            {"load", load()}};
  }

  /// The lists of entries that the nodes of the view name by their place.
  [[nodiscard]] Json entry_lists() const {
    Json lists = Json::array();
    for (const EntryNames& names : entry_lists_) {
      Json list = Json::array();
      for (const auto& [address, name] : names) {
        list.push_back({{"text", entry_label(address.first, address.second)}, {"name", name}});
      }
      lists.push_back(std::move(list));
    }
    return lists;
  }

 private:
  using EntryNames = std::map<std::pair<std::uint16_t, std::uint8_t>, std::string_view>;
  using Found = std::optional<std::size_t>;  ///< an index of `ranges_`

  [[nodiscard]] Found member_of(Found object, std::string_view name) const {
    return object ? ranges_.child(*object, name) : std::nullopt;
  }
  [[nodiscard]] bool is_list(Found value) const { return value && ranges_.is_array(ranges_[*value]); }

  /// A value as the text of a form, also one that the member cannot have.
  [[nodiscard]] std::string form_text_of(Found value) const {
    if (!value) return "";
    const std::string_view text = ranges_.value_text(ranges_[*value]);
    if (text == "true") return "1";
    if (text == "false") return "0";
    return text.starts_with('"') ? Json::parse(text).get<std::string>() : std::string{text};
  }

  /// The texts of an array; a single text is a list of one.
  [[nodiscard]] std::vector<std::string> form_list_of(Found value) const {
    std::vector<std::string> list;
    if (!value) return list;
    if (!is_list(value)) return {form_text_of(value)};
    for (const std::size_t one : ranges_[*value].children) list.push_back(form_text_of(one));
    return list;
  }

  [[nodiscard]] Json group(std::string_view title, const JsonPath& object) const {
    return {{"title", title}, {"pointer", json_pointer(object)}, {"fields", fields(object, ranges_.find(object))}};
  }

  /// The fields of an object of the file, or of a part of it that is missing.
  [[nodiscard]] Json fields(const JsonPath& path, Found object) const {
    Json list = fields_of_new(path);
    for (Json& field : list) {
      JsonPath of_member = path;
      of_member.push_back(field["member"].get<std::string>());
      const Found value = member_of(object, of_member.back());
      field["pointer"] = json_pointer(of_member);
      field["value"] = field["kind"] == "list" ? Json(form_list_of(value)) : Json(form_text_of(value));
      field["present"] = value.has_value();
    }
    return list;
  }

  /// Without pointers and values.
  [[nodiscard]] static Json fields_of_new(const JsonPath& path) {
    Json list = Json::array();
    visit_network_members(path, [&](const auto& rows) {
      for (const auto& row : rows) {
        if (row.form() == MemberForm::values) continue;
        std::string hint{row.meaning};
        if (row.form() == MemberForm::number) hint += fmt::format(" ({} to {})", row.min, row.max);
        list.push_back({{"member", row.name},
                        {"kind", kind_text(row.form())},
                        {"hint", std::move(hint)},
                        {"offers", offers_json(named_in_network(path, row.name))}});
      }
    });
    return list;
  }

  [[nodiscard]] Json nodes() {
    Json list = Json::array();
    const Found nodes = ranges_.find({"nodes"});
    if (!nodes || is_list(nodes)) return list;
    for (const std::size_t node : ranges_[*nodes].children) {
      const std::string& name = ranges_[node].name;
      if (ranges_.child(*nodes, name) != node) continue;  // a later member of this name replaces it
      const JsonPath path{"nodes", name};
      list.push_back({{"name", name},
                      {"pointer", json_pointer(path)},
                      {"fields", fields(path, node)},
                      {"values", values(path, member_of(node, "set"))},
                      {"objects", objects_of(name)}});
    }
    return list;
  }

  [[nodiscard]] Json values(const JsonPath& node, Found set) const {
    Json list = Json::array();
    if (!set || is_list(set)) return list;
    for (const std::size_t one : ranges_[*set].children) {
      const std::string& entry = ranges_[one].name;
      if (ranges_.child(*set, entry) != one) continue;
      list.push_back({{"entry", entry},
                      {"pointer", json_pointer({node[0], node[1], "set", entry})},
                      {"value", form_text_of(one)}});
    }
    return list;
  }

  /// The place of the list of entries that `set` and signals can name; null without a file. Nodes of one EDS have one
  /// list.
  [[nodiscard]] Json objects_of(std::string_view name) {
    const NetworkNode* const node = network_.find(name);
    if (node == nullptr || !node->has_file()) return nullptr;
    EntryNames names;
    const auto add = [&](const std::vector<const Entry*>& some) {
      for (const Entry* one : some) names.emplace(std::pair{one->index, one->sub_index}, one->name);
    };
    add(settable_entries(*node));
    add(mappable_entries(*node, canopen::Mappable::tpdo));
    add(mappable_entries(*node, canopen::Mappable::rpdo));
    const auto known = std::ranges::find(entry_lists_, names);
    const auto place = static_cast<std::size_t>(known - entry_lists_.begin());
    if (known == entry_lists_.end()) entry_lists_.push_back(std::move(names));
    return place;
  }

  [[nodiscard]] Json signals() const {
    Json list = Json::array();
    const Found signals = ranges_.find({"signals"});
    if (!is_list(signals)) return list;
    for (const std::size_t signal : ranges_[*signals].children) {
      const JsonPath path{"signals", std::to_string(list.size())};
      list.push_back(
          {{"title", signal_title(signal)}, {"pointer", json_pointer(path)}, {"fields", fields(path, signal)}});
    }
    return list;
  }

  /// `axis1.6041h to controller`; of a master without a file `controller to axis1.6040h`.
  [[nodiscard]] std::string signal_title(std::size_t signal) const {
    const std::string from = form_text_of(member_of(signal, "from")),
                      object = form_text_of(member_of(signal, "object"));
    const std::string receivers = fmt::format("{}", fmt::join(form_list_of(member_of(signal, "to")), ", "));
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
    const auto sender = std::ranges::find_if(uses_, [&](const CobIdUse& use) {
      return use.transmits && use.service == one.service && use.can_id == one.message.can_id &&
             use.extended == one.message.extended && one.name.starts_with(use.node->name);
    });
    return sender == uses_.end() ? "" : sender->node->name;
  }

  const Network& network_;
  const JsonRanges& ranges_;
  std::vector<CobIdUse> uses_;
  NetworkTiming timing_;
  std::vector<EntryNames> entry_lists_;
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
  if (ranges == nullptr) {
    parts.set("network", nullptr);
    parts.set("entries", {{"lists", Json::array()}});
    return;
  }
  NetworkView view{network, *ranges};
  parts.set("network", view.view());
  parts.set("entries", {{"lists", view.entry_lists()}});
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
