/// Firmware whose application measures periodically: the core sleeps between the calls.
#include <canopen/node.hpp>
#include <canopen/port/cortex_m.hpp>
#include <cstdint>
#include <pump/device.hpp>

#include "board.hpp"
#include "tickless_firmware/interrupt_serial_bus.hpp"
#include "tickless_firmware/mps2_interrupts.hpp"

/// For the test.
extern "C" {
struct Counters {
  std::uint32_t starts;    ///< calls of `start`
  std::uint32_t wake_ups;  ///< how often the core has slept
  std::uint32_t calls;     ///< of the function with 20 ms
  std::uint32_t seconds;   ///< calls of the function with 1 s
};
volatile Counters counters{};
}

namespace {

namespace od = pump::od;

constinit InterruptSerialBus bus;

/// In place of an ADC.
void start_measuring() { counters.starts = counters.starts + 1; }
od::pressure::type measured() {
  counters.calls = counters.calls + 1;
  return od::pressure::type{canopen::raw(static_cast<std::uint16_t>(100 + counters.calls))};
}
/// In place of a LED.
void blink() { counters.seconds = counters.seconds + 1; }

struct Sensor {
  /// At power-on.
  void start() { start_measuring(); }
  /// TPDO 1 is sent when the pressure has changed.
  void every(canopen::Milliseconds<20>, auto& node) { node.set(od::pressure{}, measured()); }
  void every(canopen::Seconds<1>) { blink(); }
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
    if (slept) counters.wake_ups = counters.wake_ups + 1;
  }
}
