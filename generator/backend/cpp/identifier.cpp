#include "backend/cpp/identifier.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "backend/cpp/cpp_text.hpp"
#include "text/ascii.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

/// A list of words, sorted for binary search.
template <std::size_t N>
consteval std::array<std::string_view, N> sorted(const char* const (&words)[N]) {
  std::array<std::string_view, N> list{};
  std::ranges::copy(words, list.begin());
  std::ranges::sort(list);
  return list;
}

/// Names that are not available for objects: keywords, alternative tokens, usual macros in lower case, and the members
/// of each generated object.
// clang-format off
constexpr const char* word_list[] = {
    "alignas",       "alignof",     "and",          "and_eq",        "asm",          "assert",      "auto",
    "bitand",        "bitor",       "bits",         "bool",          "break",        "canopen",     "case",
    "catch",         "char",        "char16_t",     "char32_t",      "char8_t",      "class",       "co_await",
    "co_return",     "co_yield",    "compl",        "concept",       "const",        "const_cast",  "consteval",
    "constexpr",     "constinit",   "continue",     "decltype",      "default",      "default_value", "delete",
    "do",            "double",      "dynamic_cast", "else",          "enum",         "errno",       "explicit",
    "export",        "extern",      "false",        "final",         "float",        "for",         "friend",
    "goto",          "high_limit",  "if",           "import",        "index",        "inline",      "int",
    "linux",         "long",        "low_limit",    "major",         "mappable",     "minor",       "module",
    "mutable",       "name",        "namespace",    "new",           "noexcept",     "not",         "not_eq",
    "nullptr",       "od",          "offsetof",     "operator",      "or",           "or_eq",       "override",
    "private",       "protected",   "public",       "register",      "reinterpret_cast", "requires", "return",
    "setjmp",        "short",       "signed",       "sizeof",        "static",       "static_assert", "static_cast",
    "std",           "stderr",      "stdin",        "stdout",        "struct",       "sub_index",   "switch",
    "template",      "this",        "thread_local", "throw",         "true",         "try",         "type",
    "typedef",       "typeid",      "typename",     "union",         "unix",         "unsigned",    "using",
    "va_arg",        "virtual",     "void",         "volatile",      "wchar_t",      "while",       "xor",
    "xor_eq",        "access",
};
// clang-format on
constexpr auto reserved_words = sorted(word_list);

/// Further names that are not available for a namespace at global scope: functions of the C library, and the constants
/// of canopen::entry in the generated tables.
// clang-format off
constexpr const char* namespace_list[] = {
    // C library and POSIX.
    "abort",  "abs",    "accept", "access", "acos",   "alarm",  "asin",   "atan",   "atexit",  "bind",   "brk",
    "cbrt",   "ceil",   "clock",  "close",  "connect", "cos",   "daemon", "div",    "drem",    "dup",    "erf",
    "exit",   "exp",    "fabs",   "floor",  "fma",    "fork",   "free",   "gamma",  "getline", "gets",   "index",
    "ioctl",  "j0",     "j1",     "jn",     "kill",   "labs",   "link",   "listen", "log",     "lseek",  "main",
    "malloc", "mount",  "nan",    "nice",   "open",   "pause",  "perror", "pipe",   "poll",    "pow",    "printf",
    "puts",   "raise",  "rand",   "random", "read",   "recv",   "remove", "rename", "rindex",  "round",  "select",
    "send",   "shutdown", "signal", "sin",  "sleep",  "socket", "sqrt",   "stat",   "stime",   "sync",   "system",
    "tan",    "time",   "times",  "tmpfile", "trunc", "wait",   "write",  "y0",     "y1",      "yn",
    // canopen::entry, without the types.
    "array", "gap", "immediate", "immediate_plus_node_id", "limited", "ram", "readable", "record", "ro", "rom",
    "rpdo", "rw", "string", "tpdo", "wo", "writable",
};
// clang-format on
constexpr auto reserved_namespaces = sorted(namespace_list);

