// Random changes of all EDS and DCF files of the repository, and of a corpus: the device is the intended one, and the
// changes can be taken back. The corpus is in the folder EDSC_CORPUS; else every eighth file of ../shared/eds-corpus
// beside the repository is changed, because all of them take minutes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "backend/json/device_view.hpp"
#include "change/apply_changes.hpp"
#include "change/sheet_text.hpp"
#include "support/sheet_files.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Members that follow from the place in the file or from other members.
void strip(Json& json) {
  if (json.is_object()) {
    for (const char* const name : {"line", "identifier", "meaning", "position", "source"}) json.erase(name);
  }
  for (Json& one : json) {
    if (one.is_structured()) strip(one);
  }
}

Json view_of(const OpenSheet& sheet) {
  Json view = device_view(*sheet.device, sheet.names->identifiers());
  strip(view);
  return view;
}

/// The object of a view, or null.
Json* object_of(Json& view, std::uint16_t index) {
  for (Json& object : view["objects"]) {
    if (object["index"] == index) return &object;
  }
  return nullptr;
}

class FileChanges {
 public:
  explicit FileChanges(const std::string& path) : random_(static_cast<unsigned>(path.size()) * 7919U + 1) {
    FileBytes file = read_bytes(path);
    before_ = open_sheet(path, std::move(file.bytes), {}, SheetChecks::all);
    is_usable_ = file.packing == Packing::none && before_->device && before_->source->undefined_bytes().empty();
    if (is_usable_) is_canonical_ = is_canonical(*before_);
  }

  [[nodiscard]] bool is_usable() const { return is_usable_; }
  [[nodiscard]] std::size_t made() const { return made_; }

  void change() {
    for (unsigned i = 0; i < 2; ++i) {
      set_name();
      set_default();
      remove();
      rename();
      add();
      map();
    }
    sequence();
  }

