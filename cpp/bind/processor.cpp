// Chooses a clone for wider vectors (base/clones.hpp) when the extension of a wheel is loaded.
// zig's runtime library has only a stub of this function, which finds the oldest processor
// everywhere; an identify() then takes 1.4 times as long.
// The function runs while the extension is relocated, so it calls nothing outside of it.

#if defined(__x86_64__) && defined(JOINTID_ZIG)

namespace {

/// Layout as the compiler reads it. Of the features, in the compiler's order, only AVX2 is used.
struct Model {
  unsigned vendor;
  unsigned type;
  unsigned subtype;
  unsigned features;
};
constexpr unsigned kAvx2 = 1U << 10U;

struct Registers {
  unsigned a;
  unsigned b;
  unsigned c;
  unsigned d;
};

Registers ask(unsigned leaf) {
  Registers found{leaf, 0, 0, 0};
  __asm__ volatile("cpuid" : "+a"(found.a), "=b"(found.b), "+c"(found.c), "=d"(found.d));
  return found;
}

/// Whether the processor has AVX2 and the kernel saves its registers.
bool has_avx2() {
  constexpr unsigned kFeatures = 1;
  constexpr unsigned kMoreFeatures = 7;
  constexpr unsigned kAvxAndKept =
      1U << 28U | 1U << 27U;                         // features, c: AVX; saved registers are known
  constexpr unsigned kHalves = 1U << 1U | 1U << 2U;  // halves of the vector registers
  constexpr unsigned kWide = 1U << 5U;               // more features, b: AVX2
  if (ask(0).a < kMoreFeatures || (ask(kFeatures).c & kAvxAndKept) != kAvxAndKept) return false;
  unsigned kept = 0;
  unsigned rest = 0;
  __asm__ volatile("xgetbv" : "=a"(kept), "=d"(rest) : "c"(0));
  return (kept & kHalves) == kHalves && (ask(kMoreFeatures).b & kWide) != 0;
}

}  // namespace

extern "C" {

__attribute__((visibility("hidden"))) Model __cpu_model;

__attribute__((visibility("hidden"))) int __cpu_indicator_init() {
  __cpu_model.features = has_avx2() ? kAvx2 : 0;
  return 0;
}
}
#endif