struct Spelling {
  char32_t code_point;
  std::string_view text;
};

constexpr std::array spellings = {
    Spelling{0x00B0, "deg"}, Spelling{0x00B2, "2"},  Spelling{0x00B3, "3"},   Spelling{0x00B5, "u"},
    Spelling{0x00C4, "Ae"},  Spelling{0x00D6, "Oe"}, Spelling{0x00DC, "Ue"},  Spelling{0x00DF, "ss"},
    Spelling{0x00E0, "a"},   Spelling{0x00E1, "a"},  Spelling{0x00E4, "ae"},  Spelling{0x00E8, "e"},
    Spelling{0x00E9, "e"},   Spelling{0x00EA, "e"},  Spelling{0x00F1, "n"},   Spelling{0x00F3, "o"},
    Spelling{0x00F6, "oe"},  Spelling{0x00FC, "ue"}, Spelling{0x03A9, "ohm"}, Spelling{0x03BC, "u"},
    Spelling{0x2126, "ohm"},
};

/// Keeps ASCII letters and digits, transliterates code points with a usual spelling, and replaces others by a blank.
std::string to_ascii(std::string_view name) {
  if (is_ascii(name)) return std::string{name};
  std::string out;
  for_each_code_point(name, [&](char32_t code_point) {
    const auto at = std::ranges::find(spellings, code_point, &Spelling::code_point);
    if (code_point < 0x80) {
      out += static_cast<char>(code_point);
    } else {
      out += at == spellings.end() ? " " : at->text;
    }
  });
  return out;
}

/// Whether a new word begins at `i`: after a lower-case letter or digit, or where the last capital of a run starts a
/// word (`RxPDOMapping`: rx, pdo, mapping).
bool word_begins(std::string_view text, std::size_t i) {
  if (i == 0 || !is_upper(text[i])) return false;
  if (is_lower(text[i - 1])) return true;
  if (is_upper(text[i - 1]) && i + 1 < text.size() && is_lower(text[i + 1])) {
    return i + 2 < text.size() && is_lower(text[i + 2]);  // `COBs`, `PDOs`: a plural, not a new word
  }
  return false;
}

}  // namespace

std::string to_snake_case(std::string_view name) {
  const std::string text = to_ascii(name);
  std::string out;
  out.reserve(text.size() + 4);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool letter = is_lower(text[i]) || is_upper(text[i]) || is_digit(text[i]);
    const bool gap = !letter || word_begins(text, i);
    if (gap && !out.empty() && out.back() != '_') out += '_';
    if (letter) out += to_lower(text[i]);
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  if (!out.empty() && is_digit(out.front())) out.insert(0, "n_");
  if (std::ranges::binary_search(reserved_words, out)) out += '_';
  return out;
}

bool is_identifier(std::string_view name) { return !name.empty() && to_snake_case(name) == name; }

std::string to_namespace(std::string_view name) {
  std::string out = to_snake_case(name);
  if (out.empty()) return "device";
  const auto is_word = [&](const canopen::DataTypeRow& type) { return type_word(type) == out; };
  if (std::ranges::binary_search(reserved_namespaces, out) || std::ranges::any_of(canopen::data_types, is_word)) {
    out += '_';
  }
  return out;
}

std::string to_camel_case(std::string_view snake_case) {
  std::string out;
  bool upper = true;
  for (const char c : snake_case) {
    if (c == '_') {
      upper = true;
      continue;
    }
    out += upper ? to_upper(c) : c;
    upper = false;
  }
  return out;
}

std::string IdentifierScope::take(const std::string& wanted, std::string_view suffix) {
  if (taken_.insert(wanted).second) return wanted;
  std::string base = wanted;
  if (base.back() != '_') base += '_';
  base += suffix;
  std::string candidate = base;
  for (int i = 2; !taken_.insert(candidate).second; ++i) candidate = base + "_" + std::to_string(i);
  return candidate;
}

}  // namespace edsc
