#include "server/bus_server.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace edsc {
namespace {

/// Maximum bytes read from one client before the next one is served.
constexpr std::size_t bytes_at_once = 4096;

[[noreturn]] void fail(const std::string& what) { throw std::system_error{errno, std::generic_category(), what}; }

socketcand::TimeStamp present() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return {time.tv_sec, static_cast<std::int32_t>(time.tv_nsec / 1000)};
}

void set_option(int socket, int level, int option) {
  const int on = 1;
  static_cast<void>(::setsockopt(socket, level, option, &on, sizeof on));
}

ListenAddress address_of(const sockaddr_storage& address, socklen_t size) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  if (::getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(), port.data(),
                    port.size(), NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return {"?", 0};
  return {host.data(), static_cast<std::uint16_t>(std::stoul(port.data()))};
}

bool lacks_descriptors(int error) { return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM; }

canopen::Descriptor open_reserve() { return canopen::Descriptor{::open("/dev/null", O_RDONLY | O_CLOEXEC)}; }

}  // namespace

BusServer::BusServer(const ListenAddress& address, std::vector<std::string> buses, BusLimits limits, BusEvents events)
    : address_{address},
      buses_{std::move(buses)},
      limits_{limits},
      events_{std::move(events)},
      reserve_{open_reserve()} {
  try {
    listen();
  } catch (...) {
    if (listener_ >= 0) ::close(listener_);
    throw;
  }
}

BusServer::~BusServer() { ::close(listener_); }

