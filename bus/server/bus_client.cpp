#include "server/bus_client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace edsc {

BusClient::BusClient(int socket, std::string name) : socket_{socket}, name_{std::move(name)} {}

BusClient::~BusClient() { ::close(socket_); }

ClientRequest BusClient::take(char c) {
  using enum socketcand::ElementReader::Found;
  switch (reader_.take(c)) {
    case nothing: return {};
    case element: return on_element(reader_.element());
    case too_long: break;
  }
  constexpr const char* reason = "element too long";
  refuse(reason);
  return {ClientRequest::Kind::leave, reason};
}

ClientRequest BusClient::on_element(std::string_view element) {
  std::string_view rest = element;
  const std::string_view command = canopen::socketcand::take_word(rest);
  const bool sends = command == "send" || command == "sendrtr", selects = command == "rawmode" || command == "bcmmode";
  if (command == "open") return on_open(rest);
  if ((sends || selects) && !bus_) {
    refuse("no bus is open");
  } else if (selects) {
    raw_ = command == "rawmode";
    put("< ok >");
  } else if (sends) {
    if (const auto frame = socketcand::parse_send(element)) return {ClientRequest::Kind::send_frame, {}, *frame};
    refuse("syntax error in send command");
  } else if (command == "echo") {
    put("< echo >");
  } else {
    refuse("unknown command");
  }
  return {};
}

ClientRequest BusClient::on_open(std::string_view rest) {
  std::string bus{canopen::socketcand::take_word(rest)};
  if (!bus_ && canopen::socketcand::take_word(rest).empty()) return {ClientRequest::Kind::open_bus, std::move(bus)};
  refuse(bus_ ? "a bus is already open" : "syntax error in open command");
  return {};
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
