#pragma once

namespace softgrain {

// What standard C++ does not say and what depends on the processor. Nothing else in the library names an
// instruction; tools/check_layers holds this (docs/decisions/0032).

/// Tells the processor that this thread only waits in a loop.
inline void spin_pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

using EightFloats = float __attribute__((vector_size(32)));

/// a b + c with one rounding, element by element, by an addition of doubles. The product of two floats is
/// exact in double. The sum is rounded to double and then to float, which is wrong only where a rounding to
/// double has moved it into the middle of two floats, or for results below the normal floats: rare, and done
/// one by one.
inline EightFloats fused_by_doubles(EightFloats a, EightFloats b, EightFloats c) {
  using Doubles = double __attribute__((vector_size(64)));
  using Bits = long long __attribute__((vector_size(64)));
  constexpr long long below_float = (1LL << 29) - 1, middle = 1LL << 28;
  constexpr long long magnitude = ~(1LL << 63), least_normal = (1023LL - 126) << 52;
  const Doubles sum = __builtin_convertvector(a, Doubles) * __builtin_convertvector(b, Doubles) +
                      __builtin_convertvector(c, Doubles);
  const Bits bits = __builtin_bit_cast(Bits, sum);
  const Bits size = bits & magnitude;
  const Bits doubtful = ((bits & below_float) == middle) | ((size < least_normal) & (size != 0));
  const auto half = __builtin_shufflevector(doubtful, doubtful, 0, 1, 2, 3) |
                    __builtin_shufflevector(doubtful, doubtful, 4, 5, 6, 7);
  const auto pair = __builtin_shufflevector(half, half, 0, 1) | __builtin_shufflevector(half, half, 2, 3);
  EightFloats result = __builtin_convertvector(sum, EightFloats);
  if ((pair[0] | pair[1]) != 0) [[unlikely]]
    for (int k = 0; k < 8; ++k) result[k] = __builtin_fmaf(a[k], b[k], c[k]);
  return result;
}

/// a b + c with one rounding, element by element. The same bits everywhere; slower on a processor without the
/// instruction.
inline EightFloats fused_multiply_add(EightFloats a, EightFloats b, EightFloats c) {
#if defined(__FMA__)
  return __builtin_ia32_vfmaddps256(a, b, c);
#elif defined(__aarch64__)
  for (int k = 0; k < 8; ++k) c[k] = __builtin_fmaf(a[k], b[k], c[k]);
  return c;
#else
  return fused_by_doubles(a, b, c);
#endif
}

}  // namespace softgrain
