#include "decode/log/print_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "decode/log/value_number.hpp"
#include "decode/value_format.hpp"
#include "device/meaning/value_parts.hpp"
#include "text/printable.hpp"
#include "text/utf8.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

constexpr std::string_view problem_color = "\x1b[31m", quiet_color = "\x1b[2m", no_color = "\x1b[0m";
constexpr std::size_t data_width = 8 * 3, id_width = 8, label_width = 9;

void pad_to(std::string& out, std::size_t begin, std::size_t width) {
  const std::size_t size = out.size() - begin;
  if (size < width) out.append(width - size, ' ');
}

void append_label(std::string& out, const Message& message) {
  out += row_of(message.service).label;
  if (message.service == Service::tpdo || message.service == Service::rpdo) {
    out += ' ';
    append_decimal(out, message.number);
  } else if (message.service == Service::sdo || message.service == Service::lss) {
    out += message.from_client ? " >" : " <";
  }
}

// JSON

/// In quotation marks. Bytes that are not UTF-8 become U+FFFD.
void append_json_string(std::string& out, std::string_view text) {
  const auto plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  if (std::ranges::all_of(text, plain)) {
    out += '"';
    out += text;
    out += '"';
  } else {
    using nlohmann::json;
    out += printable_json(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
  }
}

void append_key(std::string& out, std::string_view key) {
  out += ",\"";
  out += key;
  out += "\":";
}

void append_member(std::string& out, std::string_view key, std::string_view text) {
  append_key(out, key);
  append_json_string(out, text);
}

void append_member(std::string& out, std::string_view key, std::uint64_t number) {
  append_key(out, key);
  append_decimal(out, number);
}

/// Numbers as numbers, BOOLEANs as booleans, other types as their text. JSON cannot express infinity and NaN.
void append_json_value(std::string& out, const MessageValue& value, std::string_view text) {
  const auto number = plain_number(value);
  if (!number) return append_json_string(out, text);
  const auto* const single = std::get_if<float>(&*number);
  const auto* const real = std::get_if<double>(&*number);
  if (single != nullptr && !std::isfinite(*single)) return append_json_string(out, text);
  if (real != nullptr && !std::isfinite(*real)) {
    out += "null";
    return;
  }
  append_number(out, *number);
}

/// The number in a field as a name, a physical value, a flag or a number.
void append_field_value(std::string& out, const ValuePart& part) {
  if (part.masked != nullptr) return append_json_string(out, part.masked->name);
  const BitField& field = *part.field;
  if (part.named != nullptr) return append_json_string(out, part.named->name);
  if (field.is_flag()) {
    out += part.number != 0 ? "true" : "false";
    return;
  }
  const auto physical = field.quantity
                            ? physical_value(*field.quantity, type_of(field), static_cast<std::uint64_t>(part.number))
                            : std::nullopt;
  if (physical) return append_number(out, physical->to_double());
  append_decimal(out, part.number);
}

/// `{"state":"operation_enabled","remote":true}`
void append_fields(std::string& out, const MessageValue& value) {
  char separator = '{';
  const std::uint64_t bits = value.bits != 0 ? value.number : number_of(value.bytes);
  for_each_part(*value.meaning, bits, value.other, [&](const ValuePart& part) {
    out += separator;
    separator = ',';
    append_json_string(out, part.name());
    out += ':';
    append_field_value(out, part);
  });
  out += separator == '{' ? "{}" : "}";
}

/// The physical value, the name of the value and the fields, where the entry has them.
void append_meaning(std::string& out, const MessageValue& value) {
  if (value.quantity != nullptr) {
    const auto physical = physical_number(value);
    const auto raw = physical && value.quantity->is_raw() ? plain_number(value) : std::nullopt;
    if (physical) append_key(out, "physical");
    if (raw) {
      append_number(out, *raw);
    } else if (physical) {
      append_number(out, *physical);
    }
    if (!value.quantity->symbol.empty()) append_member(out, "unit", value.quantity->symbol);
  }
  const auto raw = value.meaning != nullptr ? integer_of(value) : std::nullopt;
  if (!raw) return;
  const Meaning& meaning = *value.meaning;
  const NamedValue* const named = meaning.values ? meaning.values->find(*raw) : nullptr;
  if (named != nullptr) append_member(out, "value_name", named->name);
  if (!meaning.has_fields()) return;
  append_key(out, "fields");
  if (value.word == nullptr) return append_fields(out, value);
  if (value.word->json.empty()) append_fields(value.word->json, value);
  out += value.word->json;
}

void append_time(std::string& out, std::int64_t us) {
  append_key(out, "time_us");
  if (us < 0) out += '-';
  append_decimal(out, us < 0 ? 0 - static_cast<std::uint64_t>(us) : static_cast<std::uint64_t>(us));
}

/// `"index":"1018h:01"`
void append_index(std::string& out, std::uint16_t index, std::uint8_t sub_index) {
  out += "\"index\":\"";
  append_entry_label(out, index, sub_index);
  out += '"';
}

void append_values(std::string& out, const Message& message) {
  if (message.values.empty()) return;
  append_key(out, "values");
  char separator = '[';
  for (const MessageValue& value : message.values) {
    const std::string_view text =
        std::string_view{message.text}.substr(value.text_begin, value.text_end - value.text_begin);
    out += separator;
    out += '{';
    append_index(out, value.index, value.sub_index);
    if (!value.name.empty()) append_member(out, "name", value.name);
    if (value.type != nullptr) append_member(out, "type", value.type->name);
    append_key(out, "value");
    append_json_value(out, value, text);
    append_meaning(out, value);
    append_member(out, "text", text);
    out += '}';
    separator = ',';
  }
  out += ']';
}

void append_transfer(std::string& out, const Message& message) {
  append_key(out, "transfer");
  out += message.download ? "{\"direction\":\"download\"" : "{\"direction\":\"upload\"";
  append_member(out, "step", step_name(message.step));
  out += ',';
  append_index(out, message.index, message.sub_index);
  append_member(out, "bytes", message.size);
  if (message.duration_us >= 0) append_member(out, "duration_us", static_cast<std::uint64_t>(message.duration_us));
  if (message.step == TransferStep::aborted) append_member(out, "abort_code", message.abort_code);
  out += '}';
}

}  // namespace

