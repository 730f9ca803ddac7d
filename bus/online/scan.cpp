#include "online/scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <canopen/nmt/error_control.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <iterator>
#include <list>
#include <span>
#include <utility>
#include <vector>

#include "online/bus_watch.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::Duration;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;

/// Nodes that are queried at the same time: few enough to receive the responses in time at 20 kbit/s.
constexpr std::size_t max_at_once = 16;
/// The scan does not wait for slower heartbeats.
constexpr std::uint32_t longest_heartbeat_ms = 5'000;
constexpr Duration look_again = canopen::from_milliseconds(5);

/// An entry that is read from a node.
struct Question {
  std::uint16_t index;
  std::uint8_t sub_index = 0;
};

/// The identity, whose first number shows that the node exists; the heartbeat time; the name.
constexpr std::size_t heartbeat_question = std::size(identity_numbers), name_question = heartbeat_question + 1;
constexpr std::size_t question_count = name_question + 1;

constexpr Question question(std::size_t number) {
  if (number < heartbeat_question) return {identity_numbers[number].index, identity_numbers[number].sub_index};
  return number == heartbeat_question ? Question{0x1017} : Question{0x1008};
}

/// The requests to one node, one after the other.
class Interview {
 public:
  Interview(LiveBus& bus, FoundNode& node, Duration timeout)
      : bus_{bus}, node_{node}, client_{bus, NodeId{node.node_id}, timeout} {
    ask();
  }

  void on_frame(const Frame& frame, TimePoint now) {
    if (!frame.extended && !frame.remote && frame.size == 8 &&
        frame.id == canopen::default_sdo(NodeId{node_.node_id}).response.can_id()) {
      node_.answers_sdo = true;
    }
    client_.on_frame(frame, now);
    go_on();
  }

  void on_time(TimePoint now) {
    client_.on_time(now);
    go_on();
  }

  void cancel() { client_.cancel(canopen::AbortCode::general, bus_.now()); }

  [[nodiscard]] std::uint8_t node_id() const { return node_.node_id; }
  [[nodiscard]] bool over() const { return next_ == question_count; }
  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return client_.next_deadline(); }

 private:
  void ask() { (void)client_.upload(question(next_).index, question(next_).sub_index, memory_, bus_.now()); }

  /// A node that did not answer once is not queried again.
  void go_on() {
    if (over() || client_.busy()) return;
    if (client_.result() == canopen::ok) take(client_.data());
    const bool silent = client_.result() == canopen::AbortCode::timeout;
    next_ = silent ? question_count : next_ + 1;
    if (!over()) ask();
  }

  /// The response may not state the size of a number.
  void take(std::span<const std::uint8_t> bytes) {
    if (next_ == name_question) {
      node_.name.emplace(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      node_.name->erase(node_.name->find_last_not_of('\0') + 1);
      return;
    }
    const bool heartbeat = next_ == heartbeat_question;
    auto& number = heartbeat ? node_.heartbeat_ms : node_.identity.*identity_numbers[next_].value;
    number = static_cast<std::uint32_t>(number_of(bytes.first(std::min<std::size_t>(bytes.size(), heartbeat ? 2 : 4))));
  }

  LiveBus& bus_;
  FoundNode& node_;
  std::array<std::uint8_t, 256> memory_{};
  canopen::SdoClient<LiveBus> client_;
  std::size_t next_ = 0;
};

class Scan {
 public:
  Scan(LiveBus& bus, const ScanSettings& settings) : bus_{bus}, settings_{settings} {
    for (const std::uint8_t node_id : settings.nodes) nodes_[node_id].node_id = node_id;
  }

