#include "replay/replay.hpp"

#include <algorithm>
#include <array>
#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/nmt.hpp>
#include <initializer_list>
#include <map>
#include <utility>

#include "decode/predefined_set.hpp"
#include "decode/sdo_initiate.hpp"
#include "online/elapsed_time.hpp"
#include "replay/response_stream.hpp"

namespace edsc::replay {
namespace {

namespace function_code = canopen::function_code;

constexpr std::uint8_t max_node_id = 127;

/// What is done with a frame of the log.
enum class Role : std::uint8_t {
  sent,
  expected,  ///< from one of the nodes
  unused,
};

/// Whether a PDO has its CAN-ID from the pre-defined connection set.
bool is_predefined_pdo(const canopen::Frame& frame, bool transmit) {
  if (frame.extended || frame.remote) return false;
  const auto pdo = predefined_pdo(frame.id);
  return pdo && pdo->transmit == transmit;
}

/// The nodes that send frames with one of these function codes.
NodeSet senders(const std::vector<RecordedFrame>& frames, std::initializer_list<std::uint32_t> functions) {
  NodeSet nodes;
  for (const RecordedFrame& one : frames) {
    const canopen::Frame& frame = one.frame;
    if (frame.extended || frame.remote || node_id_of(frame.id) == 0) continue;
    if (std::ranges::find(functions, function_code_of(frame.id)) != functions.end()) nodes.set(node_id_of(frame.id));
  }
  return nodes;
}

class Replay {
 public:
  Replay(LiveBus& bus, const std::vector<KnownNode>& known, const Settings& settings)
      : bus_{bus}, settings_{settings}, log_decoder_{known}, live_decoder_{known}, elapsed_{bus.now()} {
    for (const KnownNode& node : known) known_.push_back(node.node_id);
  }

