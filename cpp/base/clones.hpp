#pragma once
// JOINTID_CLONES before a function makes the compiler build it for several vector widths; the
// loader picks the widest that the host has. The bits are the same on every host: the arithmetic of
// a lane does not depend on the width, contraction into fused operations is off
// (-ffp-contract=off), and sums keep the order in which they are written.
// Clones need ifunc (GNU libc). Sanitizers exclude them, because they run before ifunc is resolved.
// Only tested versions of clang are admitted: version 14 omits the clones of a function that a
// header declares without the attribute.
// JOINTID_CLONED is defined if there are clones.
// -DJOINTID_CLONES= switches the clones off, to measure their benefit.

#ifndef JOINTID_CLONES
#if defined(__x86_64__) && defined(__gnu_linux__)
#include <cstddef>  // defines __GLIBC__
#if defined(__clang__) && defined(__GLIBC__)
#if __clang_major__ >= 19 && !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
#define JOINTID_CLONES __attribute__((target_clones("avx2", "default")))
#define JOINTID_CLONED
#endif
#elif defined(__GNUC__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define JOINTID_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#define JOINTID_CLONED
#endif
#endif
#endif

#ifndef JOINTID_CLONES
#define JOINTID_CLONES
#endif
