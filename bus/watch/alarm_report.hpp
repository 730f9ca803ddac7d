/// An alarm as a line of text, as JSON, and as variables of the environment of a command.
#pragma once

#include <string>
#include <vector>

#include "watch/alarm.hpp"

namespace edsc::watch {

/// `(1700000000.000000)  error    node-missing  axis1: no heartbeat for 1100.0 ms`
[[nodiscard]] std::string alarm_text(const Alarm& alarm, bool color);
/// By docs/schema/watch.schema.json, on one line.
[[nodiscard]] std::string alarm_json(const Alarm& alarm);
/// `EDSC_ALARM=node-missing` and others, each with its value.
[[nodiscard]] std::vector<std::string> alarm_variables(const Alarm& alarm);

}  // namespace edsc::watch
