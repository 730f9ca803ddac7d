/// The summary of a log: frames by service and node, SDO transfers, aborts, EMCY messages, times.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "decode/log/log_line.hpp"
#include "decode/message.hpp"

namespace edsc {

using ServiceCounts = std::array<std::size_t, service_count>;
using CodeCounts = std::map<std::pair<std::uint8_t, std::uint32_t>, std::size_t>;  ///< by node and code

class Summary {
 public:
  void add(const LogLine& line, const Message& message);
  void add_broken_line() { ++broken_lines_; }
  void add_can_fd() { ++can_fd_frames_; }
  void set_open_transfers(std::size_t count) { open_transfers_ = count; }
  [[nodiscard]] std::size_t broken_lines() const { return broken_lines_; }

  [[nodiscard]] std::string text() const;
  /// One object on a line, with the only member `summary`.
  [[nodiscard]] std::string json() const;

 private:
  static constexpr std::size_t node_ids = 128;
  static constexpr std::size_t max_codes = 1000;  ///< of errors and aborts; any more are counted as transfers only

  struct Node {
    ServiceCounts frames{};
    bool sends = false;
    std::size_t finished = 0, aborted = 0, timed = 0;  ///< transfers
    std::uint64_t sum_us = 0, longest_us = 0;

    [[nodiscard]] std::size_t transfers() const { return finished + aborted; }
  };

  static void count_code(CodeCounts& codes, std::uint8_t node_id, std::uint32_t code);
  [[nodiscard]] ServiceCounts all_frames() const;
  [[nodiscard]] double seconds() const { return static_cast<double>(last_us_ - *first_us_) / 1e6; }
  [[nodiscard]] bool is_silent(std::size_t id) const;
  [[nodiscard]] std::string silent_nodes() const;

  std::array<Node, node_ids> nodes_{};  ///< by node-ID; 0: frames without node
  CodeCounts emergencies_, aborts_;
  std::size_t frames_ = 0, broken_lines_ = 0, can_fd_frames_ = 0, open_transfers_ = 0, problems_ = 0;
  std::optional<std::int64_t> first_us_;
  std::int64_t last_us_ = 0;
};

}  // namespace edsc
