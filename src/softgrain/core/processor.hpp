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

/// a b + c with one rounding, element by element; Floats is a compiler vector of eight floats. The same bits
/// everywhere; slow on a processor without the instruction.
template <class Floats>
inline Floats fused_multiply_add(Floats a, Floats b, Floats c) {
#if defined(__FMA__)
  return __builtin_ia32_vfmaddps256(a, b, c);
#else
  constexpr int size = sizeof(Floats) / sizeof(float);
  for (int k = 0; k < size; ++k) c[k] = __builtin_fmaf(a[k], b[k], c[k]);
  return c;
#endif
}

}  // namespace softgrain