 private:
  [[nodiscard]] std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>{0, end - 1}(random_);
  }

  /// Applies changes; null if they were not possible.
  std::unique_ptr<const OpenSheet> apply(const std::vector<SheetChange>& changes, std::size_t max_lines) {
    AppliedChanges applied = apply_changes(*before_, changes, {.force = true});
    if (!applied.problem.empty()) return nullptr;
    ++made_;
    EXPECT_EQ(with_edits(before_->bytes, applied.bytes), applied.after->bytes);
    EXPECT_EQ(without_edits(applied.after->bytes, applied.bytes), before_->bytes);
    std::size_t lines = 0;
    for (const TextEdit& edit : applied.edits) lines += std::max<std::size_t>(edit.removed, edit.lines.size());
    if (max_lines > 0 && !is_canonical_) {
      EXPECT_LE(lines, max_lines);
    }
    if (is_canonical_ && applied.after->device) {
      EXPECT_TRUE(is_canonical(*applied.after));
    }
    if (!applied.after->device) return nullptr;
    return std::move(applied.after);
  }

  void expect(const OpenSheet& after, const Json& expected) {
    const Json view = view_of(after);
    if (view == expected) return;
    ADD_FAILURE() << "not the intended device: "
                  << nlohmann::json::diff(nlohmann::json(expected), nlohmann::json(view));
  }

  /// A random section of an object or sub-object that is a manufacturer's one, read as the file has it.
  const TextSection* random_section(const SheetText& text, bool with_subs) {
    std::vector<const TextSection*> sections;
    for (const TextSection& section : text.sections()) {
      const bool is_kind =
          section.name.kind == SectionKind::object || (with_subs && section.name.kind == SectionKind::sub_object);
      const bool is_own =
          section.name.index >= 0x2000 && section.name.index < 0x6000 && text.find(section.name) == &section;
      if (is_kind && is_own && before_->device->find(section.name.index) != nullptr) sections.push_back(&section);
    }
    return sections.empty() ? nullptr : sections[below(sections.size())];
  }

  void set_name() {
    const SheetText text{*before_->source};
    const TextSection* const section = random_section(text, false);
    if (section == nullptr || !text.find_entry(*section, "ParameterName")) return;
    Json expected = view_of(*before_);
    Json& object = *object_of(expected, section->name.index);
    const std::string old = object["name"];
    object["name"] = "Renamed value";
    const bool is_single = object["entries"].size() == 1 && object["entries"][0]["sub_index"] == 0;
    if (is_single && object["entries"][0]["name"] == old) object["entries"][0]["name"] = "Renamed value";
    for (Json& pdo : expected["pdos"]) {
      for (Json& mapped : pdo["entries"]) {
        if (is_single && mapped["index"] == section->name.index && mapped["name"] == old)
          mapped["name"] = "Renamed value";
      }
    }
    const auto after = apply({SetValue{std::string{section->title}, "ParameterName", "Renamed value"}}, 1);
    if (after && text.find_entry(*section, "CompactSubObj") == std::nullopt) expect(*after, expected);
  }

  void set_default() {
    const SheetText text{*before_->source};
    const TextSection* const section = random_section(text, true);
    if (section == nullptr) return;
    const Entry* const entry = before_->device->find(section->name.index, section->name.sub_index);
    const Object* const object = before_->device->find(section->name.index);
    const bool is_sub = section->name.kind == SectionKind::sub_object;
    if (entry == nullptr || entry->type == nullptr || object->has_sub_indices() != is_sub) return;
    const bool is_count = is_sub && section->name.sub_index == 0;
    if (is_count || entry->type->kind != canopen::DataClass::unsigned_integer || before_->sheet.is_dcf) return;
    Json expected = view_of(*before_);
    for (Json& one : (*object_of(expected, section->name.index))["entries"]) {
      if (one["sub_index"] == section->name.sub_index) one["default_value"] = 77;
    }
    const auto after = apply({SetValue{std::string{section->title}, "DefaultValue", "0x4D"}}, 1);
    if (after && entry->default_value && !entry->default_value->plus_node_id) expect(*after, expected);
  }

  [[nodiscard]] bool is_mapped(std::uint16_t index) const {
    return std::ranges::any_of(before_->device->pdos, [&](const Pdo& pdo) {
      return pdo.broken || std::ranges::any_of(pdo.entries, [&](const PdoEntry& one) { return one.index == index; });
    });
  }

  void remove() {
    const SheetText text{*before_->source};
    const TextSection* const section = random_section(text, false);
    if (section == nullptr || is_mapped(section->name.index)) return;
    Json expected = view_of(*before_);
    Json objects = Json::array();
    for (const Json& object : expected["objects"]) {
      if (object["index"] != section->name.index) objects.push_back(object);
    }
    expected["objects"] = objects;
    if (objects.empty()) return;
    const auto after = apply({RemovePart{std::string{section->title}, ""}}, 0);
    if (after && has_no_duplicates(text, section->name.index)) expect(*after, expected);
  }

  static bool has_no_duplicates(const SheetText& text, std::uint16_t index) {
    return std::ranges::all_of(text.sections(), [&](const TextSection& section) {
      return section.name.index != index || text.find(section.name) == &section;
    });
  }

  [[nodiscard]] std::uint16_t free_index(const SheetText& text) const {
    std::uint16_t index = 0x5FFF;
    while (std::ranges::any_of(text.sections(), [&](const TextSection& one) { return one.name.index == index; }))
      --index;
    return index;
  }

  void rename() {
    const SheetText text{*before_->source};
    const TextSection* const section = random_section(text, false);
    if (section == nullptr || !has_no_duplicates(text, section->name.index)) return;
    const std::uint16_t index = free_index(text);
    Json expected = view_of(*before_);
    const auto move = [&](Json& one) {
      if (one.contains("index") && one["index"] == section->name.index) one["index"] = index;
    };
    for (Json& object : expected["objects"]) {
      move(object);
      for (Json& entry : object["entries"]) move(entry);
      if (!object.contains("links")) continue;
      for (Json& link : object["links"]) {
        if (link == section->name.index) link = index;
      }
    }
    const auto renamed_value = [&](Json& value) {
      if (!value.is_number_unsigned() || value.get<std::uint64_t>() >> 16U != section->name.index) return;
      value = value.get<std::uint64_t>() % 0x10000U + index * std::uint64_t{0x10000};
    };
    for (Json& object : expected["objects"]) {
      const unsigned number = object["index"];
      if ((number < 0x1600 || number > 0x17FF) && (number < 0x1A00 || number > 0x1BFF)) continue;
      for (Json& entry : object["entries"]) {
        if (entry["sub_index"] != 0 && entry.contains("default_value")) renamed_value(entry["default_value"]);
      }
    }
    for (Json& pdo : expected["pdos"]) {
      for (Json& entry : pdo["entries"]) move(entry);
    }
    std::stable_sort(expected["objects"].begin(), expected["objects"].end(),
                     [](const Json& a, const Json& b) { return a["index"] < b["index"]; });
    const std::string title =
        "5F" + std::string{"0123456789ABCDEF"[(index >> 4U) & 15U]} + "0123456789ABCDEF"[index & 15U];
    const auto after = apply({RenamePart{std::string{section->title}, "", title}}, 0);
    if (after && (index >> 8U) == 0x5F) expect(*after, expected);
  }

  void add() {
    const SheetText text{*before_->source};
    const std::uint16_t index = free_index(text);
    const std::string title = fmt_index(index);
    const auto after = apply({AddSections{{{title,
                                            {{"ParameterName", "New value"},
                                             {"ObjectType", "0x7"},
                                             {"DataType", "0x0006"},
                                             {"AccessType", "ro"},
                                             {"DefaultValue", "0x0012"},
                                             {"PDOMapping", "0"}}}}}},
                             0);
    if (!after) return;
    Json view = view_of(*after);
    Json* const object = object_of(view, index);
    ASSERT_NE(object, nullptr);
    EXPECT_EQ((*object)["entries"][0]["default_value"], 0x12);
    EXPECT_EQ((*object)["entries"][0]["data_type"], "UNSIGNED16");
    Json others = Json::array();
    for (const Json& one : view["objects"]) {
      if (one["index"] != index) others.push_back(one);
    }
    view["objects"] = others;
    if (view != view_of(*before_)) {
      ADD_FAILURE() << "other parts changed: "
                    << nlohmann::json::diff(nlohmann::json(view_of(*before_)), nlohmann::json(view));
    }
  }

  static std::string fmt_index(std::uint16_t index) {
    std::string title;
    for (int shift = 12; shift >= 0; shift -= 4)
      title += "0123456789ABCDEF"[(index >> static_cast<unsigned>(shift)) & 15U];
    return title;
  }

  /// A TPDO gets other objects.
  void map() {
    std::vector<MappingValue> objects;
    for (const Object& object : before_->device->objects) {
      for (const Entry& entry : object.entries) {
        const bool fits =
            entry.type != nullptr && (entry.type->bits == 8 || entry.type->bits == 16) && objects.size() < 3;
        if (fits && canopen::allows(entry.mappable(), canopen::Mappable::tpdo)) {
          objects.push_back({entry.index, entry.sub_index, entry.type->bits});
        }
      }
    }
    MapPdo change;
    change.number = static_cast<std::uint16_t>(1 + below(6));
    change.objects = objects;
    change.transmission_type = static_cast<std::uint8_t>(254);
    const auto after = apply({change}, 0);
    if (!after) return;
    const auto found = std::ranges::find_if(after->device->pdos, [&](const Pdo& pdo) {
      return pdo.direction == change.direction && pdo.number == change.number;
    });
    if (found == after->device->pdos.end() || found->multiplexed) return;
    std::vector<MappingValue> mapped;
    for (const PdoEntry& one : found->entries) mapped.push_back(one);
    EXPECT_EQ(mapped, objects) << "TPDO " << change.number;
    if (found->communication == nullptr || found->communication->find(2) == nullptr) return;
    const auto& type = found->communication->find(2)->default_value;
    if (type) EXPECT_EQ(type->bits, 254U);
  }

  /// Several changes at once have the result of one after another.
  void sequence() {
    const SheetText text{*before_->source};
    const std::string title = fmt_index(free_index(text));
    const std::vector<SheetChange> changes = {
        AddSections{
            {{title,
              {{"ParameterName", "New value"}, {"ObjectType", "0x7"}, {"DataType", "0x0006"}, {"AccessType", "ro"}}}}},
        SetValue{title, "DefaultValue", "3"}, SetValue{title, "DefaultValue", "4"}, RemovePart{title, ""}};
    const auto after = apply(changes, 0);
    if (after) EXPECT_EQ(view_of(*after), view_of(*before_));
  }

  std::mt19937 random_;
  std::unique_ptr<OpenSheet> before_;
  bool is_usable_ = false;
  bool is_canonical_ = false;
  std::size_t made_ = 0;
};

