#include "server/bus_client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

namespace edsc {
namespace {

using Command = BusClient::Command;

/// The supported commands of the protocol.
struct CommandName {
  std::string_view name;
  Command command;
  bool needs_bus;
};
constexpr std::array command_names{
    CommandName{"open", Command::open, false},      CommandName{"rawmode", Command::rawmode, true},
    CommandName{"bcmmode", Command::bcmmode, true}, CommandName{"send", Command::send, true},
    CommandName{"sendrtr", Command::send, true},    CommandName{"echo", Command::echo, false},
};

}  // namespace

BusClient::BusClient(int socket, std::string name) : socket_{socket}, name_{std::move(name)} {}

BusClient::~BusClient() { ::close(socket_); }

ClientRequest BusClient::take(char c) {
  switch (reader_.take(c)) {
    case socketcand::ElementReader::Found::nothing: return ClientRequest::nothing;
    case socketcand::ElementReader::Found::element: return on_element(reader_.element());
    case socketcand::ElementReader::Found::too_long: return leave("element too long");
  }
  return ClientRequest::nothing;
}

ClientRequest BusClient::on_element(std::string_view element) {
  const std::string_view name = socketcand::Words{element}.next();
  for (const CommandName& known : command_names) {
    if (known.name != name) continue;
    if (known.needs_bus && !bus_) {
      refuse("no bus is open");
      return ClientRequest::nothing;
    }
    return on_command(known.command, element);
  }
  refuse("unknown command");
  return ClientRequest::nothing;
}

ClientRequest BusClient::on_command(Command command, std::string_view element) {
  switch (command) {
    case Command::open: {
      socketcand::Words words{element};
      static_cast<void>(words.next());
      wanted_bus_ = words.next();
      if (!bus_ && words.at_end()) return ClientRequest::open_bus;
      refuse(bus_ ? "a bus is already open" : "syntax error in open command");
      return ClientRequest::nothing;
    }
    case Command::rawmode:
    case Command::bcmmode:
      raw_ = command == Command::rawmode;
      put("< ok >");
      return ClientRequest::nothing;
    case Command::echo: put("< echo >"); return ClientRequest::nothing;
    case Command::send:
      if (const auto frame = socketcand::parse_send(element)) {
        frame_ = *frame;
        return ClientRequest::send_frame;
      }
      refuse("syntax error in send command");
      return ClientRequest::nothing;
  }
  return ClientRequest::nothing;
}

ClientRequest BusClient::leave(std::string reason) {
  refuse(reason);
  leaves_because_ = std::move(reason);
  return ClientRequest::leave;
}

void BusClient::opened(std::size_t bus) {
  bus_ = bus;
  put("< ok >");
}

void BusClient::refuse(std::string_view reason) {
  put("< error ");
  put(reason);
  put(" >");
}

bool BusClient::flush() {
  while (backlog() > 0) {
    const ssize_t sent = ::send(socket_, backlog_.data() + written_, backlog(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno != EAGAIN) return false;
    if (sent < 0) break;
    written_ += static_cast<std::size_t>(sent);
  }
  backlog_.erase(0, written_);
  written_ = 0;
  return true;
}

}  // namespace edsc
