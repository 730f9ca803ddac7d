#include "simulate/simulation_result.hpp"

#include <canopen_sim/network_simulation/simulation_protocol.hpp>
#include <canopen_sim/simulation_codec.hpp>

namespace edsc {
namespace {

/// Numbers of a line; invalid ones and missing ones are noted.
class Numbers {
 public:
  explicit Numbers(std::string_view line) : rest_{line} {}

  template <class T = std::uint64_t>
  T next(T max) {
    const auto value = canopen::simulation::number<T>(canopen::simulation::take_word(rest_), 10, max);
    if (!value) is_valid_ = false;
    return value.value_or(T{});
  }
  std::uint64_t number() { return next<std::uint64_t>(UINT64_MAX); }
  /// A place in a list of this size.
  std::size_t place(std::size_t size) {
    const auto value = next<std::uint64_t>(UINT64_MAX);
    if (value >= size) is_valid_ = false;
    return static_cast<std::size_t>(value);
  }
  std::string_view word() { return canopen::simulation::take_word(rest_); }
  [[nodiscard]] bool is_valid() const { return is_valid_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool is_valid_ = true;
};

SeenFrames seen(Numbers& numbers) {
  SeenFrames frames;
  frames.count = numbers.number();
  frames.worst_us = numbers.number();
  frames.at_us = numbers.number();
  return frames;
}

using Kind = SimulationEvent::Kind;

SimulationEvent event(Kind kind, Numbers& numbers, std::size_t nodes) {
  SimulationEvent one;
  one.kind = kind;
  one.time_us = numbers.next<std::int64_t>(INT64_MAX);
  one.node = numbers.place(nodes);
  return one;
}

canopen::NmtState state(Numbers& numbers) { return static_cast<canopen::NmtState>(numbers.next<unsigned>(0xFF)); }

void read_event(std::string_view keyword, Numbers& numbers, SimulationResult& result) {
  SimulationEvent one = event(Kind::emergency, numbers, result.nodes.size());
  if (keyword == "emergency") {
    one.code = numbers.next<unsigned>(0xFFFF);
    one.error_register = numbers.next<unsigned>(0xFF);
  } else if (keyword == "heartbeat") {
    one.other = numbers.next<unsigned>(127);
    one.kind = numbers.word() == "lost" ? Kind::heartbeat_lost : Kind::heartbeat_back;
  } else {
    one.kind = Kind::state;
    one.state = state(numbers);
  }
  if (numbers.is_valid()) result.events.push_back(one);
}

void read_other(Numbers& numbers, SimulationResult& result) {
  OtherFrames one;
  one.can_id = numbers.next<std::uint32_t>(0x1FFF'FFFF);
  one.extended = numbers.number() != 0;
  one.remote = numbers.number() != 0;
  const auto node = numbers.next<std::int64_t>(127);
  if (node >= 0) one.node = static_cast<std::size_t>(node);
  one.seen = seen(numbers);
  if (numbers.is_valid()) result.others.push_back(one);
}

void read_node(Numbers& numbers, SimulationResult& result) {
  const std::size_t node = numbers.place(result.nodes.size());
  SimulatedNodeEnd end;
  end.condition = static_cast<SimulatedNodeEnd::Condition>(numbers.next<unsigned>(3));
  end.state = state(numbers);
  if (numbers.is_valid()) result.nodes[node] = end;
}

void read_refused(Numbers& numbers, SimulationResult& result) {
  RefusedEntry one;
  one.node = numbers.place(result.nodes.size());
  one.index = numbers.next<unsigned>(0xFFFF);
  one.sub_index = numbers.next<unsigned>(0xFF);
  one.abort_code = numbers.next<std::uint32_t>(UINT32_MAX);
  if (numbers.is_valid()) result.refused.push_back(one);
}

void read_bus(Numbers& numbers, SimulationResult& result) {
  result.measured_us = numbers.number();
  result.busy_us = numbers.number();
  result.busiest_us = numbers.number();
  result.frames = numbers.number();
  result.errors = numbers.number();
}

}  // namespace

SimulationReader::SimulationReader(std::size_t nodes, std::size_t messages) {
  result_.nodes.resize(nodes);
  result_.messages.resize(messages);
  result_.changes.resize(messages);
}

void SimulationReader::read(std::string_view piece, const std::function<void(std::uint64_t)>& progress) {
  pending_ += piece;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = pending_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string_view line = std::string_view{pending_}.substr(begin, end - begin);
    if (!read_line(line, progress) && malformed_.empty()) malformed_ = line;
  }
  pending_.erase(0, begin);
}

bool SimulationReader::read_line(std::string_view line, const std::function<void(std::uint64_t)>& progress) {
  if (!greeted_) return greeted_ = line == canopen::network_simulation::greeting;
  Numbers numbers{line};
  const std::string_view keyword = numbers.word();
  if (keyword == "end") return ended_ = numbers.is_valid();
  if (keyword == "progress") {
    progress(numbers.number());
  } else if (keyword == "emergency" || keyword == "heartbeat" || keyword == "state") {
    read_event(keyword, numbers, result_);
  } else if (keyword == "refused") {
    read_refused(numbers, result_);
  } else if (keyword == "message") {
    const std::size_t place = numbers.place(result_.messages.size());
    const SeenFrames frames = seen(numbers);
    if (numbers.is_valid()) result_.messages[place] = frames;
  } else if (keyword == "changes") {
    const std::size_t place = numbers.place(result_.changes.size());
    const std::uint64_t count = numbers.number();
    if (numbers.is_valid()) result_.changes[place] = count;
  } else if (keyword == "frame") {
    read_other(numbers, result_);
  } else if (keyword == "node") {
    read_node(numbers, result_);
  } else if (keyword == "bus") {
    read_bus(numbers, result_);
  } else {
    return false;
  }
  return numbers.is_valid();
}

}  // namespace edsc
