#include "online/simulated_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <canopen_sim/simulation_codec.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "online/interruption.hpp"

namespace edsc {

namespace simulation = canopen::simulation;

namespace {

using canopen::AbortCode;
using canopen::Duration;
using canopen::Frame;
using canopen::TimePoint;

constexpr std::string_view scheme = "simulated:";
constexpr std::size_t longest_line = 4096;
constexpr timeval longest_wait{0, 100'000};
constexpr int waits_after_interruption = 10;
constexpr std::size_t max_requests = 16'384;  // bytes pending until the next request for a response

struct SimulatedAddress {
  std::string program;
  unsigned node_id = 0;
  std::string name;
};

SimulatedAddress parse_address(const std::string& address) {
  const std::string_view rest = std::string_view{address}.substr(scheme.size());
  const std::size_t at = rest.rfind('@');
  if (at != std::string_view::npos && at != 0) {
    const std::string_view device = rest.substr(at + 1);
    const std::size_t comma = std::min(device.find(','), device.size());
    const auto node_id = simulation::number(device.substr(0, comma), 10, 255U);
    const std::string_view name = device.substr(std::min(comma + 1, device.size()));
    const bool good_node_id = node_id && ((*node_id >= 1 && *node_id <= 127) || *node_id == 255);
    const bool good_name =
        name.find_first_of(" \n") == std::string_view::npos && (comma == device.size()) == name.empty();
    if (good_node_id && good_name) return {std::string{rest.substr(0, at)}, *node_id, std::string{name}};
  }
  throw std::invalid_argument{
      fmt::format("\"{}\" is not a simulation; expected simulated:PROGRAM@NODE-ID[,NAME]", address)};
}

std::string end_text(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("was ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  }
  return fmt::format("has ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace

bool SimulatedPort::is_address(std::string_view text) { return text.starts_with(scheme); }

SimulatedPort::SimulatedPort(const std::string& address) {
  const SimulatedAddress parsed = parse_address(address);
  start(parsed.program);
  try {
    const std::string line = read_line();
    if (line != simulation::greeting) lost(line);
    if (!make_node(parsed.node_id, parsed.name)) {
      throw BusLost{fmt::format("the program does not have a device \"{}\"", parsed.name)};
    }
  } catch (const BusLost& problem) {
    (void)end_of_program();
    throw std::runtime_error{fmt::format("{}: {}", address, problem.what())};
  } catch (const Interrupted&) {
    (void)end_of_program();
    throw;
  }
}

SimulatedPort::~SimulatedPort() { (void)end_of_program(); }

void SimulatedPort::start(const std::string& program) {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0) {
    throw std::system_error{errno, std::generic_category(), program};
  }
  connection_ = canopen::Descriptor{pair[0]};
  ::setsockopt(connection_.number(), SOL_SOCKET, SO_RCVTIMEO, &longest_wait, sizeof longest_wait);
  const canopen::Descriptor other{pair[1]};

  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, other.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, other.number(), STDOUT_FILENO);
  // A separate process group: Ctrl-C is for the command, which ends the program.
  posix_spawnattr_t attributes{};
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::string path = program;
  std::array<char*, 2> arguments = {path.data(), nullptr};
  const int error = ::posix_spawn(&process_, path.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    process_ = -1;
    throw std::system_error{error, std::generic_category(), program};
  }
}

std::string SimulatedPort::end_of_program() {
  using Clock = std::chrono::steady_clock;
  if (process_ < 0) return "has ended";
  connection_ = canopen::Descriptor{};
  const auto limit = Clock::now() + std::chrono::seconds{2};
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(process_, &status, WNOHANG)) == 0 && Clock::now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  if (ended == 0) {
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  process_ = -1;
  return ended == 0 ? "no longer accepts requests" : end_text(status);
}

void SimulatedPort::lost() { throw BusLost{fmt::format("the program {}", end_of_program())}; }

void SimulatedPort::lost(const std::string& answer) {
  throw BusLost{fmt::format("unexpected line \"{}\" of the program; is it a simulation of edsc?", answer)};
}

void SimulatedPort::flush() {
  std::string_view left{requests_};
  while (!left.empty()) {
    const ssize_t sent = ::send(connection_.number(), left.data(), left.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EINTR) lost();
    if (sent > 0) left.remove_prefix(static_cast<std::size_t>(sent));
  }
  requests_.clear();
}

std::string SimulatedPort::read_line() {
  for (int waits = 0;;) {
    const std::size_t end = answers_.find('\n');
    if (end != std::string::npos) {
      std::string line = answers_.substr(0, end);
      answers_.erase(0, end + 1);
      return line;
    }
    if (answers_.size() > longest_line) lost(answers_.substr(0, 40));
    std::array<char, 1024> piece;
    const ssize_t got = ::recv(connection_.number(), piece.data(), piece.size(), 0);
    if (got > 0) {
      answers_.append(piece.data(), static_cast<std::size_t>(got));
    } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
      lost();
    } else if (Interruption::noted() && ++waits == waits_after_interruption) {
      throw Interrupted{};
    }
  }
}

bool SimulatedPort::send(const Frame& frame) {
  requests_ += "send ";
  simulation::append_frame(requests_, frame);
  requests_ += '\n';
  if (requests_.size() > max_requests) flush();
  return true;
}

std::optional<Frame> SimulatedPort::receive(Duration timeout) {
  if (timeout == Duration{0} && requests_.empty()) return std::nullopt;  // a frame takes time on the wire
  requests_ += fmt::format("run {}\n", std::min(timeout, canopen::longest_span).count());
  flush();
  const std::string line = read_line();
  std::string_view words = line;
  const auto time = simulation::number(simulation::take_word(words), 10, UINT64_MAX);
  if (!time || *time < now_us_) lost(line);
  now_us_ = *time;
  if (words.empty()) return std::nullopt;
  const auto frame = simulation::parse_frame(words);
  if (!frame) lost(line);
  received_at_ = now();
  return frame;
}

TimePoint SimulatedPort::now() const { return TimePoint{Duration{static_cast<std::uint32_t>(now_us_)}}; }

bool SimulatedPort::make_node(unsigned node_id, std::string_view name) {
  constexpr std::string_view without = "without=";
  requests_ += fmt::format("node {}{}{}\n", node_id, name.empty() ? "" : " ", name);
  flush();
  const std::string line = read_line();
  if (line == "no") return false;
  std::string_view words = line;
  if (simulation::take_word(words) != "ok") lost(line);
  while (!words.empty()) {
    const std::string_view word = simulation::take_word(words);
    if (word == "composition=edsc") {
      composition_.made_by_edsc = true;
    } else if (word.starts_with(without) && word.size() > without.size()) {
      composition_.omitted.emplace_back(word.substr(without.size()));
    } else {
      lost(line);
    }
  }
  return true;
}

std::optional<AbortCode> SimulatedPort::ask(const std::string& request) {
  constexpr std::string_view refused = "refused ";
  requests_ += request + "\n";
  flush();
  const std::string line = read_line();
  if (line == "ok") return canopen::ok;
  if (line == "no") return std::nullopt;
  if (line.starts_with(refused)) {
    const auto code = simulation::number(std::string_view{line}.substr(refused.size()), 16, UINT32_MAX);
    if (code && *code != 0) return AbortCode{*code};
  }
  lost(line);
}

std::optional<AbortCode> SimulatedPort::set(std::uint16_t index, std::uint8_t sub_index,
                                            std::span<const std::uint8_t> bytes) {
  std::string request = fmt::format("set {:04X} {:02X} ", index, sub_index);
  simulation::append_bytes(request, bytes);
  return ask(request);
}

bool SimulatedPort::emergency(std::uint16_t code, canopen::ErrorRegister bits) {
  return ask(fmt::format("emergency {:04X} {:02X}", code, static_cast<unsigned>(bits))) == canopen::ok;
}

bool SimulatedPort::emergency_over(canopen::ErrorRegister bits) {
  return ask(fmt::format("emergency_over {:02X}", static_cast<unsigned>(bits))) == canopen::ok;
}

bool SimulatedPort::power_cycle() { return ask("power_cycle") == canopen::ok; }

}  // namespace edsc
