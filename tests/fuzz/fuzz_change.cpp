/// Sequences of changes of an EDS: they can be taken back, a canonical file remains canonical, and the edits of lines
/// have the same result as the edits of bytes.
///
/// An input is an EDS; the bytes after a line `%%` choose the changes.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "change/apply_changes.hpp"
#include "change/sheet_text.hpp"
#include "fuzz.hpp"

namespace edsc::fuzz {
namespace {

constexpr std::size_t max_changes = 100;

/// The bytes that choose the changes; zeros at the end.
class Choices {
 public:
  explicit Choices(std::string_view bytes) : bytes_{bytes} {}

  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  std::size_t below(std::size_t end) {
    if (bytes_.empty() || end == 0) return 0;
    const auto byte = static_cast<unsigned char>(bytes_.front());
    bytes_.remove_prefix(1);
    return byte % end;
  }

 private:
  std::string_view bytes_;
};

constexpr std::string_view keys[] = {"ParameterName", "DataType",   "AccessType", "DefaultValue", "PDOMapping",
                                     "HighLimit",     "ObjectType", "SubNumber",  "VendorNumber", "Own"};
constexpr std::string_view values[] = {"", "0", "7", "0x10", "$NODEID+0x180", "rw", "10h", "-1", "a ; b", "\xC2\xB0"};
constexpr std::string_view titles[] = {"2000", "2000sub0", "2000sub1", "2000sub2",   "1018sub1", "1800",
                                       "1A00", "1A00sub1", "6040",     "DeviceInfo", "Vendor",   "2000Name"};

SheetChange random_change(Choices& choices, const OpenSheet& sheet) {
  const SheetText text{*sheet.source};
  const auto pick = [&](const auto& list) { return std::string{list[choices.below(std::size(list))]}; };
  const auto title = [&] {
    const std::size_t place = choices.below(text.sections().size() + 4);
    return place < text.sections().size() ? std::string{text.sections()[place].title} : pick(titles);
  };
  switch (choices.below(5)) {
    case 0: return SetValue{title(), pick(keys), pick(values)};
    case 1: return RemovePart{title(), choices.below(2) == 0 ? std::string{} : pick(keys)};
    case 2: {
      const bool is_key = choices.below(4) == 0;
      return RenamePart{title(), is_key ? pick(keys) : std::string{}, is_key ? pick(keys) : pick(titles)};
    }
    case 3: return AddSections{{{pick(titles), {{pick(keys), pick(values)}, {"ParameterName", "a"}}}}};
    default: break;
  }
  MapPdo map;
  map.direction = choices.below(2) == 0 ? PdoDirection::receive : PdoDirection::transmit;
  map.number = static_cast<std::uint16_t>(choices.below(6));
  map.objects.emplace();
  for (std::size_t i = choices.below(4); i > 0; --i) {
    map.objects->push_back({static_cast<std::uint16_t>(choices.below(2) == 0 ? 0x2000 : 0x0005), 0, 8});
  }
  if (choices.below(2) == 0) map.cob_id = pick(values);
  return map;
}

void check(const OpenSheet& before, const AppliedChanges& applied) {
  require(applied.edits.empty() == (applied.after->source->text() == before.source->text()), "an edit is a difference");
  require(with_edits(before.bytes, applied.bytes) == applied.after->bytes, "edits of bytes have the result");
  require(without_edits(applied.after->bytes, applied.bytes) == before.bytes, "changes can be taken back");
  if (applied.after->device && is_canonical(before)) {
    require(is_canonical(*applied.after), "a canonical file remains canonical");
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  constexpr std::string_view between = "\n%%\n";
  const std::string input = fuzz::text_of(data, size);
  const std::size_t end = input.find(between);
  if (end == std::string::npos) return 0;
  fuzz::Choices choices{std::string_view{input}.substr(end + between.size())};
  std::unique_ptr<const OpenSheet> sheet = open_sheet("fuzz.eds", input.substr(0, end), {}, SheetChecks::all);
  for (std::size_t i = 0; i < fuzz::max_changes && !choices.empty(); ++i) {
    const SheetChange change = fuzz::random_change(choices, *sheet);
    AppliedChanges applied = apply_changes(*sheet, std::vector{change}, {.force = true, .utf8 = true, .stamp = {}});
    if (applied.is_rejected) continue;
    fuzz::check(*sheet, applied);
    sheet = std::move(applied.after);
  }
  return 0;
}
