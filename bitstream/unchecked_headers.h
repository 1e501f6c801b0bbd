// SPDX-License-Identifier: Apache-2.0
// Headers as they are, whatever their values: conformance streams and tests have wrong ones. Coders
// do not include this (tests/house/layers_test.py).
#pragma once

#include "bitstream/index.h"

namespace slf {

std::vector<std::uint8_t> sequence_as_is(const SequenceParameterSet& set);
std::vector<std::uint8_t> slice_table_as_is(const SliceTable& table,
                                            const SequenceParameterSet& set);
std::vector<std::uint8_t> index_as_is(const Index& index, const SequenceParameterSet& set);

}  // namespace slf
