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
// Sine and cosine of arguments above 10^6, 5 kB of them: angles here are below 2 pi.
extern "C" int __rem_pio2_large(double*, double*, int, int, int) { __builtin_trap(); }

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