  void run() {
    const TimePoint begin = bus_.now();
    std::size_t next = 0;
    while (next != settings_.nodes.size() || !running_.empty() || waits_for_heartbeats(begin)) {
      while (next != settings_.nodes.size() && running_.size() < max_at_once) ask(settings_.nodes[next++]);
      if (const auto frame = bus_.receive(wait())) on_frame(*frame);
      for (Interview& interview : running_) interview.on_time(bus_.now());
      std::erase_if(running_, [](const Interview& interview) { return interview.over(); });
      ask_again();
      if (running_.empty() && next == settings_.nodes.size() && !asked_all_) {
        asked_all_ = true;
        asked_at_ = bus_.now();
      }
      if (Interruption::noted()) interrupt();
    }
  }

  [[nodiscard]] std::vector<FoundNode> found() const {
    std::vector<FoundNode> found;
    for (const std::uint8_t node_id : settings_.nodes) {
      const FoundNode& node = nodes_[node_id];
      if (!node.answers_sdo && !node.state) continue;
      found.push_back(node);
      found.back().has_extra_responses = watch_.has_extra_responses(node_id);
    }
    return found;
  }

 private:
  void ask(std::uint8_t node_id) {
    running_.emplace_back(bus_, nodes_[node_id], Duration{settings_.timeout_ms * 1000U});
    asked_[node_id] = true;
  }

  /// A node that was asked before its boot-up message and did not answer is asked once more.
  void ask_again() {
    for (const std::uint8_t node_id : std::exchange(booted_, {})) {
      if (nodes_[node_id].answers_sdo || !asked_[node_id]) continue;
      if (std::ranges::find(running_, node_id, &Interview::node_id) == running_.end()) {
        ask(node_id);
      } else {
        booted_.push_back(node_id);
      }
    }
  }

  [[nodiscard]] Duration wait() const {
    const TimePoint now = bus_.now();
    Duration shortest = look_again;
    for (const Interview& interview : running_) {
      const auto deadline = interview.next_deadline();
      if (deadline) shortest = std::min(shortest, *deadline > now ? *deadline - now : Duration{0});
    }
    return shortest;
  }

  void on_frame(const Frame& frame) {
    for (Interview& interview : running_) interview.on_frame(frame, bus_.now());
    const auto message = canopen::error_control_message(frame);
    if (!message) return;
    FoundNode& node = nodes_[message->node_id.value()];
    node.state = message->state;
    if (message->state != canopen::NmtState::initialisation || node.node_id == 0) return;
    if (!std::exchange(has_booted_[node.node_id], true)) booted_.push_back(node.node_id);
  }

  [[nodiscard]] bool waits_for_heartbeats(TimePoint begin) const {
    const TimePoint now = bus_.now();
    if (now - begin < Duration{settings_.listen_ms * 1000U}) return true;
    for (const FoundNode& node : nodes_) {
      const std::uint32_t heartbeat = node.heartbeat_ms.value_or(0);
      if (node.state || heartbeat == 0 || heartbeat > longest_heartbeat_ms) continue;
      if (now - asked_at_ < Duration{heartbeat * 1500U}) return true;
    }
    return false;
  }

  void interrupt() {
    for (Interview& interview : running_) interview.cancel();
    throw Interrupted{};
  }

  LiveBus& bus_;
  const ScanSettings& settings_;
  BusWatch watch_{bus_};
  std::array<FoundNode, 128> nodes_{};
  std::list<Interview> running_;
  std::array<bool, 128> asked_{}, has_booted_{};  ///< by node-ID
  std::vector<std::uint8_t> booted_;              ///< the nodes to be asked again
  bool asked_all_ = false;
  TimePoint asked_at_{};
};

}  // namespace

std::string extra_responses_text(unsigned node_id) {
  return fmt::format("an SDO request got more than one response; two nodes may have node-ID {}", node_id);
}

void scan(LiveBus& bus, const ScanSettings& settings, std::vector<FoundNode>& found) {
  Scan scan{bus, settings};
  try {
    scan.run();
  } catch (...) {
    found = scan.found();
    throw;
  }
  found = scan.found();
}

}  // namespace edsc
