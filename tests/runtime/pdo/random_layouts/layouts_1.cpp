#include "random_layouts.hpp"

void random_layouts::add_layouts_1(std::vector<Codec>& codecs) {
  add_codecs<1000>(codecs, std::make_index_sequence<layouts_a_file>{});
}
