/// The arguments of a command to a simulated node, by a pattern of words: `OBJ FROM TO TIME [every TIME]`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"
#include "lookup/find_entry.hpp"

namespace edsc {

/// What a pattern can have:
///   OBJ                 an entry, by address or name
///   OBJECT              an entry, or an object with all of its entries
///   VALUE FROM TO LOW HIGH   a value of OBJ, as edsc write reads it
///   STEP                a difference of raw numbers
///   VALUE...            the words up to the end, as a value of OBJ of any type
///   TIME                a duration of at least 1 ms
///   every               this word, before a second TIME
///   CODE BITS           hexadecimal: an emergency or abort code, bits of 1001h
///   N BYTES             a decimal number from 1 to 512, from 0 to 8
///   1/N                 a fraction
///   WORD                any word
///   a|b|c               one of these words
///   [..]                what may be missing, up to the end
struct CommandArguments {
  const Object* object = nullptr;
  const Entry* entry = nullptr;          ///< null: all entries of the object
  std::vector<double> numbers;           ///< raw numbers of values, and STEP
  std::vector<std::uint8_t> bytes;       ///< of VALUE...
  std::optional<std::uint64_t> time_us;  ///< the first TIME
  std::optional<std::uint64_t> every_us;
  std::optional<std::uint32_t> code;
  std::optional<unsigned> number;  ///< N
  std::optional<unsigned> count;   ///< BYTES
  std::string word;                ///< WORD, or a chosen one
};

/// Reads words by a pattern. Returns what is wrong; empty on success.
[[nodiscard]] std::string read_arguments(std::string_view pattern, std::span<const std::string> words,
                                         EntryFinder& names, CommandArguments& arguments);

/// Splits a line at blanks; a part in quotation marks is one word. The marks are removed, unless they begin in a word.
[[nodiscard]] std::vector<std::string> command_words(std::string_view line);

/// Reads a duration, with or without a blank before its unit; nothing if the text is not one.
[[nodiscard]] std::optional<std::uint64_t> command_time(std::string_view text);

/// Reads 8130h, 0x8130, 8130 or `0602 0000h`; nothing for other texts, and above `max`.
[[nodiscard]] std::optional<std::uint32_t> command_code(std::string_view text, std::uint32_t max);

}  // namespace edsc
