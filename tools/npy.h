// SPDX-License-Identifier: Apache-2.0
// NumPy's .npy files, versions 1 and 2: little endian, C order.
// Source: numpy.lib.format documentation ("NPY format").
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "slf/error.h"

namespace slf::tools {

/// An array as stored. Elements are checked to be there: product of shape times size fits the
/// bytes.
struct NpyArray {
  char kind = 'i';  ///< 'i' signed, 'u' unsigned, 'f' float
  int size = 4;     ///< bytes per element: 1, 2, 4 or 8
  std::vector<std::size_t> shape;
  std::vector<std::uint8_t> bytes;  ///< the whole file
  std::size_t first = 0;            ///< of the elements within bytes

  std::size_t count() const;  ///< product of shape
};

/// Reads a whole .npy held in memory. The file is hostile: nothing is allocated that its bytes do
/// not back.
/// @errors kInvalidInput: another kind of file, a type or order that is not read, too few or too
///         many bytes. The message does not name the file.
Result<NpyArray, InputError> parse_npy(std::vector<std::uint8_t> file);

/// The elements of an integer array, any width.
/// @errors kInvalidInput: the array holds floats, or a value that does not fit 32 bits (signed).
Result<std::vector<std::int32_t>, InputError> int32_values(const NpyArray& array);

/// A version 1 file: its head, and the elements where they are.
struct NpyFile {
  std::string head;
  std::span<const std::byte> elements;
};
NpyFile npy_file(const std::vector<std::size_t>& shape, std::span<const std::int32_t> values);
NpyFile npy_file(const std::vector<std::size_t>& shape, std::span<const std::uint16_t> values);
NpyFile npy_file(const std::vector<std::size_t>& shape, std::span<const float> values);

}  // namespace slf::tools
