/// Measures codecs of PdoLayout and hand-written ones: nanoseconds per call.
///
///     pdo_codec [ROUNDS [CALLS]]
///
/// Prints `NAME TYPED BY_HAND` for each codec: the best of all rounds, which alternate. pdo_codec.py runs it.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "codecs.hpp"

namespace {

using codec::Data;

/// The result of all loops, so that the compiler does not remove them.
std::uint64_t sum = 0;

Data data_of(unsigned i) {
  Data data{};
  for (std::size_t k = 0; k < data.size(); ++k) data[k] = static_cast<std::uint8_t>(i * (k + 1));
  return data;
}

template <class Call>
double nanoseconds_a_call(unsigned calls, Call call) {
  const auto start = std::chrono::steady_clock::now();
  for (unsigned i = 0; i < calls; ++i) call(i);
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
  return time.count() / calls;
}

template <class Typed, class ByHand>
void compare(const char* name, unsigned rounds, unsigned calls, Typed typed, ByHand by_hand) {
  double best_typed = 1e9;
  double best_by_hand = 1e9;
  for (unsigned round = 0; round < rounds; ++round) {
    const double a = nanoseconds_a_call(calls, typed);
    const double b = nanoseconds_a_call(calls, by_hand);
    if (a < best_typed) best_typed = a;
    if (b < best_by_hand) best_by_hand = b;
  }
  std::printf("%s %.3f %.3f\n", name, best_typed, best_by_hand);
}

/// A loop that packs; each call continues with the data of the call before.
template <class Pack>
auto packs(Pack pack) {
  return [pack, data = Data{}](unsigned i) mutable {
    pack(data, i);
    sum += data[i % 8];
  };
}

/// A loop that unpacks one of several PDOs.
template <class Unpack>
auto unpacks(Unpack unpack) {
  return [unpack, pdos = std::array{data_of(3), data_of(5), data_of(250), data_of(77)}](unsigned i) {
    sum += static_cast<std::uint64_t>(std::get<2>(unpack(pdos[i % pdos.size()])));
  };
}

template <class T>
T as(unsigned i) {
  return static_cast<T>(i);
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned rounds = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 20;
  const unsigned calls = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1'000'000;
  namespace typed = codec::typed;
  namespace by_hand = codec::by_hand;

  compare("pack_words", rounds, calls, packs([](Data& data, unsigned i) {
            typed::pack_words(data, as<std::uint16_t>(i), as<std::uint16_t>(i + 1), as<std::int16_t>(i), 7);
          }),
          packs([](Data& data, unsigned i) {
            by_hand::pack_words(data, as<std::uint16_t>(i), as<std::uint16_t>(i + 1), as<std::int16_t>(i), 7);
          }));
  compare("unpack_words", rounds, calls, unpacks(typed::unpack_words), unpacks(by_hand::unpack_words));
  compare("pack_odd", rounds, calls, packs([](Data& data, unsigned i) {
            typed::pack_odd(data, i % 2 != 0, i % 3 != 0, *codec::In<codec::Odd, 2>::from(std::uint64_t{i} << 7),
                            *codec::In<codec::Odd, 3>::from(i % 2048));
          }),
          packs([](Data& data, unsigned i) {
            by_hand::pack_odd(data, i % 2 != 0, i % 3 != 0, std::uint64_t{i} << 7, as<std::int16_t>(i % 2048));
          }));
  compare("unpack_odd", rounds, calls, unpacks(typed::unpack_odd), unpacks(by_hand::unpack_odd));
  return sum == 0 ? 1 : 0;
}
