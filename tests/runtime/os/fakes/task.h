/// Task notifications and the tick count of FreeRTOS on threads of C++: a task is a thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "FreeRTOS.h"

struct FakeTask {
  std::mutex mutex;
  std::condition_variable changed;
  std::uint32_t notifications = 0;
};
using TaskHandle_t = FakeTask*;

inline TaskHandle_t xTaskGetCurrentTaskHandle() {
  thread_local FakeTask task;
  return &task;
}

inline TickType_t xTaskGetTickCount() {
  static const auto start = std::chrono::steady_clock::now();
  const auto passed = std::chrono::steady_clock::now() - start;
  return static_cast<TickType_t>(std::chrono::duration_cast<std::chrono::milliseconds>(passed).count());
}

inline BaseType_t xTaskNotifyGive(TaskHandle_t task) {
  const std::lock_guard lock{task->mutex};
  ++task->notifications;
  task->changed.notify_one();
  return pdPASS;
}

inline void vTaskNotifyGiveFromISR(TaskHandle_t task, BaseType_t* switches) { *switches = xTaskNotifyGive(task); }

inline std::uint32_t ulTaskNotifyTake(BaseType_t clear, TickType_t ticks) {
  FakeTask& task = *xTaskGetCurrentTaskHandle();
  std::unique_lock lock{task.mutex};
  task.changed.wait_for(lock, std::chrono::milliseconds{ticks}, [&] { return task.notifications != 0; });
  const std::uint32_t before = task.notifications;
  if (before != 0) task.notifications = clear == pdTRUE ? 0 : before - 1;
  return before;
}
