// SPDX-License-Identifier: Apache-2.0
// malloc and free of one instance, on one thread: a tenth of the bytes of the C library's. Blocks
// lie one after another, those that are free in lists by size; neighbours that are free are joined.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

extern "C" char __heap_base;  // where the linker's own data ends

namespace {

constexpr std::uint32_t kPage = 65536, kUsed = 1;
constexpr int kTries = 64;  // blocks of about the size that is wanted, before a larger one is split

/// Stands before its memory. Sizes are with this head, multiples of 16.
struct Block {
  std::uint32_t before;  ///< size of the block before it in memory; 0: there is none
  std::uint32_t bytes;   ///< or kUsed where it is not free
  Block* next;           ///< of its list, where it is free
  Block** link;          ///< what points to it there

  bool is_free() const { return (bytes & kUsed) == 0; }
  Block* at(std::uint32_t offset) {
    return reinterpret_cast<Block*>(reinterpret_cast<char*>(this) + offset);
  }
  Block* after() { return at(bytes & ~kUsed); }
};

Block* lists[32];  // of free blocks, by the logarithm of their size
Block* last;       // without memory, never free: what lies behind all others

Block*& list_of(std::uint32_t bytes) { return lists[std::bit_width(bytes) - 1]; }

void enter(Block* block) {
  block->link = &list_of(block->bytes);
  block->next = *block->link;
  *block->link = block;
  if (block->next != nullptr) block->next->link = &block->next;
}

void leave(Block* block) {
  *block->link = block->next;
  if (block->next != nullptr) block->next->link = block->link;
}

void give_back(Block* block) {
  Block* previous = block->at(0u - block->before);  // itself, not free yet, where there is none
  Block* next = block->after();
  std::uint32_t bytes = block->bytes - kUsed;
  if (next->is_free()) {
    leave(next);
    bytes += next->bytes;
  }
  if (previous->is_free()) {
    leave(previous);
    bytes += previous->bytes;
    block = previous;
  }
  block->bytes = bytes;
  block->after()->before = bytes;
  enter(block);
}

/// All that is behind `last` becomes a free block.
void take_in() {
  Block* block = last;
  last = reinterpret_cast<Block*>(__builtin_wasm_memory_size(0) * kPage - sizeof(Block));
  last->bytes = kUsed;
  block->bytes =
      static_cast<std::uint32_t>(reinterpret_cast<char*>(last) - reinterpret_cast<char*>(block)) +
      kUsed;
  give_back(block);
}

/// A free block of `bytes` or more, before `last`: what is free there counts. And by half of what
/// there is, where that can be had: pages that nobody has touched cost nothing, but an engine
/// collects garbage after a few growths, 15 times in a decode.
Block* grow(std::uint32_t bytes) {
  if (last == nullptr)
    last = reinterpret_cast<Block*>((reinterpret_cast<std::uintptr_t>(&__heap_base) + 15) & ~15u);
  if (Block* tail = last->at(0u - last->before); tail->is_free()) {  // or `last` itself
    if (tail->bytes >= bytes) return tail;
    bytes -= tail->bytes;
  }
  const std::size_t pages = (bytes + kPage - 1) / kPage;
  const std::size_t more = pages + __builtin_wasm_memory_size(0) / 2;
  if (__builtin_wasm_memory_grow(0, more) == SIZE_MAX &&
      __builtin_wasm_memory_grow(0, pages) == SIZE_MAX)
    return nullptr;
  take_in();
  return last->at(0u - last->before);
}

Block* find(std::uint32_t bytes) {
  int tries = kTries;
  for (Block* block = list_of(bytes); block != nullptr && tries-- > 0; block = block->next)
    if (block->bytes >= bytes) return block;
  for (auto size = static_cast<unsigned>(std::bit_width(bytes)); size < 32; ++size)
    if (lists[size] != nullptr) return lists[size];
  return nullptr;
}

/// What is left of it beyond `bytes` becomes a block.
void split(Block* block, std::uint32_t bytes) {
  const std::uint32_t rest = block->bytes - bytes;
  if (rest < 2 * sizeof(Block)) return;
  block->bytes = bytes;
  Block* behind = block->after();
  behind->before = bytes;
  behind->bytes = rest;
  behind->after()->before = rest;
  enter(behind);
}

}  // namespace

extern "C" void* malloc(std::size_t size) {
  if (size > UINT32_MAX - 2 * kPage) return nullptr;
  const auto bytes = static_cast<std::uint32_t>((size + sizeof(Block) + 15) & ~std::size_t{15});
  Block* block = find(bytes);
  if (block == nullptr) block = grow(bytes);
  if (block == nullptr) return nullptr;
  leave(block);
  split(block, bytes);
  block->bytes |= kUsed;
  return block + 1;
}

extern "C" void free(void* memory) {
  if (memory != nullptr) give_back(static_cast<Block*>(memory) - 1);
}

extern "C" void* calloc(std::size_t count, std::size_t size) {
  std::size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes)) return nullptr;
  void* memory = malloc(bytes);
  return memory == nullptr ? nullptr : std::memset(memory, 0, bytes);
}

extern "C" void* realloc(void* memory, std::size_t size) {
  void* moved = malloc(size);
  if (memory == nullptr || moved == nullptr) return moved;
  const std::size_t had = (static_cast<Block*>(memory) - 1)->bytes - kUsed - sizeof(Block);
  std::memcpy(moved, memory, had < size ? had : size);
  free(memory);
  return moved;
}

/// Nothing here asks for more than malloc gives: 16.
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return alignment <= 16 ? malloc(size) : nullptr;
}

extern "C" int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = aligned_alloc(alignment, size);
  return *memory == nullptr ? 12 : 0;  // ENOMEM
}

/// What libc keeps of work for an exit, which never comes, asks by this name.
extern "C" void* __libc_calloc(std::size_t count, std::size_t size) { return calloc(count, size); }
