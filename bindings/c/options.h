// SPDX-License-Identifier: Apache-2.0
// What a C caller asks for and brings along, in the library's own types.
#pragma once

#include "slf/decoder.h"
#include "slf/slf.h"

namespace slf::capi {

DecodeOptions options_of(const slf_options& given);

/// Both functions or none.
bool is_usable(const slf_allocator* allocator);

}  // namespace slf::capi
