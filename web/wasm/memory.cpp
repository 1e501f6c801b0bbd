// SPDX-License-Identifier: Apache-2.0
// A lack of memory leaves through JavaScript, which throws an error of its own and drops the
// instance: there are no exceptions here.
#include <__verbose_abort>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" [[noreturn]] __attribute__((import_module("slf"), import_name("out_of_memory"))) void
js_out_of_memory();

void* operator new(std::size_t bytes) {
  void* block = std::malloc(bytes);
  if (block == nullptr) js_out_of_memory();
  return block;
}
void* operator new[](std::size_t bytes) { return operator new(bytes); }
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }

// What libc++ calls where it would throw: a length out of range. Its own prints a text, which takes
// 10 kB.
_LIBCPP_BEGIN_NAMESPACE_STD
[[noreturn]] void __libcpp_verbose_abort(const char*, ...) { js_out_of_memory(); }
_LIBCPP_END_NAMESPACE_STD

// What the C++ library prints where it gives up, with the formatting of numbers and the files
// behind.
extern "C" [[noreturn]] void abort_message(const char*, ...) { __builtin_trap(); }
extern "C" [[noreturn]] void __cxa_pure_virtual() { __builtin_trap(); }
// JavaScript has these, the C library's take 5 kB. No integer that is decoded depends on them.
#define SLF_IMPORT(name) __attribute__((import_module("Math"), import_name(#name))) double js_##name
extern "C" {
SLF_IMPORT(sin)(double);
SLF_IMPORT(cos)(double);
SLF_IMPORT(acos)(double);
SLF_IMPORT(exp)(double);
SLF_IMPORT(log)(double);
SLF_IMPORT(atan2)(double, double);
SLF_IMPORT(hypot)(double, double);
double sin(double x) { return js_sin(x); }
double cos(double x) { return js_cos(x); }
double acos(double x) { return js_acos(x); }
double exp(double x) { return js_exp(x); }
double log(double x) { return js_log(x); }
double hypot(double x, double y) { return js_hypot(x, y); }
double atan2(double y, double x) { return js_atan2(y, x); }
}

#if defined(__wasm_bulk_memory__)
// One instruction each, where the C library has loops.
extern "C" void* memcpy(void* __restrict to, const void* __restrict from, std::size_t bytes) {
  return __builtin_memcpy(to, from, bytes);
}
extern "C" void* memmove(void* to, const void* from, std::size_t bytes) {
  return __builtin_memmove(to, from, bytes);
}
extern "C" void* memset(void* to, int value, std::size_t bytes) {
  return __builtin_memset(to, value, bytes);
}
#endif
