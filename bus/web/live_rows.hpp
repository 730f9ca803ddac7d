/// What browsers show, as rows that change: from the thread of the bus to those of the clients.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace edsc {

struct LiveRow {
  std::string key;   ///< a later row with the same key replaces this one
  std::string json;  ///< one line
};

/// Each client gets the rows that have changed since it last asked, so that one that reads slowly gets the newest state
/// later, and costs neither memory nor the thread of the bus time.
class LiveRows {
 public:
  struct Update {
    std::uint64_t version = 0;
    std::string json;  ///< `{"rows":[...]}` in one line
  };

  /// Replaces rows, removes others, and wakes the clients.
  void publish(std::vector<LiveRow> rows, const std::vector<std::string>& removed = {});

  /// The rows that have changed after `version`, 0 for all; waits for a change. Nothing after this time, or at the end.
  [[nodiscard]] std::optional<Update> wait(std::uint64_t version, std::chrono::milliseconds most);

  /// Clients wait no longer.
  void end();
  [[nodiscard]] bool has_ended() const;

 private:
  struct Stored {
    std::string json;
    std::uint64_t version;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Stored> rows_;
  std::uint64_t version_ = 0;
  bool has_ended_ = false;
};

}  // namespace edsc
