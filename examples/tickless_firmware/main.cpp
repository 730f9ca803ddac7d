/// Firmware without a tick: the core sleeps until an interrupt. The UART receives in its interrupt, a timer interrupts
/// at the next deadline of the node, and another one measures a value in its interrupt.
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/port/cortex_m.hpp>
#include <pump/device.hpp>

#include "board.hpp"
#include "interrupt_serial_bus.hpp"
#include "mps2_interrupts.hpp"

/// Number of times that the core has slept; for the test.
extern "C" {
volatile std::uint32_t wake_ups = 0;
}

namespace {

using namespace std::chrono_literals;
using interrupts::AlarmTimer;
using interrupts::MeasuringTimer;

constinit InterruptSerialBus bus;
constinit canopen::Mailbox<pump::od::pressure> measured;

struct MeasuringPump {
  /// Measures while the node is Operational.
  void on_state(canopen::NmtState state) {
    if (state == canopen::NmtState::operational) {
      MeasuringTimer::start(50ms);
    } else {
      MeasuringTimer::stop();
    }
  }
};

auto node = canopen::make_node<pump::Device>(bus, MeasuringPump{}, canopen::values_from(measured));

void on_uart_received() {
  board::word_at(interrupts::uart_clear) = 2;
  bus.on_interrupt();
}
/// The loop wakes and goes on sending.
void on_uart_sent() { board::word_at(interrupts::uart_clear) = 1; }
/// The loop wakes and serves the node.
void on_alarm() { AlarmTimer::stop(); }
void on_measuring_timer() {
  static std::uint16_t pressure = 0;
  MeasuringTimer::acknowledge();
  measured.post<pump::od::pressure>(canopen::raw(++pressure));
}

using Handler = void (*)();
[[gnu::section(".interrupt_vectors"), gnu::used]] constexpr Handler vectors[] = {
    on_uart_received, on_uart_sent, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, on_alarm, on_measuring_timer};

}  // namespace

int main() {
  board::start();
  node.start(canopen::NodeId{EDSC_NODE_ID}, board::now());
  interrupts::start();
  for (;;) {
    while (const auto frame = bus.receive()) node.on_frame(*frame, board::now());
    node.on_time(board::now());
    bus.flush();
    // With interrupts disabled, so that none is missed between the test and the sleep.
    const bool slept = canopen::sleep_unless(
        [] { return !bus.idle() || measured.pending() || !interrupts::set_alarm(node.next_deadline()); });
    if (slept) wake_ups = wake_ups + 1;
  }
}
