/// Results of a case that tries many entries: it continues after a failure and names the first failed entries.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "conform/dut/dut.hpp"

namespace edsc::conform {

class EntryResults {
 public:
  explicit EntryResults(Dut& dut) : dut_{dut} {}

  /// The entry must have been read or written.
  void expect_done(const LiveEntry& entry, const SdoOutcome& outcome);
  /// The entry must have been refused with a code of the rule, else returns false. `done` names the access: `written`.
  bool expect_abort(const LiveEntry& entry, const SdoOutcome& outcome, const AbortRule& rule, std::string_view done);
  void add_failure(const LiveEntry& entry, std::string_view got);
  void add_warning(const LiveEntry& entry, std::string_view text);
  /// Counts an entry that was tried.
  void count() { ++tried_; }

  /// The device was silent several times in a row: the case does not try the remaining entries.
  [[nodiscard]] bool lost() const { return silent_ >= max_silent; }

  /// Ends the case: it fails when an entry failed, and is not applicable when no entry was tried.
  void finish(const std::string& expected, const std::string& why_none);

 private:
  static constexpr std::size_t max_named = 5;
  static constexpr unsigned max_silent = 3;

  struct List {
    std::string text;  ///< the first `max_named`
    std::string last;  ///< not repeated
    std::size_t size = 0;

    void add(const LiveEntry& entry, std::string_view what);
    [[nodiscard]] std::string whole() const;
  };

  void note(const SdoOutcome& outcome);

  Dut& dut_;
  List failures_, warnings_;
  std::vector<EntryAddress> failed_;
  std::size_t tried_ = 0;
  unsigned silent_ = 0;
};

}  // namespace edsc::conform
