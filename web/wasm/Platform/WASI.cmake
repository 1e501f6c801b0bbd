# SPDX-License-Identifier: Apache-2.0
# Nothing: wasi.cmake says it all. Without this file CMake asks for it.
