/// Firmware whose application measures periodically: the core sleeps between the calls.
#include <canopen/node.hpp>
#include <canopen/port/cortex_m.hpp>
#include <cstdint>
#include <pump/device.hpp>

#include "board.hpp"
#include "tickless_firmware/interrupt_serial_bus.hpp"
#include "tickless_firmware/mps2_interrupts.hpp"

/// For the test: number of times that the core has slept, and of calls of the slow function.
extern "C" {
volatile std::uint32_t wake_ups = 0;
volatile std::uint32_t seconds = 0;
}

namespace {

namespace od = pump::od;

constinit InterruptSerialBus bus;

struct Sensor {
  /// At power-on.
  void start(auto& node) { node.set(od::pressure{}, 100); }
  /// The pressure rises by 1 mbar each 20 ms: TPDO 1 is sent.
  void every(canopen::Milliseconds<20>, auto& node) {
    node.set(od::pressure{}, static_cast<std::uint16_t>(node.get(od::pressure{}) + 1));
  }
  void every(canopen::Seconds<1>) { seconds = seconds + 1; }
};

canopen::Node<pump::Device, InterruptSerialBus, Sensor> node{bus};

void on_uart_received() {
  board::word_at(interrupts::uart_clear) = 2;
  bus.on_interrupt();
}
void on_uart_sent() { board::word_at(interrupts::uart_clear) = 1; }
void on_alarm() { interrupts::AlarmTimer::stop(); }

using Handler = void (*)();
[[gnu::section(".interrupt_vectors"), gnu::used]] constexpr Handler vectors[] = {
    on_uart_received, on_uart_sent, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, on_alarm};

}  // namespace

int main() {
  board::start();
  node.start(canopen::NodeId{EDSC_NODE_ID}, board::now());
  interrupts::start();
  for (;;) {
    while (const auto frame = bus.receive()) node.on_frame(*frame, board::now());
    node.on_time(board::now());
    bus.flush();
    const bool slept =
        canopen::sleep_unless([] { return !bus.idle() || !interrupts::set_alarm(node.next_deadline()); });
    if (slept) wake_ups = wake_ups + 1;
  }
}
