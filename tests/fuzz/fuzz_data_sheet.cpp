/// INI lines -> EDS.
#include "eds/data_sheet.hpp"
#include "fuzz.hpp"
#include "text/source_file.hpp"

namespace edsc::fuzz {
namespace {

void check(const DataSheet& sheet) {
  int last_index = -1;
  for (const ObjectDescription& object : sheet.objects) {
    require(object.index > last_index, "objects ascend by index");
    last_index = object.index;
    int last_sub_index = -1;
    for (const SubObjectDescription& sub_object : object.sub_objects) {
      require(sub_object.sub_index > last_sub_index, "sub-objects ascend by sub-index");
      last_sub_index = sub_object.sub_index;
    }
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc;
  const SourceFile source{"fuzz.eds", fuzz::text_of(data, size)};
  Diagnostics diagnostics;
  fuzz::check(read_data_sheet(parse_ini(source, diagnostics), diagnostics));
  fuzz::print(diagnostics);
  return 0;
}
