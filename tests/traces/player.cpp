#include "player.hpp"

#include <algorithm>
#include <deque>
#include <optional>

namespace trace {

namespace {

class Player {
 public:
  Player(const Trace& trace, const std::vector<std::unique_ptr<Station>>& stations)
      : trace_{trace}, stations_{stations} {}

  std::vector<Failure> play() {
    power_on();
    if (!trace_.power_on) heard_.clear();
    for (std::size_t i = 0; i < trace_.lines.size(); ++i) {
      const Line& line = trace_.lines[i];
      switch (line.step) {
        case Step::set:
          expect_silence(line);
          set(line);
          if (i + 1 == trace_.lines.size() || trace_.lines[i + 1].step != Step::set) let_all_act();
          break;
        case Step::input:
          expect_silence(line);
          if (!stations_[line.node]->input(line.input, now_)) fail(line, "the application knows no such line");
          let_all_act();
          break;
        case Step::emergency:
          expect_silence(line);
          stations_[line.node]->emergency(line.emergency);
          let_all_act();
          break;
        case Step::emergency_over:
          expect_silence(line);
          stations_[line.node]->emergency_over(line.emergency.bits);
          let_all_act();
          break;
        case Step::power_off:
          expect_silence(line);
          for (const auto& station : stations_) station->power_off();
          break;
        case Step::power_on: power_on(); break;
        case Step::pass:
          expect_silence(line);
          pass(line);
          break;
        case Step::send:
          expect_silence(line);
          send(line);
          break;
        case Step::expect: expect(line); break;
        case Step::disregard: disregarded_.push_back(line.pattern.frame.id); break;
        case Step::read: read(line); break;
      }
    }
    if (!trace_.lines.empty()) expect_silence(trace_.lines.back());
    return failures_;
  }

 private:
  static constexpr int max_rounds = 100;  ///< calls of all nodes at one moment

  void fail(const Line& line, std::string message) { failures_.push_back({line.number, std::move(message)}); }

  /// Checks that the trace contains all frames that the nodes have sent.
  void expect_silence(const Line& before) {
    for (const canopen::Frame& frame : heard_) {
      if (!is_disregarded(frame)) fail(before, "up to here not expected: " + to_text(frame));
    }
    heard_.clear();
  }

  void power_on() {
    for (const auto& station : stations_) station->power_on(now_);
    exchange();
  }

  void send(const Line& line) {
    for (const auto& station : stations_) station->on_frame(line.pattern.frame, now_);
    let_all_act();
  }

  void pass(const Line& line) {
    const canopen::TimePoint end = now_ + line.span;
    int rounds = 0;
    while (const auto deadline = next_deadline()) {
      if (*deadline > end) break;
      if (*deadline > now_) {
        now_ = *deadline;
        rounds = 0;
      } else if (++rounds == max_rounds) {
        return fail(line, "a node has something to do and does not do it");
      }
      let_all_act();
    }
    now_ = end;
    let_all_act();
  }

  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const {
    std::optional<canopen::TimePoint> next;
    for (const auto& station : stations_) {
      const auto deadline = station->next_deadline();
      if (deadline && (!next || *deadline < *next)) next = deadline;
    }
    return next;
  }

  void let_all_act() {
    for (const auto& station : stations_) station->on_time(now_);
    exchange();
  }

  /// Passes the frames of each node to the trace and to the other nodes, until all are silent.
  void exchange() {
    for (bool silent = false; !silent;) {
      silent = true;
      for (const auto& sender : stations_) {
        while (const auto frame = sender->take()) {
          silent = false;
          heard_.push_back(*frame);
          for (const auto& receiver : stations_) {
            if (receiver == sender) continue;
            receiver->on_frame(*frame, now_);
            receiver->on_time(now_);
          }
        }
      }
    }
  }

  [[nodiscard]] bool is_disregarded(const canopen::Frame& frame) const {
    return std::ranges::find(disregarded_, frame.id) != disregarded_.end();
  }

  void expect(const Line& line) {
    while (!heard_.empty() && is_disregarded(heard_.front()) && !line.pattern.matches(heard_.front())) {
      heard_.pop_front();
    }
    if (heard_.empty()) return fail(line, "expected: " + to_text(line.pattern) + "\n  got:      nothing");
    const canopen::Frame got = heard_.front();
    heard_.pop_front();
    if (!line.pattern.matches(got)) fail(line, "expected: " + to_text(line.pattern) + "\n  got:      " + to_text(got));
  }

  void set(const Line& line) {
    const canopen::AbortCode code = stations_[line.node]->set(line.index, line.sub_index, line.value);
    if (code != canopen::ok) fail(line, "the application cannot set it: " + std::string{canopen::to_text(code)});
  }

  void read(const Line& line) {
    const auto got = stations_[line.node]->value(line.index, line.sub_index);
    if (!got) return fail(line, "the device has no such object");
    const auto expected = line.value.bytes(got->size());
    if (*got != expected) fail(line, "expected: " + to_text(expected) + "\n  got:      " + to_text(*got));
  }

  const Trace& trace_;
  const std::vector<std::unique_ptr<Station>>& stations_;
  canopen::TimePoint now_{};
  std::deque<canopen::Frame> heard_;        ///< sent by the nodes, not yet expected by the trace
  std::vector<std::uint32_t> disregarded_;  ///< CAN-IDs
  std::vector<Failure> failures_;
};

}  // namespace

std::vector<Failure> play(const Trace& trace, const std::vector<std::unique_ptr<Station>>& stations) {
  return Player{trace, stations}.play();
}

}  // namespace trace
