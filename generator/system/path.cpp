#include "system/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <system_error>

namespace edsc {

namespace fs = std::filesystem;

namespace {

bool is_latin_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
bool begins_with_drive(std::string_view path) { return path.size() >= 2 && path[1] == ':' && is_latin_letter(path[0]); }

}  // namespace

fs::path to_native(std::string_view path) { return fs::path{std::u8string{path.begin(), path.end()}}; }

// generic_u8string() also drops one of two slashes.
std::string from_native(const fs::path& path) {
  return with_slashes(path.u8string(), static_cast<char>(fs::path::preferred_separator));
}

std::string with_slashes(std::u8string_view path, char separator) {
  std::string text{path.begin(), path.end()};
  std::ranges::replace(text, separator, '/');
  return text;
}

std::string join_path(std::string_view folder, std::string_view name) {
  return from_native(to_native(folder) / to_native(name));
}

std::string path_from(std::string_view from, std::string_view path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path folder = from.empty() ? fs::current_path() : fs::absolute(to_native(from)).parent_path();
  const fs::path relative = fs::proximate(to_native(path), folder, error);
  return error ? std::string{path} : from_native(relative);
}

std::string absolute_path(std::string_view path) { return from_native(std::filesystem::absolute(to_native(path))); }

std::string uri_of_path(std::string_view path, char separator) {
  constexpr std::string_view plain = "-._~/";  // RFC 3986, 2.3, with letters and digits
  const bool has_drives = separator != '/';
  std::string uri = path.starts_with('/') ? "file://" : "";
  if (has_drives && path.starts_with("//")) {
    uri = "file:";
  } else if (has_drives && begins_with_drive(path) && path.substr(2).starts_with('/')) {
    uri = fmt::format("file:///{}:", path[0]);
    path.remove_prefix(2);
  }
  for (const char c : path) {
    const bool is_plain = is_latin_letter(c) || (c >= '0' && c <= '9') || plain.find(c) != std::string_view::npos;
    uri += is_plain ? std::string{c} : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return uri;
}

std::string_view file_name_of(std::string_view path) {
  if (begins_with_drive(path)) path.remove_prefix(2);
  return path.substr(path.find_last_of("/\\") + 1);
}

std::string_view stem_of(std::string_view path) {
  const std::string_view name = file_name_of(path);
  const std::size_t dot = name.rfind('.');
  return dot == 0 || name == ".." ? name : name.substr(0, dot);
}

}  // namespace edsc