NodeLabels::NodeLabels() { pad(); }

void NodeLabels::set_name(std::uint8_t node_id, std::string_view name) {
  names_[node_id & 0x7F] = name;
  pad();
}

void NodeLabels::pad() {
  std::size_t width = std::string_view{"node 12 "}.size();
  for (std::size_t id = 1; id < padded_.size(); ++id) {
    padded_[id] = fmt::format("node {} {}", id, printable(names_[id]));
    if (names_[id].empty()) continue;
    padded_[id] += ' ';
    width = std::max(width, count_code_points(padded_[id]));
  }
  for (std::string& label : padded_) {
    const std::size_t size = count_code_points(label);
    if (size < width) label.append(width - size, ' ');
  }
}

std::string_view step_name(TransferStep step) {
  constexpr std::string_view names[] = {"", "part", "finished", "aborted"};
  return names[static_cast<std::size_t>(step)];
}

std::string service_label(const Message& message) {
  std::string text;
  append_label(text, message);
  return text;
}

void append_text(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels, bool color) {
  const bool quiet = message.service == Service::sync || message.service == Service::heartbeat;
  const bool colored = color && (message.problem || quiet);
  if (colored) out += message.problem ? problem_color : quiet_color;
  if (line.has_time) {
    out += line.time;
    out += ' ';
  }
  if (!line.interface.empty()) {
    append_printable(out, line.interface);
    out += ' ';
  }
  std::size_t begin = out.size();
  append_can_id(out, line.frame);
  out += ' ';
  if (line.frame.remote) {
    out += "remote ";
    append_decimal(out, line.frame.size);
  }
  append_hex_bytes(out, data_of(line.frame));
  pad_to(out, begin, data_width + (line.frame.extended ? id_width + 1 : 4));
  begin = out.size();
  append_label(out, message);
  pad_to(out, begin, label_width);
  out += labels.padded(message.node_id);
  append_printable(out, message.text);
  while (out.ends_with(' ')) out.pop_back();
  if (colored) out += no_color;
  out += '\n';
}

void append_json(std::string& out, const LogLine& line, const Message& message, const NodeLabels& labels) {
  out += "{\"schema\":2,\"line\":";
  append_decimal(out, line.number);
  if (line.has_time) append_time(out, line.microseconds);
  if (!line.interface.empty()) append_member(out, "interface", line.interface);
  append_member(out, "can_id", line.frame.id);
  if (line.frame.extended) out += ",\"extended\":true";
  if (line.frame.remote) out += ",\"remote\":true";
  append_key(out, "data");
  out += '"';
  append_hex_bytes(out, data_of(line.frame), "");
  out += '"';
  append_member(out, "service", row_of(message.service).name);
  if (message.node_id != 0) append_member(out, "node", message.node_id);
  if (!labels.name(message.node_id).empty()) append_member(out, "node_name", labels.name(message.node_id));
  if (message.number != 0) append_member(out, "pdo", message.number);
  if (message.service == Service::sdo || message.service == Service::lss) {
    append_member(out, "direction", message.from_client ? "request" : "response");
  }
  if (message.command) append_member(out, "command", nmt_command_text(*message.command));
  if (message.state) append_member(out, "state", canopen::to_text(*message.state));
  if (message.counter >= 0) append_member(out, "counter", static_cast<std::uint64_t>(message.counter));
  if (message.service == Service::emcy) {
    append_member(out, "error_code", message.error_code);
    if (!message.error_text.empty()) append_member(out, "error_text", message.error_text);
    append_member(out, "error_register", message.error_register);
  }
  if (message.step != TransferStep::none) append_transfer(out, message);
  append_values(out, message);
  if (message.problem) out += ",\"problem\":true";
  append_member(out, "text", message.text);
  out += "}\n";
}

}  // namespace edsc
