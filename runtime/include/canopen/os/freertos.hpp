/// A node in a task of FreeRTOS. Empty if FreeRTOS.h is not among the include directories.
///
///     canopen::InterruptPort<canopen::BxCan<>, 32> bus{can};
///     auto pump = canopen::make_node<Device>(bus, canopen::NodeId{5});
///     canopen::FreeRtos system;
///
///     extern "C" void CEC_CAN_IRQHandler() {
///       bus.on_interrupt();
///       system.wake_from_interrupt();
///     }
///     void canopen_task(void*) {
///       system.adopt_this_task();
///       canopen::NodeTask{pump, bus, system}.run();
///     }
#pragma once

#if __has_include(<FreeRTOS.h>)

#include <FreeRTOS.h>
#include <task.h>

#include <cstdint>

#include "canopen/base/clock.hpp"
#include "canopen/os/node_task.hpp"

namespace canopen {

/// Waits for a notification of the task, index 0. Needs configUSE_TASK_NOTIFICATIONS, and a tick rate that divides
/// 1 MHz: at 1 kHz, deadlines are met within 2 ms.
class FreeRtos {
 public:
  static_assert(sizeof(TickType_t) == 4, "the time of the node wraps with a tick count of 32 bits");
  static_assert(1'000'000 % configTICK_RATE_HZ == 0, "a tick must be a whole number of microseconds");

  /// Called by the task of the node, before `run`.
  void adopt_this_task() { task_ = xTaskGetCurrentTaskHandle(); }

  [[nodiscard]] TimePoint now() const { return TimePoint{Duration{xTaskGetTickCount() * tick.count()}}; }
  [[nodiscard]] static Duration shortest_wait() { return tick; }

  void wait(Duration span) {
    static_cast<void>(ulTaskNotifyTake(pdTRUE, (span.count() + (tick.count() - 1)) / tick.count()));
  }

  /// From another task. Has no effect before `adopt_this_task`: the node looks for work when it starts.
  void wake() {
    if (task_ != nullptr) static_cast<void>(xTaskNotifyGive(task_));
  }
  /// From an interrupt whose priority may use FreeRTOS.
  void wake_from_interrupt() {
    if (task_ == nullptr) return;
    BaseType_t switches = pdFALSE;
    vTaskNotifyGiveFromISR(task_, &switches);
    portYIELD_FROM_ISR(switches);
  }

 private:
  static constexpr Duration tick{1'000'000 / configTICK_RATE_HZ};

  TaskHandle_t volatile task_ = nullptr;
};

}  // namespace canopen

#endif
