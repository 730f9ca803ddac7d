/// The part of FreeRTOS that canopen/os/freertos.hpp uses, with the semantics of its manual, on threads of C++.
#pragma once

#include <cstdint>

using TickType_t = std::uint32_t;
using BaseType_t = long;
using UBaseType_t = unsigned long;

#define configTICK_RATE_HZ 1000
#define pdFALSE 0L
#define pdTRUE 1L
#define pdPASS 1L
#define portYIELD_FROM_ISR(switches) static_cast<void>(switches)
