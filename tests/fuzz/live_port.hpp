/// A bus in simulated time with one hostile node; the input replaces the node's answers.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include "fuzz.hpp"
#include "online/live_bus.hpp"
#include "steps.hpp"

namespace edsc::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// An SDO server that executes every request: expedited and segmented transfers of CiA 301, 7.2.4.3.
class ObedientServer {
 public:
  std::map<std::uint32_t, Bytes> values;  ///< by index and sub-index: `0x100017`

  [[nodiscard]] std::optional<std::array<std::uint8_t, 8>> answer(const std::uint8_t (&request)[8]) {
    const std::uint32_t entry = std::uint32_t{request[2]} << 16 | std::uint32_t{request[1]} << 8 | request[3];
    switch (request[0] >> 5) {
      case 0: return take_segment(request);
      case 1: return begin_download(request, entry);
      case 2: return begin_upload(request, entry);
      case 3: return give_segment(request);
      case 4: return std::nullopt;  // an abort ends the transfer
      default: return abort(request, 0x0504'0001);
    }
  }

 private:
  using Answer = std::array<std::uint8_t, 8>;

  static Answer abort(const std::uint8_t (&request)[8], std::uint32_t code) {
    Answer answer{0x80, request[1], request[2], request[3]};
    std::memcpy(&answer[4], &code, sizeof code);
    return answer;
  }

  Answer begin_download(const std::uint8_t (&request)[8], std::uint32_t entry) {
    entry_ = entry;
    values[entry_].clear();
    if ((request[0] & 2) != 0) {
      const std::size_t size = (request[0] & 1) != 0 ? 4u - (request[0] >> 2 & 3u) : 4u;
      values[entry_].assign(request + 4, request + 4 + size);
    }
    return {0x60, request[1], request[2], request[3]};
  }

  Answer take_segment(const std::uint8_t (&request)[8]) {
    const std::size_t size = 7u - (request[0] >> 1 & 7u);
    values[entry_].insert(values[entry_].end(), request + 1, request + 1 + size);
    return {static_cast<std::uint8_t>(0x20 | (request[0] & 0x10))};
  }

  Answer begin_upload(const std::uint8_t (&request)[8], std::uint32_t entry) {
    const auto found = values.find(entry);
    if (found == values.end()) return abort(request, 0x0602'0000);
    entry_ = entry;
    sent_ = 0;
    const Bytes& value = found->second;
    Answer answer{0x41, request[1], request[2], request[3]};
    if (value.empty() || value.size() > 4) {
      const auto size = static_cast<std::uint32_t>(value.size());
      std::memcpy(&answer[4], &size, sizeof size);
    } else {
      answer[0] = static_cast<std::uint8_t>(0x43 | (4 - value.size()) << 2);
      std::memcpy(&answer[4], value.data(), value.size());
    }
    return answer;
  }

  Answer give_segment(const std::uint8_t (&request)[8]) {
    const Bytes& value = values[entry_];
    const std::size_t size = std::min<std::size_t>(7, value.size() - std::min(sent_, value.size()));
    Answer answer{static_cast<std::uint8_t>((request[0] & 0x10) | (7 - size) << 1 | (sent_ + size >= value.size()))};
    if (size != 0) std::memcpy(&answer[1], value.data() + sent_, size);
    sent_ += size;
    return answer;
  }

  std::uint32_t entry_ = 0;
  std::size_t sent_ = 0;
};

/// The port of a command: the server answers, or the steps of the input replace its answers.
class LivePort final : public BusPort {
 public:
  static constexpr std::uint8_t node_id = 6;
  /// More frames than any command sends to a node.
  static constexpr unsigned max_frames = 100'000;

  LivePort(Steps steps, bool silent_at_end, ObedientServer& server)
      : next_{steps.begin()}, end_{steps.end()}, silent_at_end_{silent_at_end}, server_{server} {}

  bool reads_only = false;  ///< true: no request may write

  bool send(const canopen::Frame& frame) override {
    require(frame.size == 8 && !frame.extended && !frame.remote, "a request is a data frame of eight bytes");
    require(frame.id > 0x600 && frame.id <= 0x67F, "only SDO requests are sent");
    require(++sent_ < max_frames, "a command ends");
    if (reads_only) {
      const unsigned command = frame.data[0] >> 5;
      require(command == 2 || command == 3 || command == 4 || command == 5, "a command that reads does not write");
    }
    if (frame.id == 0x600u + node_id) request_ = frame;
    return true;
  }

  std::optional<canopen::Frame> receive(canopen::Duration timeout) override {
    if (next_ == end_) return silent_at_end_ ? wait(timeout) : answer_or_wait(timeout);
    const Step step = *next_;
    ++next_;
    switch (step.what % 8) {
      case 3: return spoilt(step, timeout);
      case 4: return received(frame(0x580u + node_id, step.data.data(), 8));
      case 5: return received(frame((step.number | step.other << 8u) & 0x7FFu, step.data.data(), step.choice % 9u));
      case 6: return wait(std::min(timeout, canopen::from_milliseconds(step.choice)));
      case 7: return received(frame(0x700u + node_id, step.data.data(), 1));
      default: return answer_or_wait(timeout);
    }
  }

  canopen::TimePoint now() const override { return now_; }
  canopen::TimePoint received_at() const override { return now_; }

 private:
  static canopen::Frame frame(std::uint32_t id, const std::uint8_t* data, std::size_t size) {
    canopen::Frame frame;
    frame.id = id;
    frame.size = static_cast<std::uint8_t>(size);
    std::memcpy(frame.data.data(), data, size);
    return frame;
  }

  std::optional<canopen::Frame> wait(canopen::Duration timeout) {
    now_ = now_ + std::max(timeout, canopen::Duration{1});
    return std::nullopt;
  }

  /// A frame takes a millisecond, so that time also passes on a bus that is never silent.
  canopen::Frame received(const canopen::Frame& frame) {
    now_ = now_ + canopen::from_milliseconds(1);
    return frame;
  }

  std::optional<canopen::Frame> answer_or_wait(canopen::Duration timeout) {
    if (!request_) return wait(timeout);
    std::uint8_t request[8];
    std::memcpy(request, request_->data.data(), sizeof request);
    request_.reset();
    const auto answer = server_.answer(request);
    if (!answer) return wait(timeout);
    return received(frame(0x580u + node_id, answer->data(), answer->size()));
  }

  std::optional<canopen::Frame> spoilt(const Step& step, canopen::Duration timeout) {
    auto answer = answer_or_wait(timeout);
    if (answer) {
      for (std::size_t i = 0; i != 8; ++i) answer->data[i] ^= step.data[i];
    }
    return answer;
  }

  Steps::Iterator next_;
  Steps::Iterator end_;
  bool silent_at_end_;
  ObedientServer& server_;
  std::optional<canopen::Frame> request_;
  canopen::TimePoint now_{};
  unsigned sent_ = 0;
};

}  // namespace edsc::fuzz
