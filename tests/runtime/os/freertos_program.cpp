/// The program for FreeRTOS of docs/porting.md, compiled with the fakes of the system.
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/os/freertos.hpp>
#include <canopen/os/node_task.hpp>
#include <canopen/port/bxcan.hpp>
#include <canopen/port/interrupt_port.hpp>

#include "first_device/pump.hpp"

void canopen_task(void*);
void measuring_task(void*);
od::pressure::type measured_pressure();
extern "C" void CEC_CAN_IRQHandler();

canopen::BxCan<> can{*reinterpret_cast<canopen::BxCanRegisters*>(0x4000'6400)};
canopen::InterruptPort<canopen::BxCan<>, 32> bus{can};
canopen::Mailbox<od::pressure> measured;
auto node = canopen::make_node<pump::Device>(bus, canopen::NodeId{5}, Pump{}, canopen::values_from(measured));
canopen::FreeRtos canopen_system;

extern "C" void CEC_CAN_IRQHandler() {
  bus.on_interrupt();
  canopen_system.wake_from_interrupt();
}
void canopen_task(void*) {
  canopen_system.adopt_this_task();
  if (can.start(48'000'000, 500'000)) bus.enable_interrupts();
  canopen::NodeTask{node, bus, canopen_system}.run();
}
void measuring_task(void*) {
  for (;;) {
    measured.post<od::pressure>(measured_pressure());
    canopen_system.wake();
  }
}