void change_files(const std::vector<std::string>& files) {
  std::size_t made = 0;
  for (const std::string& path : files) {
    SCOPED_TRACE(path);
    FileChanges changes{path};
    if (!changes.is_usable()) continue;
    changes.change();
    made += changes.made();
  }
  std::cout << made << " changes of " << files.size() << " files\n";
  EXPECT_GT(made, files.size());
}

TEST(ChangeFiles, OfTheRepository) {
  const fs::path root = EDSC_SOURCE_DIR;
  change_files(sheet_files_in(root / "eds"));
  change_files(sheet_files_in(root / "tests/fixtures"));
}

TEST(ChangeFiles, OfACorpus) {
  const char* const named = std::getenv("EDSC_CORPUS");
  const fs::path corpus =
      named != nullptr ? fs::path{named} : fs::path{EDSC_SOURCE_DIR}.parent_path() / "shared/eds-corpus";
  if (!fs::is_directory(corpus)) {
    std::cout << "SKIPPED: no corpus; set EDSC_CORPUS to its folder\n";
    return;
  }
  std::vector<std::string> files = sheet_files_in(corpus);
  if (named == nullptr) {
    std::vector<std::string> some;
    for (std::size_t i = 0; i < files.size(); i += 24) some.push_back(files[i]);
    files = std::move(some);
  }
  change_files(files);
}

}  // namespace
}  // namespace edsc
