// SPDX-License-Identifier: Apache-2.0
// What libjpeg says of an error, and where it goes on: it arrives by longjmp, so a function that
// calls setjmp has only trivial locals.
#pragma once

#include <cstddef>
#include <cstdio>
// jpeglib.h needs the two above.
#include <jpeglib.h>

#include <csetjmp>

namespace slf {

struct JpegErrors {
  jpeg_error_mgr base;  // first: libjpeg hands back a pointer to it
  std::jmp_buf jump;
  char text[JMSG_LENGTH_MAX] = "";
  bool damaged = false;  // a warning that means missing pixels
};

/// For jpeg_error_mgr::error_exit of a JpegErrors.
inline void on_jpeg_error(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->text);
  std::longjmp(errors->jump, 1);
}

}  // namespace slf
