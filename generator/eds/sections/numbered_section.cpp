#include "eds/sections/numbered_section.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "eds/sections/duplicates.hpp"
#include "eds/sections/section_keys.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

class NumberedSectionReader {
 public:
  NumberedSectionReader(const SourceFile& source, const IniSection& section, const CountKey& count_key,
                        Diagnostics& diagnostics)
      : source_(source), section_(section), count_key_(count_key), diagnostics_(diagnostics) {}

  std::vector<NumberedField> read() {
    for (const IniEntry& entry : section_.entries) {
      read_entry(entry);
    }
    check_count();
    return std::move(fields_);
  }

 private:
  void read_entry(const IniEntry& entry) {
    if (const auto number = match_key(text_entry, entry.key)) {
      add(*number, entry);
    } else if (equal_ignoring_case(entry.key, count_key_.name)) {
      read_count(entry);
    } else if (!count_key_.misspelling.empty() && equal_ignoring_case(entry.key, count_key_.misspelling)) {
      diagnostics_.warning("key-spelling", key_position(source_, entry),
                           fmt::format("reading {} as \"{}\"", quote(entry.key), count_key_.name));
      read_count(entry);
    } else {
      report_unknown_key(source_, section_, entry, {&count_key_.name, 1}, diagnostics_);
    }
  }

  void add(std::uint32_t number, const IniEntry& entry) {
    const auto [first, is_new] = entry_of_number_.try_emplace(number, &entry);
    if (is_new) {
      fields_.push_back({number, make_field(source_, entry)});
    } else {
      report_duplicate_key(source_, entry, value_position(source_, *first->second), diagnostics_);
    }
  }

  void read_count(const IniEntry& entry) {
    if (count_entry_ != nullptr) {
      report_duplicate_key(source_, entry, value_position(source_, *count_entry_), diagnostics_);
      return;
    }
    count_entry_ = &entry;
    count_ = parse_unsigned(strip_inline_comment(entry.value));
    if (!count_) {
      diagnostics_.error("number", value_position(source_, entry),
                         fmt::format("{} is not a number; {} must be the number of entries in the section",
                                     quote(entry.value), count_key_.name));
    }
  }

  void check_count() {
    if (count_entry_ == nullptr) {
      diagnostics_.warning(count_key_.rule, section_position(source_, section_),
                           fmt::format("missing {} in [{}]", count_key_.name, section_.name));
    } else if (count_ && *count_ != fields_.size()) {
      diagnostics_.warning(count_key_.rule, value_position(source_, *count_entry_),
                           fmt::format("{} is {}, but the section has {}", count_key_.name, *count_,
                                       counted(fields_.size(), "entry", "entries")));
    } else if (count_ && count_key_.numbers_count_up) {
      check_numbers();
    }
  }

  /// The count is correct, but the numbers do not run from 1 to the count.
  void check_numbers() {
    for (const NumberedField& field : fields_) {
      if (field.number == 0 || field.number > *count_) {
        diagnostics_.warning(
            count_key_.rule, key_position(source_, *entry_of_number_[field.number]),
            fmt::format("the entries are not numbered 1 to {}: {} is one of them", *count_, field.number));
        return;
      }
    }
  }

  const SourceFile& source_;
  const IniSection& section_;
  const CountKey& count_key_;
  Diagnostics& diagnostics_;
  std::vector<NumberedField> fields_;
  std::unordered_map<std::uint32_t, const IniEntry*> entry_of_number_;
  const IniEntry* count_entry_ = nullptr;
  std::optional<std::uint64_t> count_;
};

}  // namespace

std::vector<NumberedField> read_numbered_section(const SourceFile& source, const IniSection& section,
                                                 const CountKey& count_key, Diagnostics& diagnostics) {
  return NumberedSectionReader(source, section, count_key, diagnostics).read();
}

}  // namespace edsc