void BusServer::listen() {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string where = "listening at " + to_text(address_);
  if (const int error = ::getaddrinfo(address_.host.c_str(), std::to_string(address_.port).c_str(), &hints, &found);
      error != 0)
    throw std::runtime_error{where + ": " + ::gai_strerror(error)};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> first{found, &::freeaddrinfo};
  listener_ = ::socket(first->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (listener_ < 0) fail(where);
  set_option(listener_, SOL_SOCKET, SO_REUSEADDR);
  if (::bind(listener_, first->ai_addr, first->ai_addrlen) != 0 || ::listen(listener_, SOMAXCONN) != 0) fail(where);
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (::getsockname(listener_, reinterpret_cast<sockaddr*>(&bound), &size) != 0) fail(where);
  address_.port = address_of(bound, size).port;
}

void BusServer::poll_once(std::chrono::milliseconds wait, const sigset_t* signals) {
  const auto begin = Clock::now();
  const bool accepts = begin >= accepts_from_;
  std::vector<pollfd> ready{{accepts ? listener_ : -1, POLLIN, 0}};
  for (const auto& client : clients_) {
    ready.push_back({client->socket(), static_cast<short>(POLLIN | (client->backlog() > 0 ? POLLOUT : 0)), 0});
  }
  wait = until_handshake_ends(wait);
  if (!accepts) wait = std::min(wait, std::chrono::ceil<std::chrono::milliseconds>(accepts_from_ - begin));
  const timespec span{wait.count() / 1000, wait.count() % 1000 * 1'000'000};
  const int count = ::ppoll(ready.data(), ready.size(), &span, signals);
  if (count < 0 && errno != EINTR) fail("poll");
  if (count < 0) return;
  const auto now = Clock::now();
  std::vector<std::unique_ptr<BusClient>> leaving;
  for (std::size_t i = 1; i < ready.size(); ++i) {
    auto& client = clients_[i - 1];
    const bool readable = (ready[i].revents & (POLLIN | POLLHUP | POLLERR)) != 0;
    // The request of a client may have arrived after the wait, if this process was suspended for long.
    if ((!readable && !is_overdue(*client, now)) || receive(*client)) continue;
    static_cast<void>(client->flush());
    leaving.push_back(std::move(client));
  }
  std::erase(clients_, nullptr);
  if (ready[0].revents != 0) accept();
  flush(now);
}

std::unique_ptr<BusClient> BusServer::accept_client() const {
  sockaddr_storage from{};
  socklen_t size = sizeof from;
  const int socket = ::accept4(listener_, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (socket < 0) return nullptr;
  set_option(socket, IPPROTO_TCP, TCP_NODELAY);
  return std::make_unique<BusClient>(socket, to_text(address_of(from, size)));
}

void BusServer::accept() {
  auto client = accept_client();
  if (!client && lacks_descriptors(errno)) return refuse_without_descriptor();
  if (!client && (errno == EAGAIN || errno == EINTR || errno == ECONNABORTED)) return;
  if (!client) fail("accept");
  if (clients_.size() < limits_.clients) {
    client->put("< hi >");
    clients_.push_back(std::move(client));
    return;
  }
  turn_away(*client, "too many clients");
}

/// The listener stays readable: a client that is not accepted would end each wait at once.
void BusServer::refuse_without_descriptor() {
  constexpr std::chrono::milliseconds pause{100};
  const std::string reason = std::generic_category().message(errno);
  static_cast<void>(reserve_.close());
  if (const auto client = accept_client()) {
    turn_away(*client, "too many open files");
  } else {
    accepts_from_ = Clock::now() + pause;
    events_.on_trouble("no client can be accepted: " + reason);
  }
  reserve_ = open_reserve();
}

void BusServer::turn_away(BusClient& client, const std::string& reason) const {
  client.refuse(reason);
  static_cast<void>(client.flush());
  log(client, reason);
}

/// Reads the input of the client. Returns false if it must be disconnected.
bool BusServer::receive(BusClient& client) {
  std::array<char, bytes_at_once> bytes{};
  const ssize_t size = ::recv(client.socket(), bytes.data(), bytes.size(), 0);
  if (size < 0) return errno == EAGAIN || errno == EINTR;
  set_option(client.socket(), IPPROTO_TCP, TCP_QUICKACK);  // otherwise a client without TCP_NODELAY waits for it
  for (ssize_t i = 0; i < size; ++i) {
    if (!answer(client, client.take(bytes[static_cast<std::size_t>(i)]))) return false;
  }
  return size > 0;
}

/// Returns false if the client must be disconnected.
bool BusServer::answer(BusClient& client, const ClientRequest& request) {
  switch (request.kind) {
    case ClientRequest::Kind::nothing: return true;
    case ClientRequest::Kind::open_bus: return open_bus(client, request.text);
    case ClientRequest::Kind::send_frame: deliver(client, request.frame); return true;
    case ClientRequest::Kind::leave: log(client, request.text); return false;
  }
  return true;
}

bool BusServer::open_bus(BusClient& client, const std::string& name) {
  const auto found = std::find(buses_.begin(), buses_.end(), name);
  if (found == buses_.end()) {
    client.refuse("could not open bus");
    log(client, "bus \"" + name + "\" does not exist");
    return false;
  }
  client.opened(static_cast<std::size_t>(found - buses_.begin()));
  return true;
}

void BusServer::deliver(const BusClient& sender, const canopen::Frame& frame) {
  const auto time = present();
  const std::string text = socketcand::received_text(frame, time);
  for (const auto& client : clients_) {
    if (client && client.get() != &sender && client->listens() && client->bus() == sender.bus()) client->put(text);
  }
  events_.on_frame(frame, buses_[*sender.bus()], time);
}

/// The time until the next client exceeds its time to open a bus.
std::chrono::milliseconds BusServer::until_handshake_ends(std::chrono::milliseconds at_most) const {
  const auto now = Clock::now();
  for (const auto& client : clients_) {
    if (client->bus()) continue;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(client->since() + limits_.handshake - now);
    at_most = std::clamp(left, std::chrono::milliseconds{0}, at_most);
  }
  return at_most;
}

bool BusServer::is_overdue(const BusClient& client, Clock::time_point now) const {
  return !client.bus() && now - client.since() >= limits_.handshake;
}

/// Sends pending data. Disconnects clients that are lost, read too slowly or had not opened a bus in time.
void BusServer::flush(Clock::time_point now) {
  std::erase_if(clients_, [&](const std::unique_ptr<BusClient>& client) {
    if (!client->flush()) return true;
    if (client->backlog() > limits_.backlog) {
      log(*client, "it reads too slowly: " + std::to_string(client->backlog()) + " bytes are pending");
      return true;
    }
    if (!is_overdue(*client, now)) return false;
    client->refuse("no bus was opened in time");
    static_cast<void>(client->flush());
    log(*client, "it did not open a bus within " + std::to_string(limits_.handshake.count()) + " ms");
    return true;
  });
}

void BusServer::log(const BusClient& client, const std::string& message) const {
  events_.on_trouble("client " + client.name() + " is disconnected: " + message);
}

}  // namespace edsc
