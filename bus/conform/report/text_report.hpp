/// The report of a run for a terminal, printed in parts during the run.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

class TextReport {
 public:
  /// `run` may still get results. Both must outlive the report.
  TextReport(const RunReport& run, const Device& sheet, bool color) : run_{run}, sheet_{sheet}, color_{color} {}

  /// The maximum number of frames of a failure.
  static constexpr std::size_t max_frames = 20;

  /// What is tested: device, EDS, bus, level.
  [[nodiscard]] std::string head() const;
  /// The objects at 2000h and above that --application writes; empty without this permission.
  [[nodiscard]] std::string application_objects() const;
  /// A line with id, verdict and title. For a failure also the clause, the expected and the actual result, the frames,
  /// and the command that repeats the case.
  [[nodiscard]] std::string of(const CaseResult& result) const;
  /// A table by area, other problems, and the result of the run.
  [[nodiscard]] std::string summary() const;

 private:
  [[nodiscard]] std::string table() const;
  /// A line with the text, and the frames around those that the failed check names.
  void append_frames(std::string& out, std::string_view name, std::string_view text, std::span<const SeenFrame> frames,
                     std::span<const std::size_t> named) const;

  const RunReport& run_;
  const Device& sheet_;
  bool color_;
};

}  // namespace edsc::conform
