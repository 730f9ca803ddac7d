/// A node in a task of FreeRTOS and of Zephyr, which are fakes on threads, under ThreadSanitizer. A second thread is
/// the interrupt of the CAN controller: it sends requests and gets all responses; a third one posts values. The node
/// sleeps unless there is work. `node_task_threads [REQUESTS]`
#include <atomic>
#include <canopen/can/receive_queue.hpp>
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/os/freertos.hpp>
#include <canopen/os/zephyr.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sample/device.hpp>
#include <thread>

#include "support/omitting.hpp"

namespace {

namespace od = sample::od;
using namespace std::chrono_literals;

/// Both directions of a bus with one other participant.
struct QueuePort {
  bool send(const canopen::Frame& frame) { return sent.push(frame); }
  std::optional<canopen::Frame> receive() { return received.pop(); }
  canopen::ReceiveQueue<64> received;
  canopen::ReceiveQueue<64> sent;
};

template <class System>
void wake_from_interrupt(System& system) {
  if constexpr (requires { system.wake_from_interrupt(); }) {
    system.wake_from_interrupt();
  } else {
    system.wake();
  }
}

/// Of the task that runs a node: its start, and the calls of a function with a period of 20 ms.
struct Application {
  void start() { ++starts; }
  void every(canopen::Milliseconds<20>) { ++calls; }
  std::uint32_t starts = 0;
  std::uint32_t calls = 0;
};

/// Returns whether all is well.
template <class System>
bool run(const char* name, std::uint32_t requests) {
  QueuePort port;
  canopen::Mailbox<od::unsigned64_value> mailbox;
  auto node = bench::make_node<sample::Device>(port, canopen::NodeId{5}, Application{}, canopen::values_from(mailbox));
  System system;
  std::atomic<bool> started = false;
  std::atomic<bool> stops = false;
  std::uint32_t passes = 0;
  std::uint32_t periods = 0;  // that have ended while the task ran

  std::thread task{[&] {
    if constexpr (requires { system.adopt_this_task(); }) system.adopt_this_task();
    const auto before = std::chrono::steady_clock::now();
    node.start(system.now());
    const std::uint8_t heartbeat[] = {20, 0};  // ms
    (void)node.set(0x1017, 0, heartbeat);
    canopen::NodeTask loop{node, port, system};
    started = true;
    for (; !stops; ++passes) loop.run_once();
    periods = static_cast<std::uint32_t>((std::chrono::steady_clock::now() - before) / 20ms);
  }};
  while (!started) std::this_thread::yield();

  std::thread poster{[&] {
    for (std::uint32_t i = 1; i <= requests; ++i) {
      mailbox.post<od::unsigned64_value>(std::uint64_t{i} << 32 | i);
      system.wake();
      if (i % 16 == 0) std::this_thread::sleep_for(100us);
    }
  }};

  std::uint32_t responses = 0;
  std::uint32_t heartbeats = 0;
  bool wrong = false;
  const auto collect = [&](auto until, std::chrono::milliseconds longest) {
    const auto end = std::chrono::steady_clock::now() + longest;
    while (!until() && std::chrono::steady_clock::now() < end) {
      const auto frame = port.sent.pop();
      if (!frame) {
        std::this_thread::yield();
      } else if (frame->id == 0x705) {
        ++heartbeats;
      } else {
        wrong = wrong || frame->id != 0x585 || frame->data[0] == 0x80;
        ++responses;
      }
    }
  };
  for (std::uint32_t i = 1; i <= requests; ++i) {
    port.received.push(canopen::Frame{.id = 0x605, .size = 8, .data = {0x40, 0x18, 0x10, 1}});
    wake_from_interrupt(system);
    collect([&] { return responses == i; }, 5s);
    if (responses != i) break;
  }
  poster.join();
  const std::uint32_t before = heartbeats;
  collect([] { return false; }, 300ms);
  const std::uint32_t quiet_heartbeats = heartbeats - before;  // 15
  stops = true;
  system.wake();
  task.join();
  const bool last_arrived = node.template get<od::unsigned64_value>() == (std::uint64_t{requests} << 32 | requests);
  const bool busy = passes > 3 * requests + 1'000;  // at most one pass for each request, post and deadline
  const bool asleep = quiet_heartbeats < 5;
  const Application& application = node.template application<Application>();
  const bool is_periodic =
      application.starts == 1 && application.calls >= periods / 3 && application.calls <= periods + 1;
  std::printf("%s: %u requests, %u responses, %u heartbeats, %u passes, %u calls in %u periods%s%s%s%s%s\n", name,
              requests, responses, heartbeats, passes, application.calls, periods, wrong ? ", a response is wrong" : "",
              last_arrived ? "" : ", the last value is missing", busy ? ", the task does not sleep" : "",
              asleep ? ", heartbeats are missing" : "", is_periodic ? "" : ", calls of the application are wrong");
  return responses == requests && !wrong && last_arrived && !busy && !asleep && is_periodic;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const std::uint32_t requests =
      argument_count > 1 ? static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10)) : 20'000;
  const bool freertos = run<canopen::FreeRtos>("FreeRTOS", requests);
  const bool zephyr = run<canopen::Zephyr>("Zephyr", requests);
  return freertos && zephyr ? 0 : 1;
}
