#include "random_layouts.hpp"

void random_layouts::add_layouts_3(std::vector<Codec>& codecs) {
  add_codecs<3000>(codecs, std::make_index_sequence<layouts_a_file>{});
}
