#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "commands/commands.hpp"
#include "server/bus_server.hpp"
#include "server/candump_line.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "system/waiting_signals.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc bus                                  a bus at socketcand:127.0.0.1:29536/vcan0, until Ctrl-C
  edsc bus vcan0 vcan1                      two of them
  edsc bus --log bus.log                    and all frames as a log for edsc decode
  edsc bus --listen 127.0.0.1:0             at any free port; the first line names it)";

struct Settings {
  std::string listen = to_text(ListenAddress{});
  std::vector<std::string> buses{"vcan0"};
  BusLimits limits;
  std::string log;  ///< empty: none
};

/// A bus name is a word of up to 15 characters that is valid in an address and in a line of candump.
std::string bad_bus_name(const std::string& name) {
  const bool good = !name.empty() && name.size() <= 15 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return c > ' ' && c < 0x7F && c != '<' && c != '>' && c != '/';
  });
  return good ? "" : fmt::format("\"{}\" is not a bus name: up to 15 characters without blanks, <, > and /", name);
}

struct CloseLog {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Null for no file.
std::FILE* open_log(const std::string& path) {
  if (path.empty() || path == "-") return nullptr;
  std::FILE* const file = std::fopen(path.c_str(), "we");
  if (file == nullptr) fail(fmt::format("{}: {}", path, std::strerror(errno)));
  return file;
}

int serve(const Settings& settings) {
  const ListenAddress address = parse_listen_address(settings.listen);
  const WaitingSignals signals({SIGINT, SIGTERM}, WaitingSignals::Second::is_recorded);
  BusEvents events;
  const std::unique_ptr<std::FILE, CloseLog> file{open_log(settings.log)};
  std::FILE* const log = settings.log == "-" ? stdout : file.get();
  events.on_frame = [log](const canopen::Frame& frame, const std::string& bus, socketcand::TimeStamp time) {
    if (log != nullptr) print_visibly(log, "{}\n", candump_line(frame, bus, time));
  };
  events.on_trouble = [](const std::string& message) { print_to_stderr("edsc: {}\n", message); };
  BusServer server{address, settings.buses, settings.limits, std::move(events)};
  for (const std::string& bus : settings.buses) {
    const std::string place = fmt::format("socketcand:{}/{}\n", to_text(server.address()), bus);
    if (log == stdout) {
      write_to_stderr(place);
    } else {
      write_output(place);
    }
  }
  while (!WaitingSignals::noted()) {
    flush_output();
    if (file && std::fflush(file.get()) != 0) fail(fmt::format("{}: {}", settings.log, std::strerror(errno)));
    server.poll_once(std::chrono::minutes{1}, signals.while_waiting());
  }
  return exit_fine;
}

}  // namespace

void add_bus_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, serve, exit_code);
  command.add_option("--listen", settings.listen).check(listen_address_problem).show_default();
  command.add_option("NAME", settings.buses, "names of the buses").check(bad_bus_name).show_default();
  command.add_option("--clients", settings.limits.clients).range(1, 1000).show_default();
  command.add_option("--log", settings.log, "or - for standard output; the addresses are then on standard error");
}

}  // namespace edsc
