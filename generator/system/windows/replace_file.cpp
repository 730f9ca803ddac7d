#include "system/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/xchar.h>
#include <sys/stat.h>
#include <windows.h>

#include <io.h>

#include <cerrno>
#include <string>
#include <string_view>
#include <utility>

#include "system/path.hpp"
#include "system/windows/last_error.hpp"
#include "system/windows/open_handle.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;
using canopen::Descriptor;

constexpr DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

/// Opens a file or a folder to examine it.
HANDLE open_to_examine(const fs::path& path) {
  return CreateFileW(path.c_str(), FILE_READ_ATTRIBUTES, share_all, nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS,
                     nullptr);
}

FileIdentity identity_of(const BY_HANDLE_FILE_INFORMATION& information) {
  return {information.dwVolumeSerialNumber,
          (std::uint64_t{information.nFileIndexHigh} << 32U) | information.nFileIndexLow};
}

/// Whether the name is one of a device or pipe, which must not be opened to examine it.
bool is_device_name(const fs::path& path) {
  const std::string name = from_native(path);
  return name.starts_with("//./");
}

/// Windows ignores dots and blanks at the end of a name.
std::wstring_view without_end(std::wstring_view name) {
  const std::size_t end = name.find_last_not_of(L". ");
  return end == std::wstring_view::npos ? name : name.substr(0, end + 1);
}

/// The path with the name as the folder has it, which may differ in upper and lower case.
fs::path with_stored_name(const fs::path& path) {
  WIN32_FIND_DATAW found{};
  const HANDLE search = FindFirstFileW(path.c_str(), &found);
  if (search == INVALID_HANDLE_VALUE) return path;
  FindClose(search);
  return path.parent_path() / found.cFileName;
}

bool is_read_only(const fs::path& path) {
  const DWORD attributes = GetFileAttributesW(path.c_str());
  return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_READONLY) != 0;
}

bool move_file(const fs::path& from, const fs::path& to) {
  return MoveFileExW(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0 ||
         fail_with_last_error();
}

/// A mutex with a name that all processes derive from the folder: Windows does not lock folders.
class FolderMutex {
 public:
  explicit FolderMutex(HANDLE mutex) : mutex_{mutex} {}
  FolderMutex(const FolderMutex&) = delete;
  FolderMutex& operator=(const FolderMutex&) = delete;
  ~FolderMutex() {
    if (is_locked_) ReleaseMutex(mutex_.get());
  }

  void lock() {
    if (!mutex_ || is_locked_) return;
    const DWORD result = WaitForSingleObject(mutex_.get(), INFINITE);
    is_locked_ = result == WAIT_OBJECT_0 || result == WAIT_ABANDONED;
  }

 private:
  OpenHandle mutex_;
  bool is_locked_ = false;
};

}  // namespace

std::optional<FileState> state_of(const std::string& path) {
  const fs::path native = to_native(path);
  if (is_device_name(native)) return FileState{{}, false, true};
  const OpenHandle file{open_to_examine(native)};
  if (!file) {
    fail_with_last_error();
    return std::nullopt;
  }
  if (GetFileType(file.get()) != FILE_TYPE_DISK) return FileState{{}, false, true};
  BY_HANDLE_FILE_INFORMATION information{};
  if (GetFileInformationByHandle(file.get(), &information) == 0) {
    fail_with_last_error();
    return std::nullopt;
  }
  return FileState{identity_of(information), (information.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0, false};
}

FinalPlace final_place(const fs::path& path) {
  const DWORD attributes = GetFileAttributesW(path.c_str());
  if (attributes == INVALID_FILE_ATTRIBUTES) return {path, std::nullopt};
  if ((attributes & FILE_ATTRIBUTE_REPARSE_POINT) == 0) return {with_stored_name(path), std::nullopt};
  const OpenHandle file{open_to_examine(path)};
  std::wstring name(std::size_t{1} << 15U, L'\0');
  const DWORD length =
      file ? GetFinalPathNameByHandleW(file.get(), name.data(), static_cast<DWORD>(name.size()), 0) : 0;
  if (length == 0 || length >= name.size()) return {path, std::nullopt};
  name.resize(length);
  return {name, std::nullopt};
}

bool is_same_name(const fs::path& one, const fs::path& other) {
  const std::wstring_view first = without_end(one.native());
  const std::wstring_view second = without_end(other.native());
  return CompareStringOrdinal(first.data(), static_cast<int>(first.size()), second.data(),
                              static_cast<int>(second.size()), TRUE) == CSTR_EQUAL;
}

Descriptor open_regular(const fs::path& path) {
  Descriptor file{::_wopen(path.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT)};
  const bool is_regular =
      file && GetFileType(reinterpret_cast<HANDLE>(_get_osfhandle(file.number()))) == FILE_TYPE_DISK;
  return is_regular ? std::move(file) : Descriptor{};
}

Descriptor open_stream(const fs::path& path) {
  return Descriptor{::_wopen(path.c_str(), _O_WRONLY | _O_BINARY | _O_NOINHERIT)};
}

Descriptor create_file(const fs::path& path) {
  constexpr int flags = _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT;
  return Descriptor{::_wopen(path.c_str(), flags, _S_IREAD | _S_IWRITE)};
}

// ReplaceFileW keeps attributes and access rights.
bool adopt_attributes(int /*replacement*/, const fs::path& path) {
  if (!is_read_only(path)) return true;
  errno = EACCES;
  return false;
}

bool write_to_disk(int descriptor) { return ::_commit(descriptor) == 0 || errno == EINVAL; }

bool replace_file(const fs::path& path, bool exists, fs::path& replacement) {
  if (exists) {
    fs::path old = replacement;
    old += L".old";
    if (ReplaceFileW(path.c_str(), replacement.c_str(), old.c_str(), 0, nullptr, nullptr) != 0) {
      replacement = old;
      return true;
    }
    // The old file may already have its other name. Some file systems cannot replace files in this way.
    if (GetFileAttributesW(path.c_str()) == INVALID_FILE_ATTRIBUTES) static_cast<void>(move_file(old, path));
  }
  if (!move_file(replacement, path)) return false;
  replacement.clear();
  return true;
}

LockableFolder::LockableFolder(const fs::path& path) {
  const std::optional<FileState> state = state_of(from_native(path));
  if (!state || !state->is_folder) return;
  identity_ = state->identity;
  const std::wstring name = fmt::format(L"Global\\edsc-{:x}-{:x}", identity_.volume, identity_.number);
  handle_ = std::make_shared<FolderMutex>(CreateMutexW(nullptr, FALSE, name.c_str()));
}

void LockableFolder::lock() const { static_cast<FolderMutex*>(handle_.get())->lock(); }

void LockableFolder::write_to_disk() const {}  // MOVEFILE_WRITE_THROUGH; a folder has no other buffers

}  // namespace edsc
