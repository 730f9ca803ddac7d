/// The report of a run as JSON: all results, with every frame.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// An object in the format of docs/schema/conform.schema.json.
[[nodiscard]] nlohmann::ordered_json run_object(const RunReport& run, const Device& sheet);
/// The frames in this object.
[[nodiscard]] nlohmann::ordered_json frame_objects(std::span<const SeenFrame> frames, std::uint8_t node,
                                                   const Device& sheet);

/// A file with its SHA-256; null if there is none.
[[nodiscard]] nlohmann::ordered_json file_object(const InputFile& file);

/// The object as text, with a line end.
[[nodiscard]] std::string json_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
