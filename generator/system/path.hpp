/// Paths. Inside edsc a path is a string: UTF-8, and the bytes of the name where a file system has others.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace edsc {

/// For functions of std::filesystem.
[[nodiscard]] std::filesystem::path to_native(std::string_view path);

/// With `/` between folders on all systems.
[[nodiscard]] std::string from_native(const std::filesystem::path& path);

/// The path that a system with this separator gives as UTF-8. A backslash is a part of the name where `/` separates.
[[nodiscard]] std::string with_slashes(std::u8string_view path, char separator);

/// `name` in `folder`; `name` alone if it is absolute, or `folder` is empty.
[[nodiscard]] std::string join_path(std::string_view folder, std::string_view name);

/// `path` relative to the folder of the file `from`, as that file may name it; relative to the current folder if `from`
/// is empty.
[[nodiscard]] std::string path_from(std::string_view from, std::string_view path);

[[nodiscard]] std::string absolute_path(std::string_view path);

/// A path as a URI reference (RFC 3986, RFC 8089): `file:///a%20b.eds` for an absolute path, and on a system whose
/// paths have a drive, `file:///C:/b.eds` and `file://server/share/b.eds`. A relative path remains relative.
/// `separator` is the one of the system; the path itself has `/`.
[[nodiscard]] std::string uri_of_path(std::string_view path,
                                      char separator = static_cast<char>(std::filesystem::path::preferred_separator));

/// `drive.eds` of `machine/drive.eds`, `C:\machine\drive.eds` and `C:drive.eds`, on all systems: network files, EDS
/// files and logs come from other computers. Empty for a path that ends with a separator.
[[nodiscard]] std::string_view file_name_of(std::string_view path);

/// The name of a file without its folders and without its last extension.
[[nodiscard]] std::string_view stem_of(std::string_view path);

}  // namespace edsc
