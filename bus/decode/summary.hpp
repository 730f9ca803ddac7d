/// The summary of a log: frames by service and node, SDO transfers, aborts, EMCY messages, times.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "decode/log_line.hpp"
#include "decode/message.hpp"
#include "decode/node_model.hpp"

namespace edsc {

class Summary {
 public:
  void add(const LogLine& line, const Message& message);
  void add_broken_line() { ++broken_lines_; }
  void add_can_fd() { ++can_fd_frames_; }
  void set_open_transfers(std::size_t count) { open_transfers_ = count; }

  [[nodiscard]] std::string text() const;
  /// One object on a line, with the only member `summary`.
  [[nodiscard]] std::string json() const;

 private:
  static constexpr std::size_t node_ids = 128;
  static constexpr std::size_t max_codes = 1000;  ///< of errors and aborts; any more are counted as transfers only

  struct Transfers {
    std::size_t finished = 0, aborted = 0, timed = 0;
    std::uint64_t sum_us = 0, longest_us = 0;
  };
  using Codes = std::map<std::pair<std::uint8_t, std::uint32_t>, std::size_t>;  ///< by node and code

  void count_code(Codes& codes, std::uint8_t node_id, std::uint32_t code);
  [[nodiscard]] std::size_t total(std::size_t service) const;
  [[nodiscard]] double seconds() const;
  [[nodiscard]] bool is_silent(std::size_t id) const;
  [[nodiscard]] std::string silent_nodes() const;

  std::array<std::array<std::size_t, service_count>, node_ids> frames_{};  ///< by node-ID; 0: frames without node
  std::array<Transfers, node_ids> transfers_{};
  std::array<bool, node_ids> heard_{};  ///< the node has sent a frame
  Codes emergencies_, aborts_;
  std::size_t frames_in_all_ = 0, broken_lines_ = 0, can_fd_frames_ = 0, open_transfers_ = 0, problems_ = 0;
  bool has_time_ = false;
  std::int64_t first_us_ = 0, last_us_ = 0;
};

}  // namespace edsc
