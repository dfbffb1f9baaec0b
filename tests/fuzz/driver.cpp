// What libFuzzer calls; SOFTGRAIN_FUZZ_TARGET is one of the functions of targets.hpp.
#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  softgrain::fuzz::SOFTGRAIN_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}

// What a target makes at its first call does not count to the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  for (char first = 0; first < 5; ++first) softgrain::fuzz::SOFTGRAIN_FUZZ_TARGET({&first, 1});
  return 0;
}