  Result run(const std::vector<RecordedFrame>& frames) {
    if (settings_.power_on) switch_on(frames);
    for (const RecordedFrame& one : frames) {
      if (is_done()) break;
      take(one);
    }
    if (!is_done()) finish();
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is_done() const { return !settings_.all_differences && !result_.differences.empty(); }
  [[nodiscard]] bool is_replayed(std::uint8_t node_id) const {
    return node_id <= max_node_id && settings_.nodes[node_id];
  }

  // Time

  /// Microseconds since the beginning of the replay.
  std::int64_t elapsed() { return elapsed_.advance(bus_.now()); }

  /// Receives frames for at most this time, and until the first one.
  void receive(std::int64_t us) {
    constexpr std::int64_t at_once = 1'000'000;
    const auto wait = static_cast<std::uint32_t>(std::clamp<std::int64_t>(us, 0, at_once));
    if (const auto frame = bus_.receive(canopen::Duration{wait})) take_received(*frame);
    if (Interruption::noted()) throw Interrupted{};
    expire();
  }

  void receive_until(std::int64_t us) {
    do {
      receive(us - elapsed());
    } while (!is_done() && elapsed() < us);
  }

  /// Waits until the nodes have sent what the log has up to here, or until it is missing.
  void await_responses() {
    for (;;) {
      const StreamFrame* next = nullptr;
      for (const auto& [key, stream] : streams_) {
        if (is_awaited(key.service) && !stream.expected.empty()) next = &stream.expected.front();
      }
      if (next == nullptr || is_done()) return;
      receive(next->at_us + settings_.timeout_us - elapsed() + 1);
    }
  }

  // Power-on of simulated nodes

  /// A node that boots in the log is switched on there. The others are in the state that they report first.
  void switch_on(const std::vector<RecordedFrame>& frames) {
    std::array<bool, max_node_id + 1> seen{};
    std::vector<canopen::Frame> commands;
    Decoder decoder{{}};
    Message message;
    for (const RecordedFrame& one : frames) {
      decoder.decode({one.frame, one.has_time, one.us}, message);
      if (message.service == Service::nmt) break;
      const bool has_state = message.state.has_value() && is_from_node(message);
      if (!has_state || !is_replayed(message.node_id) || std::exchange(seen[message.node_id], true)) continue;
      if (message.service == Service::boot_up) continue;
      add_command(*message.state, message.node_id, commands);
    }
    for (std::uint8_t node_id = 1; node_id <= max_node_id; ++node_id) {
      if (!is_replayed(node_id) || boots_first(frames, node_id)) continue;
      settings_.power_on(node_id);
      is_on_[node_id] = true;
    }
    while (const auto frame = bus_.receive(canopen::Duration{0})) {
    }
    for (const canopen::Frame& command : commands) bus_.send_all(command);
    while (const auto frame = bus_.receive(canopen::Duration{0})) {
    }
  }

  static void add_command(canopen::NmtState state, std::uint8_t node_id, std::vector<canopen::Frame>& commands) {
    using canopen::NmtCommand;
    const bool starts = state == canopen::NmtState::operational;
    if (!starts && state != canopen::NmtState::stopped) return;
    canopen::Frame command{};
    command.size = 2;
    command.data[0] = static_cast<std::uint8_t>(starts ? NmtCommand::start : NmtCommand::stop);
    command.data[1] = node_id;
    commands.push_back(command);
  }

  /// Whether the boot-up message of a node is its first frame in the log.
  static bool boots_first(const std::vector<RecordedFrame>& frames, std::uint8_t node_id) {
    for (const RecordedFrame& one : frames) {
      const canopen::Frame& frame = one.frame;
      if (frame.extended || frame.remote || node_id_of(frame.id) != node_id) continue;
      const std::uint32_t function = function_code_of(frame.id);
      if (function == function_code::error_control) return frame.size == 1 && frame.data[0] == 0;
      if (function == function_code::emcy || function == function_code::sdo_response || is_predefined_pdo(frame, true))
        return false;
    }
    return false;
  }

  // Frames of the log

  void take(const RecordedFrame& one) {
    receive_until((one.us - one.skipped_us) * 100 / settings_.speed + shift_us_);
    if (is_done()) return;
    log_decoder_.decode({one.frame, one.has_time, one.us}, message_);
    present_ = &one;
    switch (role_of(one.frame, message_)) {
      case Role::sent: return send(one);
      case Role::expected: return expect(one);
      case Role::unused: return;
    }
  }

  [[nodiscard]] Role role_of(const canopen::Frame& frame, const Message& message) const {
    const bool is_of_node = is_replayed(message.node_id);
    const auto sent_if = [](bool condition) { return condition ? Role::sent : Role::unused; };
    const auto expected_if = [](bool condition) { return condition ? Role::expected : Role::unused; };
    switch (message.service) {
      case Service::nmt: return Role::sent;
      case Service::sync: return sent_if(!is_produced(0x1005, frame));
      case Service::time: return sent_if(!is_produced(0x1012, frame));
      case Service::lss: return message.from_client ? Role::sent : Role::expected;
      case Service::sdo:
        if (!is_of_node) return Role::unused;
        return message.from_client ? Role::sent : Role::expected;
      case Service::emcy: return is_of_node ? Role::expected : sent_if(consumes_emergency(frame));
      case Service::boot_up:
      case Service::guarding:
      case Service::heartbeat:
        if (!is_of_node) return Role::sent;
        if (frame.remote) return Role::sent;
        return expected_if(message.service != Service::heartbeat);
      case Service::tpdo:
        if (is_of_node && !frame.remote) return expected_if(settings_.pdos);
        return sent_if(is_of_node || receives(frame));
      case Service::rpdo: return sent_if(is_of_node || receives(frame));
      case Service::unknown: {
        const bool is_predefined = is_replayed(node_id_of(frame.id));
        if (is_predefined && is_predefined_pdo(frame, true)) return expected_if(settings_.pdos);
        return sent_if(is_predefined && is_predefined_pdo(frame, false));
      }
      case Service::error_frame: break;
    }
    return Role::unused;
  }

  template <class Predicate>
  [[nodiscard]] bool any_model(Predicate&& fits) const {
    return std::ranges::any_of(known_, [&](std::uint8_t node_id) {
      const NodeModel* const model = is_replayed(node_id) ? log_decoder_.find_model(node_id) : nullptr;
      return model != nullptr && fits(*model);
    });
  }

  /// Whether one of the nodes produces SYNC or TIME with this CAN-ID (bit 30 of 1005h and 1012h).
  [[nodiscard]] bool is_produced(std::uint16_t index, const canopen::Frame& frame) const {
    return any_model([&](const NodeModel& model) {
      const std::uint32_t value = model.parameter(index, 0).value_or(0);
      return (value & 0x4000'0000U) != 0 && (value & 0x3FFF'FFFFU) == canopen::cob_id_of(frame);
    });
  }

  /// Whether 1028h of one of the nodes has this CAN-ID.
  [[nodiscard]] bool consumes_emergency(const canopen::Frame& frame) const {
    return any_model([&](const NodeModel& model) {
      for (std::uint8_t sub_index = 1; sub_index <= max_node_id; ++sub_index) {
        const auto value = model.parameter(0x1028, sub_index);
        if (value && (*value & 0xBFFF'FFFFU) == canopen::cob_id_of(frame)) return true;
      }
      return false;
    });
  }

  /// Whether one of the nodes has an RPDO with this CAN-ID.
  [[nodiscard]] bool receives(const canopen::Frame& frame) const {
    return any_model([&](const NodeModel& model) {
      return std::ranges::any_of(model.pdos(), [&](const PdoLayout& pdo) {
        return pdo.direction == PdoDirection::receive && pdo.cob_id.valid() &&
               (pdo.cob_id.value() & canopen::CobId::identifier) == canopen::cob_id_of(frame);
      });
    });
  }

  [[nodiscard]] static StreamKey key_of(const canopen::Frame& frame, const Message& message) {
    switch (message.service) {
      case Service::sdo: return {Service::sdo, message.channel};
      case Service::lss: return {Service::lss, 0};
      case Service::tpdo:
      case Service::unknown: return {Service::tpdo, canopen::cob_id_of(frame)};
      default: return {message.service, message.node_id};
    }
  }

  void send(const RecordedFrame& one) {
    const bool is_request = message_.service == Service::sdo || message_.service == Service::lss;
    const StreamKey key = key_of(one.frame, message_);
    const DecodedFrame request{one.frame, message_.text};
    const auto begun = message_.service == Service::sdo ? sdo_initiate(one.frame) : std::nullopt;
    if (message_.command) note_command(*message_.command, message_.node_id);

    const std::int64_t before = elapsed();
    await_responses();
    shift_us_ += elapsed() - before;  // the distance to the next frames of the log remains
    if (is_done()) return;
    if (follows_requests(key.service)) flush(key, streams_[key]);
    if (is_done()) return;
    if (is_request) {
      ResponseStream& stream = streams_[key];
      stream.request = request;
      if (begun) begin_transfer(EntryKey{begun->index, begun->sub_index}, stream);
    }
    live_decoder_.decode({one.frame, false, 0}, live_message_);
    bus_.send_all(one.frame);
    ++result_.sent;
  }

  void begin_transfer(const EntryKey& entry, ResponseStream& stream) const {
    stream.entry = entry;
    stream.skips = is_ignored(entry.first, entry.second);
  }

  void note_command(canopen::NmtCommand command, std::uint8_t node_id) {
    const bool is_reset =
        command == canopen::NmtCommand::reset_node || command == canopen::NmtCommand::reset_communication;
    if (!is_reset) return;
    for (std::uint8_t id = 1; id <= max_node_id; ++id) {
      if (node_id == 0 || node_id == id) may_boot_[id] = true;
    }
  }

  void expect(const RecordedFrame& one) {
    if (message_.service == Service::boot_up && !expect_boot_up(message_.node_id)) return;
    const StreamKey key = key_of(one.frame, message_);
    ResponseStream& stream = streams_[key];
    if (key.service == Service::tpdo && is_repeated(one.frame, stream.last_expected)) return;
    StreamFrame frame = stream_frame(one.frame, message_);
    frame.node_id = node_of(one.frame, message_);
    stream.expected.push_back(std::move(frame));
    compare_pairs(key, stream);
  }

  /// A boot-up message without a reset command before it is a power-on, which a simulated node repeats. Returns false
  /// for a power-on of a real node.
  bool expect_boot_up(std::uint8_t node_id) {
    const bool was_commanded = std::exchange(may_boot_[node_id], false);
    if (!settings_.power_on) return was_commanded;
    if (was_commanded && is_on_[node_id]) return true;
    settings_.power_on(node_id);
    is_on_[node_id] = true;
    return true;
  }

  /// Consecutive equal PDOs count as one: how often a PDO is sent depends on the time.
  static bool is_repeated(const canopen::Frame& frame, std::optional<canopen::Frame>& last) {
    if (last == frame) return true;
    last = frame;
    return false;
  }

  // Frames that were received

  void take_received(const canopen::Frame& frame) {
    live_decoder_.decode({frame, false, 0}, live_message_);
    const Message& message = live_message_;
    const Role role = role_of(frame, message);
    if (role != Role::expected) return;
    const StreamKey key = key_of(frame, message);
    ResponseStream& stream = streams_[key];
    if (key.service == Service::tpdo && is_repeated(frame, stream.last_received)) return;
    StreamFrame received = stream_frame(frame, message);
    received.node_id = node_of(frame, message);
    stream.received.push_back(std::move(received));
    compare_pairs(key, stream);
  }

  [[nodiscard]] static std::uint8_t node_of(const canopen::Frame& frame, const Message& message) {
    if (message.service == Service::unknown) return node_id_of(frame.id);
    return message.service == Service::lss ? std::uint8_t{0} : message.node_id;
  }

  /// With the place of the log that has been reached.
  StreamFrame stream_frame(const canopen::Frame& frame, const Message& message) {
    StreamFrame made;
    made.decoded = {frame, message.service == Service::unknown ? std::string{"TPDO without an EDS"} : message.text};
    made.at_us = elapsed();
    if (present_ != nullptr) {
      made.line = present_->line;
      made.has_time = present_->has_time;
      made.log_us = present_->us;
    }
    if (message.step != TransferStep::none) made.entry = EntryKey{message.index, message.sub_index};
    made.is_abort = message.step == TransferStep::aborted;
    made.abort_code = message.abort_code;
    return made;
  }

  // Comparison

  [[nodiscard]] bool is_ignored(std::uint16_t index, std::uint8_t sub_index) const {
    return std::ranges::any_of(settings_.ignored, [&](const EntryAddress& one) {
      return one.index == index && one.sub_index.value_or(sub_index) == sub_index;
    });
  }

  void compare_pairs(const StreamKey& key, ResponseStream& stream) {
    while (!stream.expected.empty() && !stream.received.empty()) {
      const StreamFrame expected = std::move(stream.expected.front());
      const StreamFrame received = std::move(stream.received.front());
      stream.expected.pop_front();
      stream.received.pop_front();
      if (stream.skips) continue;
      ++result_.compared;
      if (const auto kind = compare(key.service, expected, received)) report(*kind, key, stream, &expected, &received);
    }
  }

  void report(DifferenceKind kind, const StreamKey& key, ResponseStream& stream, const StreamFrame* expected,
              const StreamFrame* received) {
    if (is_done()) return;
    const StreamFrame& shown = expected != nullptr ? *expected : *received;
    Difference difference;
    difference.kind = kind;
    difference.service = key.service;
    difference.node_id = shown.node_id;
    difference.line = shown.line;
    difference.has_time = shown.has_time;
    difference.us = shown.log_us;
    difference.entry = stream.entry ? stream.entry : shown.entry;
    difference.request = stream.request;
    if (expected != nullptr) difference.expected = expected->decoded;
    if (received != nullptr) difference.received = received->decoded;
    result_.differences.push_back(std::move(difference));
    if (key.service == Service::sdo) stream.skips = true;  // the rest of the transfer follows from it
  }

  /// Reports frames that were not sent within the time-out, and those that the log should have had by now.
  void expire() {
    const std::int64_t now = elapsed();
    for (auto& [key, stream] : streams_) {
      while (!stream.expected.empty() && now - stream.expected.front().at_us > settings_.timeout_us) {
        report_missing(key, stream);
      }
      if (follows_requests(key.service)) continue;
      while (!stream.received.empty() && now - stream.received.front().at_us > settings_.timeout_us) {
        report_additional(key, stream);
      }
    }
  }

  void report_missing(const StreamKey& key, ResponseStream& stream) {
    const StreamFrame expected = std::move(stream.expected.front());
    stream.expected.pop_front();
    if (stream.skips) return;
    ++result_.compared;
    report(DifferenceKind::missing, key, stream, &expected, nullptr);
  }

  void report_additional(const StreamKey& key, ResponseStream& stream) {
    const StreamFrame received = std::move(stream.received.front());
    stream.received.pop_front();
    if (!stream.skips) report(DifferenceKind::additional, key, stream, nullptr, &received);
  }

  void flush(const StreamKey& key, ResponseStream& stream) {
    while (!stream.expected.empty()) report_missing(key, stream);
    while (!stream.received.empty()) report_additional(key, stream);
  }

  /// The nodes may still send for the time-out.
  void finish() {
    receive_until(elapsed() + settings_.timeout_us + 1);
    for (auto& [key, stream] : streams_) flush(key, stream);
  }

  LiveBus& bus_;
  const Settings& settings_;
  Decoder log_decoder_, live_decoder_;
  Message message_, live_message_;
  std::vector<std::uint8_t> known_;
  std::map<StreamKey, ResponseStream> streams_;
  std::array<bool, max_node_id + 1> may_boot_{};  ///< after a reset command
  std::array<bool, max_node_id + 1> is_on_{};     ///< of simulated nodes
  ElapsedTime elapsed_;
  std::int64_t shift_us_ = 0;  ///< by which the replay is later than the log
  const RecordedFrame* present_ = nullptr;
  Result result_;
};

}  // namespace

NodeSet answering_nodes(const std::vector<RecordedFrame>& frames) {
  return senders(frames, {function_code::sdo_response});
}

NodeSet sending_nodes(const std::vector<RecordedFrame>& frames) {
  return senders(frames, {function_code::emcy, function_code::sdo_response, function_code::error_control});
}

Result replay(LiveBus& bus, const std::vector<RecordedFrame>& frames, const std::vector<KnownNode>& known,
              const Settings& settings) {
  return Replay{bus, known, settings}.run(frames);
}

}  // namespace edsc::replay
