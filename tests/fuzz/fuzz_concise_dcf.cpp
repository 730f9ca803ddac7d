/// Arbitrary bytes as a concise DCF (1F22h): its entries make up the whole stream; nothing beyond it is read.
#include "format/dcf/concise_dcf.hpp"
#include "fuzz.hpp"
#include "values/value_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  const std::string stream = fuzz::text_of(data, size);
  const auto entries = read_concise_dcf(stream);
  if (!entries) return 0;
  std::string again;
  append_bytes(again, entries->size(), 4);
  for (const ConciseEntry& entry : *entries) {
    append_bytes(again, entry.index, 2);
    append_bytes(again, entry.sub_index, 1);
    append_bytes(again, entry.data.size(), 4);
    again += entry.data;
  }
  fuzz::require(again == stream, "the entries are the whole stream");
  return 0;
}
