/// Measures the user and system CPU time of a node on SocketCAN per frame, compared with a read and write loop that
/// answers with prepared frames. `socketcan_path INTERFACE [FRAMES]`, on an otherwise unused interface.
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <canopen/host/socketcan.hpp>
#include <canopen/node.hpp>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <every_service/device.hpp>
#include <initializer_list>
#include <stdexcept>
#include <string>

namespace {

constexpr canopen::NodeId node_id{5};
constexpr canid_t nmt = 0x000;
constexpr canid_t rpdo = 0x205;
constexpr canid_t tpdo = 0x185;
constexpr canid_t request = 0x605;
constexpr canid_t response = 0x585;

can_frame frame(canid_t id, std::initializer_list<std::uint8_t> data) {
  can_frame result{};
  result.can_id = id;
  result.can_dlc = static_cast<std::uint8_t>(data.size());
  std::memcpy(result.data, data.begin(), data.size());
  return result;
}

const can_frame read_word = frame(request, {0x40, 0x01, 0x20, 0x00, 0, 0, 0, 0});

/// A blocking socket.
class RawSocket {
 public:
  explicit RawSocket(const std::string& interface) : socket_{::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)} {
    if (!socket_) canopen::throw_errno("socket");
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    if (::bind(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      canopen::throw_errno(interface);
    }
  }

  void filter(std::initializer_list<canid_t> ids) {
    std::array<can_filter, 8> filters{};
    std::size_t count = 0;
    for (const canid_t id : ids) filters[count++] = {id, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
    ::setsockopt(socket_.number(), SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                 static_cast<socklen_t>(count * sizeof(can_filter)));
  }
  void send(const can_frame& raw) {
    if (::write(socket_.number(), &raw, sizeof raw) != static_cast<ssize_t>(sizeof raw)) canopen::throw_errno("write");
  }
  [[nodiscard]] can_frame receive() {
    can_frame raw{};
    if (::read(socket_.number(), &raw, sizeof raw) != static_cast<ssize_t>(sizeof raw)) canopen::throw_errno("read");
    return raw;
  }

 private:
  canopen::Descriptor socket_;
};

std::atomic<bool> stop{false};

void run_node(const std::string& interface) {
  std::signal(SIGTERM, [](int) { stop = true; });
  canopen::SocketCan bus{interface};
  auto node = canopen::make_node<every_service::Device>(bus, node_id);
  bus.run(node, stop);
}

/// Reads only the CAN-ID.
void run_bare(const std::string& interface) {
  RawSocket bus{interface};
  bus.filter({nmt, rpdo, request});
  bus.send(frame(0x705, {0}));
  const can_frame answer = frame(response, {0x4B, 0x01, 0x20, 0x00, 0, 0, 0, 0});
  for (;;) {
    const can_frame raw = bus.receive();
    if (raw.can_id == request) bus.send(answer);
    if (raw.can_id == nmt) bus.send(frame(tpdo, {0, 0, 0, 0}));
    if (raw.can_id == rpdo && raw.data[6] == 0) {
      can_frame pdo = frame(tpdo, {0, 0, 0, 0});
      std::memcpy(pdo.data, raw.data, 3);
      bus.send(pdo);
    }
  }
}

void expect(RawSocket& bus, canid_t id) {
  if (bus.receive().can_id != id) throw std::runtime_error{"another frame was expected"};
}

/// One kind of communication with a node, with `frames` frames to it in total.
struct Talk {
  const char* what;
  void (*run)(RawSocket&, unsigned frames);
};

const Talk talks[] = {
    {"SDO request, response",
     [](RawSocket& bus, unsigned frames) {
       for (unsigned i = 0; i < frames; ++i) {
         bus.send(read_word);
         expect(bus, response);
       }
     }},
    {"RPDO, TPDO that answers it",
     [](RawSocket& bus, unsigned frames) {
       for (unsigned i = 0; i < frames; ++i) {
         bus.send(frame(rpdo, {static_cast<std::uint8_t>(i + 1), 0, 0, 0, 0, 0, 0}));
         expect(bus, tpdo);
       }
     }},
    {"RPDOs, 31 of 32 frames",
     [](RawSocket& bus, unsigned frames) {
       for (unsigned i = 1; i <= frames; ++i) {
         if (i % 32 != 0) bus.send(frame(rpdo, {0, 0, 0, 0, 0, 0, 1}));
         if (i % 32 == 0) {
           bus.send(read_word);
           expect(bus, response);
         }
       }
     }},
};

/// The CPU time of a process that answers, in us per frame that it receives.
double measure(const std::string& interface, void (*answerer)(const std::string&), const Talk& talk, unsigned frames) {
  RawSocket bus{interface};
  bus.filter({0x705, tpdo, response});
  const pid_t process = ::fork();
  if (process == 0) {
    answerer(interface);
    ::_exit(0);
  }
  expect(bus, 0x705);
  bus.send(frame(nmt, {0x01, node_id.value()}));
  expect(bus, tpdo);
  talk.run(bus, frames);
  ::kill(process, SIGTERM);
  int status = 0;
  rusage used{};
  ::wait4(process, &status, 0, &used);
  const auto microseconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_usec);
  };
  return (microseconds(used.ru_utime) + microseconds(used.ru_stime)) / frames;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const unsigned frames = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 32'000;
  try {
    std::printf("%-28s %10s %10s %8s\n", "CPU time of each frame", "bare, us", "node, us", "ratio");
    for (const Talk& talk : talks) {
      const double bare = measure(argv[1], run_bare, talk, frames);
      const double node = measure(argv[1], run_node, talk, frames);
      std::printf("%-28s %10.2f %10.2f %8.2f\n", talk.what, bare, node, node / bare);
    }
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
  return 0;
}
