#include "backend/cpp/identifier.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "text/ascii.hpp"
#include "text/snake_case.hpp"

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

/// Names that are not available in C++: keywords, alternative tokens, usual macros in lower case.
// clang-format off
constexpr const char* keyword_list[] = {
    "alignas", "alignof", "and", "and_eq", "asm", "assert", "auto", "bitand", "bitor", "bool", "break", "canopen",
    "case", "catch", "char", "char16_t", "char32_t", "char8_t", "class", "co_await", "co_return", "co_yield", "compl",
    "concept", "const", "const_cast", "consteval", "constexpr", "constinit", "continue", "decltype", "default",
    "delete", "do", "double", "dynamic_cast", "else", "enum", "errno", "explicit", "export", "extern", "false",
    "final", "float", "for", "friend", "goto", "if", "import", "inline", "int", "linux", "long", "major", "minor",
    "module", "mutable", "namespace", "new", "noexcept", "not", "not_eq", "nullptr", "offsetof", "operator", "or",
    "or_eq", "override", "private", "protected", "public", "register", "reinterpret_cast", "requires", "return",
    "setjmp", "short", "signed", "sizeof", "static", "static_assert", "static_cast", "std", "stderr", "stdin",
    "stdout", "struct", "switch", "template", "this", "thread_local", "throw", "true", "try", "typedef", "typeid",
    "typename", "union", "unix", "unsigned", "using", "va_arg", "virtual", "void", "volatile", "wchar_t", "while",
    "xor", "xor_eq",
};
// clang-format on
constexpr auto keywords = sorted(keyword_list);

/// Further names that are not available for objects: the members of each generated object, and the namespaces around
/// it.
// clang-format off
constexpr const char* member_list[] = {
    "access", "bits", "default_value", "high_limit", "index", "is_value", "low_limit", "mappable", "meaning", "name",
    "od", "sub_index", "type",
};
// clang-format on
constexpr auto members = sorted(member_list);

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

}  // namespace

std::string without_reserved_word(std::string identifier) {
  if (std::ranges::binary_search(members, identifier)) identifier += '_';
  return without_keyword(std::move(identifier));
}

std::string without_keyword(std::string identifier) {
  if (std::ranges::binary_search(keywords, identifier)) identifier += '_';
  return identifier;
}

std::string to_cpp_identifier(std::string_view name) { return without_reserved_word(to_snake_case(name)); }

bool is_identifier(std::string_view name) { return !name.empty() && to_cpp_identifier(name) == name; }

std::string to_namespace(std::string_view name) {
  std::string out = to_cpp_identifier(name);
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

}  // namespace edsc
