#pragma once
// JOINTID_CLONES before a function makes the compiler build it for several vector widths; the
// loader picks the widest that the host has. The bits are the same on every host: the arithmetic
// of a lane does not depend on the width, contraction into fused operations is off
// (-ffp-contract=off), and sums keep the order in which they are written.
// Needs ifunc (GNU libc); sanitizers run before it is resolved.

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#include <cstddef>  // defines __GLIBC__
#ifdef __GLIBC__
#define JOINTID_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#endif
#endif

#ifndef JOINTID_CLONES
#define JOINTID_CLONES
#endif
