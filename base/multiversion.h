// SPDX-License-Identifier: Apache-2.0
// Hot loops over integers, compiled for AVX2 as well where there is; the result is the same.
#pragma once

// clang 14 has no target_clones; a sanitizer's run-time is not ready when the choice is made; the
// loader of ELF alone makes it.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SLF_MULTIVERSION __attribute__((target_clones("arch=x86-64-v3", "default")))
// With what the function calls.
#define SLF_MULTIVERSION_ALL SLF_MULTIVERSION __attribute__((flatten))
// With what the function calls, and for AVX-512: loops over planes, whose products have 64 bits.
#define SLF_MULTIVERSION_LANES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"), flatten))
#else
#define SLF_MULTIVERSION
#define SLF_MULTIVERSION_ALL
#define SLF_MULTIVERSION_LANES
#endif

// For a part of a long loop. Engines of WebAssembly compile what runs a second time, better, and
// take the better code at the next call: of a loop that is one call, never.
#if defined(__wasm__)
#define SLF_OWN_CALL __attribute__((noinline))
#define SLF_IN_LINE inline __attribute__((always_inline))
#else
#define SLF_OWN_CALL
#define SLF_IN_LINE inline
#endif

// Before a loop of eight rounds whose counter should be a constant in each.
#if defined(__GNUC__) && !defined(__clang__)
#define SLF_UNROLL_8 _Pragma("GCC unroll 8")
#else
#define SLF_UNROLL_8
#endif
