// SPDX-License-Identifier: Apache-2.0
// Memory of the caller's allocator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <span>
#include <utility>

#include "slf/slf.h"

namespace slf::capi {

/// The caller's allocator, or malloc. A value: objects that outlive another keep their own.
class Allocator {
 public:
  explicit Allocator(const slf_allocator& given) : given_(given) {}

  /// nullptr: no memory.
  void* allocate(std::size_t bytes) const {
    return given_.allocate ? given_.allocate(given_.user, bytes) : std::malloc(bytes);
  }
  void deallocate(void* block, std::size_t bytes) const {
    if (block == nullptr) return;
    given_.deallocate ? given_.deallocate(given_.user, block, bytes) : std::free(block);
  }

  /// nullptr: no memory.
  template <class Object, class... Arguments>
  Object* make(Arguments&&... arguments) const {
    void* place = allocate(sizeof(Object));
    return place == nullptr ? nullptr : new (place) Object{std::forward<Arguments>(arguments)...};
  }
  template <class Object>
  static void destroy(Object* object) {
    if (object == nullptr) return;
    const Allocator allocator = object->allocator;
    object->~Object();
    allocator.deallocate(object, sizeof(Object));
  }

 private:
  slf_allocator given_;
};

/// Bytes of a stream.
class Block {
 public:
  explicit Block(const Allocator& allocator) : allocator_(allocator) {}
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  Block(Block&& other) noexcept
      : allocator_(other.allocator_),
        data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)) {}
  ~Block() { allocator_.deallocate(data_, size_); }

  /// Leaves what was there behind. False: no memory.
  bool resize(std::size_t size) {
    allocator_.deallocate(data_, size_);
    data_ = size > 0 ? static_cast<std::uint8_t*>(allocator_.allocate(size)) : nullptr;
    size_ = data_ != nullptr ? size : 0;
    return size_ == size;
  }
  std::span<std::uint8_t> bytes() { return {data_, size_}; }
  std::span<const std::uint8_t> bytes() const { return {data_, size_}; }

 private:
  Allocator allocator_;
  std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace slf::capi
