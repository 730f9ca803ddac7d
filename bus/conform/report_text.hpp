/// The report of a run for a terminal, in pieces as the run goes on.
#pragma once

#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

class TextReport {
 public:
  /// `run` may still grow; both must outlive the report.
  TextReport(const RunReport& run, const Device& sheet, bool color) : run_{run}, sheet_{sheet}, color_{color} {}

  /// Of a failure so many frames are shown: the last ones.
  static constexpr std::size_t max_frames = 20;

  /// What is tested: device, EDS, bus, level.
  [[nodiscard]] std::string head() const;
  /// The objects of 2000h and above that --application writes; empty where the run may not.
  [[nodiscard]] std::string application_objects() const;
  /// A line with id, verdict and title; of a failure also the clause, what was expected, what came, the frames and the
  /// command that repeats the case.
  [[nodiscard]] std::string of(const CaseResult& result) const;
  /// A table by area, what else is wrong, and what the run came to.
  [[nodiscard]] std::string summary() const;

 private:
  [[nodiscard]] std::string table() const;

  const RunReport& run_;
  const Device& sheet_;
  bool color_;
};

}  // namespace edsc::conform
