/// The survey of a bus as text, as JSON (docs/schema/discover.schema.json), and as the member `guessed` of a network
/// file.
#pragma once

#include <string>

#include "discover/bus_survey.hpp"

namespace edsc::discover {

/// `source`: the log or the bus.
[[nodiscard]] std::string text_report(const BusSurvey& survey, const std::string& source);
[[nodiscard]] std::string json_report(const BusSurvey& survey, const std::string& source);

/// The nodes, SYNC and PDOs, as a JSON object.
[[nodiscard]] std::string guessed_member(const BusSurvey& survey);

}  // namespace edsc::discover
