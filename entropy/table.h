// SPDX-License-Identifier: Apache-2.0
// Tables that follow from a formula.
#pragma once

// Constants of the program. Where a decoder is sent over a network they would be a fifth of it:
// with SLF_TABLES_AT_START they are made when it starts, in less than a millisecond.
#if defined(SLF_TABLES_AT_START)
#define SLF_TABLE inline const
#define SLF_TABLE_MEMBER static inline const
#define SLF_TABLE_FUNCTION inline
#define SLF_TABLE_BEGINS asm volatile("")  // nothing that a compiler works out
#else
#define SLF_TABLE inline constexpr
#define SLF_TABLE_MEMBER static constexpr
#define SLF_TABLE_FUNCTION constexpr
#define SLF_TABLE_BEGINS static_cast<void>(0)
#endif
