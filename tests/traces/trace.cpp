#include "trace.hpp"

#include <algorithm>
#include <canopen/lss/lss_protocol.hpp>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace trace {

namespace {

/// The text before the comment; a `#` inside quotes is text.
std::string without_comment(const std::string& line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted) return line.substr(0, i);
  }
  return line;
}

std::uint64_t number(const std::string& text, int base = 0) {
  std::size_t used = 0;
  const bool negative = text.starts_with('-');
  const std::uint64_t value =
      negative ? static_cast<std::uint64_t>(std::stoll(text, &used, base)) : std::stoull(text, &used, base);
  if (used != text.size()) throw std::invalid_argument{"\"" + text + "\" is not a number"};
  return value;
}

std::uint64_t number_up_to(std::uint64_t highest, const std::string& text, int base) {
  const std::uint64_t value = number(text, base);
  if (value > highest) throw std::invalid_argument{"\"" + text + "\" is too high"};
  return value;
}

Pattern read_pattern(std::istringstream& words) {
  Pattern pattern{};
  std::string word;
  words >> word;
  pattern.frame.extended = word.size() == 8;
  pattern.frame.id = static_cast<std::uint32_t>(number_up_to(pattern.frame.extended ? 0x1FFF'FFFF : 0x7FF, word, 16));
  while (words >> word) {
    if (word == "R") {
      pattern.frame.remote = true;
      continue;
    }
    if (pattern.frame.remote) {
      pattern.frame.size = static_cast<std::uint8_t>(number_up_to(8, word, 10));
      continue;
    }
    const std::uint8_t at = pattern.frame.size++;
    if (at == 8) throw std::invalid_argument{"a frame has eight bytes at most"};
    if (word == "--") {
      pattern.any = static_cast<std::uint8_t>(pattern.any | (1u << at));
    } else {
      pattern.frame.data[at] = static_cast<std::uint8_t>(number_up_to(0xFF, word, 16));
    }
  }
  return pattern;
}

canopen::Duration read_span(std::istringstream& words) {
  std::uint32_t count = 0;
  std::string unit;
  words >> count >> unit;
  if (unit == "us") return canopen::Duration{count};
  if (unit == "ms") return canopen::Duration{count * 1'000};
  if (unit == "s") return canopen::Duration{count * 1'000'000};
  throw std::invalid_argument{"a time is a number and us, ms or s"};
}

/// Whether a trace has specified a node-ID for a device, which may be 255 (none yet).
bool is_given(canopen::NodeId node_id) { return node_id.valid() || node_id == canopen::unconfigured_node_id; }

canopen::NodeId read_node_id(std::istringstream& words) {
  std::string id;
  words >> id;
  const canopen::NodeId node_id{static_cast<std::uint8_t>(number_up_to(255, id, 10))};
  if (!is_given(node_id)) throw std::invalid_argument{"a node-ID is 1 to 127, or 255"};
  return node_id;
}

std::size_t position_of(canopen::NodeId node_id, const Trace& trace) {
  const auto found = std::ranges::find(trace.nodes, node_id, &NodeOfTrace::node_id);
  if (found == trace.nodes.end()) throw std::invalid_argument{"no such node on the bus"};
  return static_cast<std::size_t>(found - trace.nodes.begin());
}

/// The first word after `node 2`, which may be omitted if there is only one node.
std::string word_behind_node(std::istringstream& words, const Trace& trace, Line& line) {
  std::string word;
  words >> word;
  if (word == "node") {
    line.node = position_of(read_node_id(words), trace);
    words >> word;
  } else if (trace.nodes.size() != 1) {
    throw std::invalid_argument{"which node? It is written before the rest: node 2"};
  }
  return word;
}

/// `1801h:03 0x20F0` or `node 2 1008h:00 "text"`.
void read_object(std::istringstream& words, const Trace& trace, Line& line) {
  const std::string object = word_behind_node(words, trace, line);
  if (object.size() != 8 || object.substr(4, 2) != "h:") throw std::invalid_argument{"an object is written 1801h:03"};
  line.index = static_cast<std::uint16_t>(number_up_to(0xFFFF, object.substr(0, 4), 16));
  line.sub_index = static_cast<std::uint8_t>(number_up_to(0xFF, object.substr(6), 16));
  std::string value;
  std::getline(words >> std::ws, value);
  value.erase(value.find_last_not_of(" \t\r") + 1);
  line.value.is_text = value.size() >= 2 && value.front() == '"' && value.back() == '"';
  if (line.value.is_text) {
    line.value.text = value.substr(1, value.size() - 2);
  } else {
    line.value.number = number(value);
  }
}

/// `limit negative on` or `node 2 limit negative on`.
void read_input(std::istringstream& words, const Trace& trace, Line& line) {
  line.step = Step::input;
  line.input = word_behind_node(words, trace, line);
  for (std::string word; words >> word;) line.input += " " + word;
  if (!trace.nodes[line.node].has_application) throw std::invalid_argument{"the device runs no application"};
}

/// `0x8611 0x20 09 00 00 00 00` or `over 0x20`.
void read_emergency(std::istringstream& words, const Trace& trace, Line& line) {
  std::string word = word_behind_node(words, trace, line);
  line.step = word == "over" ? Step::emergency_over : Step::emergency;
  if (line.step == Step::emergency) line.emergency.code = static_cast<std::uint16_t>(number_up_to(0xFFFF, word, 16));
  words >> word;
  line.emergency.bits = static_cast<canopen::ErrorRegister>(number_up_to(0xFF, word, 16));
  std::size_t count = 0;
  while (words >> word) {
    if (line.step == Step::emergency_over || count == line.emergency.info.size())
      throw std::invalid_argument{"an error has five bytes of the manufacturer, and one that is over has none"};
    line.emergency.info.at(count++) = static_cast<std::uint8_t>(number_up_to(0xFF, word, 16));
  }
}

/// Whether the nodes have no power.
bool is_without_power(const Trace& trace) {
  const auto last = std::ranges::find_if(trace.lines.rbegin(), trace.lines.rend(), [](const Line& line) {
    return line.step == Step::power_off || line.step == Step::power_on;
  });
  return last != trace.lines.rend() && last->step == Step::power_off;
}

/// `on` or `off`, alternating.
void read_power(std::istringstream& words, Trace& trace, Line& line) {
  std::string state;
  words >> state;
  if (state == "on" && trace.lines.empty() && !trace.power_on) {
    trace.power_on = true;
    return;
  }
  line.step = state == "on" ? Step::power_on : Step::power_off;
  if (state != (is_without_power(trace) ? "on" : "off"))
    throw std::invalid_argument{"power goes on where it is off, and off where it is on"};
  trace.lines.push_back(line);
}

void read_line(const std::string& text, std::size_t number_of_line, Trace& trace) {
  std::istringstream words{without_comment(text)};
  std::string key;
  if (!(words >> key)) return;
  Line line;
  line.number = number_of_line;
  if (key == "manual") return;
  if (key == "device" || key == "application") {
    if (!trace.nodes.empty() && !is_given(trace.nodes.back().node_id))
      throw std::invalid_argument{"the device above has no node-ID"};
    words >> trace.nodes.emplace_back().device;
    trace.nodes.back().has_application = key == "application";
    return;
  }
  if (key == "node") {
    const canopen::NodeId node_id = read_node_id(words);
    if (trace.nodes.empty() || is_given(trace.nodes.back().node_id))
      throw std::invalid_argument{"a node-ID stands below its device"};
    if (std::ranges::find(trace.nodes, node_id, &NodeOfTrace::node_id) != trace.nodes.end())
      throw std::invalid_argument{"two nodes have this node-ID"};
    trace.nodes.back().node_id = node_id;
    return;
  }
  if (key == "power") return read_power(words, trace, line);
  if (is_without_power(trace) && key != "+") throw std::invalid_argument{"the power is off"};
  if (key == "=") {
    line.step = Step::set;
    read_object(words, trace, line);
  } else if (key == "!") {
    read_input(words, trace, line);
  } else if (key == "read") {
    line.step = Step::read;
    read_object(words, trace, line);
  } else if (key == "emergency") {
    read_emergency(words, trace, line);
  } else if (key == "+") {
    line.step = Step::pass;
    line.span = read_span(words);
  } else if (key == ">" || key == "<" || key == "~") {
    line.step = key == ">" ? Step::send : key == "<" ? Step::expect : Step::disregard;
    line.pattern = read_pattern(words);
  } else {
    throw std::invalid_argument{"\"" + key + "\" begins no line of a trace"};
  }
  trace.lines.push_back(line);
}

}  // namespace

bool Pattern::matches(const canopen::Frame& other) const {
  canopen::Frame expected = frame;
  for (std::size_t i = 0; i < expected.data.size(); ++i) {
    if ((any >> i & 1) != 0) expected.data[i] = other.data[i];
  }
  return expected == other;
}

std::vector<std::uint8_t> Value::bytes(std::size_t size) const {
  if (is_text) return {text.begin(), text.end()};
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  return bytes;
}

Trace read(const std::filesystem::path& file) {
  std::ifstream stream{file};
  if (!stream) throw std::runtime_error{file.string() + ": cannot be read"};
  return read(stream, file.string());
}

Trace read(std::istream& text, const std::string& name) {
  Trace trace;
  trace.file = name;
  std::string line;
  for (std::size_t number_of_line = 1; std::getline(text, line); ++number_of_line) {
    try {
      read_line(line, number_of_line, trace);
    } catch (const std::logic_error& problem) {
      throw std::runtime_error{trace.file + ":" + std::to_string(number_of_line) + ": " + problem.what()};
    }
  }
  if (trace.nodes.empty() || !is_given(trace.nodes.back().node_id))
    throw std::runtime_error{trace.file + ": no device or no node-ID"};
  return trace;
}

std::string to_text(const Pattern& pattern) {
  char piece[16];
  std::snprintf(piece, sizeof piece, pattern.frame.extended ? "%08X " : "%03X ",
                static_cast<unsigned>(pattern.frame.id));
  std::string text = piece;
  if (pattern.frame.remote) return text + " R " + std::to_string(pattern.frame.size);
  for (std::size_t i = 0; i < pattern.frame.size; ++i) {
    const bool any = (pattern.any >> i & 1) != 0;
    std::snprintf(piece, sizeof piece, any ? " --" : " %02X", static_cast<unsigned>(pattern.frame.data.at(i)));
    text += piece;
  }
  return text;
}

std::string to_text(const canopen::Frame& frame) { return to_text(Pattern{frame, 0}); }

std::string to_text(const std::vector<std::uint8_t>& bytes) {
  constexpr auto digits = "0123456789ABCDEF";
  std::string text;
  for (const std::uint8_t byte : bytes) text += std::string{digits[byte >> 4], digits[byte & 15], ' '};
  return text;
}

}  // namespace trace
