#include "render/write_files.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

namespace edsc {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

bool has_content(const std::string& path, std::string_view content) {
  std::error_code error;
  if (fs::file_size(path, error) != content.size() || error) return false;
  const File file{std::fopen(path.c_str(), "rb")};
  if (!file) return false;
  std::array<char, 1 << 16> found;
  while (!content.empty()) {
    const std::size_t size = std::min(content.size(), found.size());
    if (std::fread(found.data(), 1, size, file.get()) != size) return false;
    if (content.substr(0, size) != std::string_view{found.data(), size}) return false;
    content.remove_prefix(size);
  }
  return true;
}

/// A rename replaces nothing but files; found out before anything changes.
std::string check_target(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? path + ": is a folder" : "";
}

std::string temporary_name(const std::string& path) { return path + ".edsc-tmp"; }

std::string write_temporary(const OutputFile& file) {
  const std::string path = temporary_name(file.path);
  File out{std::fopen(path.c_str(), "wb")};
  if (!out) return file.path + ": " + std::strerror(errno);
  const bool written = std::fwrite(file.content.data(), 1, file.content.size(), out.get()) == file.content.size();
  const bool closed = std::fclose(out.release()) == 0;
  return written && closed ? "" : file.path + ": " + std::strerror(errno);
}

}  // namespace

std::string write_files(const std::vector<OutputFile>& files) {
  std::vector<const OutputFile*> changed;
  for (const OutputFile& file : files) {
    if (std::string problem = check_target(file.path); !problem.empty()) return problem;
    if (!has_content(file.path, file.content)) changed.push_back(&file);
  }
  std::string problem;
  for (const OutputFile* file : changed) {
    std::error_code error;
    const fs::path folder = fs::path{file->path}.parent_path();
    if (!folder.empty()) fs::create_directories(folder, error);
    problem = error ? folder.string() + ": " + error.message() : write_temporary(*file);
    if (!problem.empty()) break;
  }
  for (const OutputFile* file : changed) {
    std::error_code error;
    if (problem.empty()) {
      fs::rename(temporary_name(file->path), file->path, error);
      if (error) problem = file->path + ": " + error.message();
    }
    if (!problem.empty()) fs::remove(temporary_name(file->path), error);
  }
  return problem;
}

}  // namespace edsc
