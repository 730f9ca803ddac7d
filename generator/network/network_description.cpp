#include "network/network_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "diagnostics/quote.hpp"
#include "json/json_file.hpp"
#include "text/ascii.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

using Json = JsonFile::Json;

/// A number or text of `set` in the notation of an EDS.
std::optional<std::string> eds_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_number()) return value.dump();
  return std::nullopt;
}

constexpr std::size_t max_name_length = 64;
constexpr std::size_t max_nodes = 127;

/// A name is also that of files and, without its blanks, of C++. Bytes above 7Fh are parts of letters in UTF-8;
/// characters that an editor hides, such as those that change the text direction, are not letters.
bool is_node_name(std::string_view name) {
  const auto is_valid = [](char one) {
    const auto byte = static_cast<unsigned char>(one);
    return byte >= 0x80 || (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
           (byte >= 'a' && byte <= 'z') || byte == '_' || byte == '-' || byte == ' ';
  };
  return !name.empty() && name.size() <= max_name_length && name.front() != ' ' && name.back() != ' ' &&
         std::ranges::all_of(name, is_valid) && printable(name) == name;
}

std::string in_lower_case(std::string_view name) {
  std::string out{name};
  for (char& c : out) c = to_lower(c);
  return out;
}

class NetworkReader {
 public:
  NetworkReader(const JsonFile& file, Diagnostics& diagnostics) : file_{file}, diagnostics_{diagnostics} {}

  NetworkDescription read() {
    NetworkDescription network;
    network.source = &file_.source();
    const Json& root = file_.root();
    if (!root.is_object()) {
      error(root, "a network file is a JSON object");
      return network;
    }
    read_members(root, network, network_members, {"$schema", "sync", "assume", "nodes", "signals", "guessed"});
    object_at(root, "guessed");  // of edsc discover, for people
    if (const Json* const sync = object_at(root, "sync")) {
      read_members(*sync, network.sync, sync_members, {});
    }
    if (const WrittenNumber& overflow = network.sync.overflow; overflow && overflow->value == 1) {
      value_error(root["sync"]["overflow"], "\"overflow\" must be 0 or a number from 2 to 240: 1 is reserved");
      network.sync.overflow.reset();
    }
    if (const Json* const assume = object_at(root, "assume")) {
      read_members(*assume, network.assume, assume_members, {});
    }
    read_nodes(root, network);
    read_signals(root, network);
    if (!root.contains("bit_rate")) error(root, "missing \"bit_rate\", the bit rate in kbit/s");
    return network;
  }

 private:
  using Names = std::initializer_list<std::string_view>;

  void error(const Json& json, std::string message) {
    diagnostics_.error("network-file", file_.name_position(json), std::move(message));
  }
  void value_error(const Json& json, std::string message) {
    diagnostics_.error("network-file", file_.value_position(json), std::move(message));
  }

  /// The member if it is an object; any other value is an error.
  const Json* object_at(const Json& owner, const std::string& name) {
    const auto at = owner.find(name);
    if (at == owner.end()) return nullptr;
    if (at->is_object()) return &*at;
    error(*at, fmt::format("{} must be an object", quote(name)));
    return nullptr;
  }

  template <class Owner, std::size_t N>
  void read_members(const Json& json, Owner& owner, const MemberRow<Owner> (&rows)[N], Names others) {
    for (const auto& [name, value] : file_.members(json)) {
      const auto row = std::ranges::find(rows, std::string_view{name}, &MemberRow<Owner>::name);
      if (row != std::end(rows)) {
        read_member(*value, owner, *row);
      } else if (std::ranges::find(others, name) == others.end()) {
        std::vector<std::string_view> names{others};
        for (const MemberRow<Owner>& one : rows) names.push_back(one.name);
        error(*value, fmt::format("unknown member {}{}", quote(name), did_you_mean(name, names)));
      }
    }
  }

  template <class Owner>
  void read_member(const Json& value, Owner& owner, const MemberRow<Owner>& row) {
    const Position position = file_.value_position(value);
    const auto expect = [&](bool is_valid, std::string_view what) {
      if (!is_valid) value_error(value, fmt::format("{} must be {}", quote(row.name), what));
      return is_valid;
    };
    switch (row.form()) {
      case MemberForm::number: {
        const bool fits = value.is_number_unsigned() && value >= row.min && value <= row.max;
        if (!expect(fits, fmt::format("a number from {} to {}", row.min, row.max))) return;
        owner.*std::get<typename MemberRow<Owner>::Number>(row.member) =
            Written<std::uint32_t>{value.template get<std::uint32_t>(), position};
        return;
      }
      case MemberForm::text:
        if (!expect(value.is_string(), "a text")) return;
        owner.*std::get<typename MemberRow<Owner>::Text>(row.member) =
            Written<std::string>{value.template get<std::string>(), position};
        return;
      case MemberForm::flag:
        if (!expect(value.is_boolean(), "true or false")) return;
        owner.*std::get<typename MemberRow<Owner>::Flag>(row.member) =
            Written<bool>{value.template get<bool>(), position};
        return;
      case MemberForm::texts:
        owner.*std::get<typename MemberRow<Owner>::Texts>(row.member) = read_texts(value, row.name);
        return;
      case MemberForm::values:
        if (!expect(value.is_object(), "an object with a value for each entry")) return;
        owner.*std::get<typename MemberRow<Owner>::Values>(row.member) = read_values(value);
        return;
    }
  }

  /// A text, or an array of texts.
  std::vector<Written<std::string>> read_texts(const Json& value, std::string_view name) {
    if (value.is_string()) return {{value.get<std::string>(), file_.value_position(value)}};
    std::vector<Written<std::string>> texts;
    bool is_valid = value.is_array();
    for (std::size_t i = 0; is_valid && i < value.size(); ++i) {
      is_valid = value[i].is_string();
      if (is_valid) texts.push_back({value[i].get<std::string>(), file_.value_position(value[i])});
    }
    if (!is_valid) value_error(value, fmt::format("{} must be a text or an array of texts", quote(name)));
    return texts;
  }

  std::vector<WrittenValue> read_values(const Json& json) {
    std::vector<WrittenValue> values;
    for (const auto& [entry, value] : file_.members(json)) {
      if (const auto text = eds_text(*value)) {
        values.push_back({{entry, file_.name_position(*value)}, {*text, file_.value_position(*value)}});
      } else {
        value_error(*value, fmt::format("the value of {} must be a number, a text, true or false", quote(entry)));
      }
    }
    return values;
  }

  void read_nodes(const Json& root, NetworkDescription& network) {
    const Json* const nodes = object_at(root, "nodes");
    if (nodes == nullptr) {
      if (!root.contains("nodes")) error(root, "missing \"nodes\", an object with a member for each node");
      return;
    }
    for (const auto& [name, json] : file_.members(*nodes)) {
      if (network.nodes.size() == max_nodes) {
        return error(*json, fmt::format("a network has at most {} nodes; the others are ignored", max_nodes));
      }
      if (!json->is_object()) {
        error(*json, fmt::format("node {} must be an object", quote(name)));
        continue;
      }
      NodeDescription node;
      node.name = {name, file_.name_position(*json)};
      check_case(*json, name, network);
      read_members(*json, node, node_members, {});
      check_node(*json, node);
      network.nodes.push_back(std::move(node));
    }
    if (nodes->empty()) error(*nodes, "the network does not have a node");
  }

  /// The files of a node have its name, and not all file systems tell upper from lower case.
  void check_case(const Json& json, const std::string& name, const NetworkDescription& network) {
    const auto is_same = [&, lower = in_lower_case(name)](const NodeDescription& other) {
      return in_lower_case(other.name.value) == lower;
    };
    if (const auto other = std::ranges::find_if(network.nodes, is_same); other != network.nodes.end()) {
      error(json,
            fmt::format("the names {} and {} differ only in upper and lower case: their files would have one name "
                        "on Windows",
                        quote(other->name.value), quote(name)));
    }
  }

  void check_node(const Json& json, const NodeDescription& node) {
    if (node.eds && node.dcf) error(json["dcf"], "a node has either \"eds\" or \"dcf\"");
    const bool has_file = json.contains("eds") || json.contains("dcf");
    const bool is_master = node.master && node.master->value;
    if (!has_file && !is_master) {
      error(json, fmt::format("node {} needs \"eds\" or \"dcf\"", quote(node.name.value)));
    }
    if (!json.contains("node_id") && !json.contains("dcf")) {
      error(json, fmt::format("node {} needs \"node_id\"", quote(node.name.value)));
    }
    if (!is_node_name(node.name.value)) {
      error(json, fmt::format("{} is not a name for a node: 1 to {} letters, digits, blanks, _ and -",
                              quote(node.name.value), max_name_length));
    }
  }

  void read_signals(const Json& root, NetworkDescription& network) {
    const auto signals = root.find("signals");
    if (signals == root.end()) return;
    if (!signals->is_array()) return error(*signals, "\"signals\" must be an array of objects");
    for (const Json& json : *signals) {
      if (!json.is_object()) {
        value_error(json, "a signal must be an object");
        continue;
      }
      SignalDescription signal;
      signal.position = file_.value_position(json);
      read_members(json, signal, signal_members, {});
      check_signal(json, signal);
      network.signals.push_back(std::move(signal));
    }
  }

  void check_signal(const Json& json, const SignalDescription& signal) {
    if (!json.contains("from")) value_error(json, "a signal needs \"from\", the name of a node");
    if (!json.contains("object")) value_error(json, "a signal needs \"object\", the entry that is sent");
    const bool has_interval = json.contains("every_ms") || json.contains("every_sync");
    const bool is_event = signal.event && signal.event->value;
    if (signal.every_ms && signal.every_sync) {
      value_error(json, "a signal has either \"every_ms\" or \"every_sync\"");
    }
    if (signal.every_sync && is_event) value_error(json, "a signal has either \"every_sync\" or \"event\"");
    if (signal.inhibit_time_us && signal.every_sync) {
      value_error(json, "\"inhibit_time_us\" is for signals that are not sent at SYNC");
    }
    if (!has_interval && !is_event) value_error(json, "a signal needs \"every_ms\", \"every_sync\" or \"event\"");
  }

  const JsonFile& file_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::optional<std::uint32_t> sdo_timeout_ms(const NetworkDescription& network, const NodeDescription& node) {
  const WrittenNumber& written = node.sdo_timeout_ms ? node.sdo_timeout_ms : network.sdo_timeout_ms;
  return written ? std::optional{written->value} : std::nullopt;
}

NetworkDescription read_network_file(const SourceFile& source, Diagnostics& diagnostics) {
  const JsonFile file{source};
  file.report_faults("network-syntax", diagnostics);
  if (!file.is_valid()) return {&source, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
  return NetworkReader{file, diagnostics}.read();
}

}  // namespace edsc
