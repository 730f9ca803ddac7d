#include "watch/alarm_command.hpp"

#include <utility>

#include "system/run_program.hpp"
#include "text/printable.hpp"
#include "watch/alarm_report.hpp"

namespace edsc::watch {
namespace {

std::vector<std::string> words_for_shell(const std::string& command_line) {
#ifdef _WIN32
  return {"cmd", "/c", command_line};
#else
  return {"/bin/sh", "-c", command_line};
#endif
}

}  // namespace

AlarmCommand::AlarmCommand(std::string command_line)
    : command_line_{std::move(command_line)}, thread_{[this] { run_all(); }} {}

AlarmCommand::~AlarmCommand() {
  {
    const std::lock_guard lock{mutex_};
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
  if (dropped_ > 0) print_to_stderr("edsc: --run: {} alarms did not run the command, which took too long\n", dropped_);
}

void AlarmCommand::run(const Alarm& alarm) {
  {
    const std::lock_guard lock{mutex_};
    if (waiting_.size() >= max_waiting) {
      ++dropped_;
      return;
    }
    waiting_.push_back(alarm_variables(alarm));
  }
  changed_.notify_one();
}

void AlarmCommand::run_all() {
  std::unique_lock lock{mutex_};
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    std::vector<std::string> variables = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    const auto outcome = run_program(words_for_shell(command_line_), {}, std::move(variables));
    if (!outcome) {
      print_to_stderr("edsc: --run: the command cannot be started\n");
    } else {
      write_to_stderr(outcome->output + outcome->errors);
      if (outcome->exit_code != 0) print_to_stderr("edsc: --run: exit code {}\n", outcome->exit_code);
    }
    lock.lock();
  }
}

}  // namespace edsc::watch
