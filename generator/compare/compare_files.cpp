#include "compare/compare_files.hpp"

#include <fmt/format.h>

namespace edsc {
namespace {

struct FileKey {
  std::string_view name;
  std::string Entry::*file;
};
constexpr FileKey file_keys[] = {{"UploadFile", &Entry::upload_file}, {"DownloadFile", &Entry::download_file}};

std::string file_text(const std::string& name, const std::optional<std::string>& bytes) {
  if (name.empty()) return "none";
  return bytes ? fmt::format("{} ({} bytes)", name, bytes->size()) : name;
}

void compare_file(const Entry& before, const Entry& after, const FileKey& key,
                  const std::optional<std::string>& old_bytes, const std::optional<std::string>& new_bytes,
                  Changes& changes) {
  const bool is_same = old_bytes && new_bytes ? old_bytes == new_bytes : before.*key.file == after.*key.file;
  if (is_same) return;
  Change& change = changes.add("domain-file", entry_label(after.index, after.sub_index), after.name, before.position,
                               after.position);
  change.old_value = fmt::format("{} {}", key.name, file_text(before.*key.file, old_bytes));
  change.new_value = file_text(after.*key.file, new_bytes);
}

}  // namespace

void compare_files(const Device& before, const Device& after, const FileReader& read, Changes& changes) {
  const auto bytes_of = [&](const Device& device, const std::string& name) {
    return name.empty() ? std::nullopt : read(device, name);
  };
  for (const Object& object : after.objects) {
    for (const Entry& entry : object.entries) {
      const Entry* const old_entry = before.find(entry.index, entry.sub_index);
      if (old_entry == nullptr) continue;
      for (const FileKey& key : file_keys) {
        if ((entry.*key.file).empty() && (old_entry->*key.file).empty()) continue;
        compare_file(*old_entry, entry, key, bytes_of(before, old_entry->*key.file), bytes_of(after, entry.*key.file),
                     changes);
      }
    }
  }
}

}  // namespace edsc
