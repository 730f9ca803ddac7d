/// Runs a command line of the user for each alarm, while the watch goes on.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "watch/alarm.hpp"

namespace edsc::watch {

/// The commands run one after another in their own thread, with the alarm in variables of the environment. Their output
/// goes to standard error.
class AlarmCommand {
 public:
  /// Alarms that wait for the commands of earlier ones; further ones do not run a command, and are counted.
  static constexpr std::size_t max_waiting = 100;

  explicit AlarmCommand(std::string command_line);
  /// Waits until the commands of all alarms have ended.
  ~AlarmCommand();
  AlarmCommand(const AlarmCommand&) = delete;
  AlarmCommand& operator=(const AlarmCommand&) = delete;

  void run(const Alarm& alarm);

 private:
  void run_all();

  std::string command_line_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::vector<std::string>> waiting_;  ///< variables of the environment
  std::size_t dropped_ = 0;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace edsc::watch
