# SPDX-License-Identifier: Apache-2.0
# Debian's clang 19 with WASI's libc++: decoders in WebAssembly, without exceptions and threads.
set(CMAKE_SYSTEM_NAME WASI)
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}/wasm")  # Platform/WASI
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_CXX_FLAGS_INIT -fno-exceptions)
# Objects are linked as they are; the system's ar does not know those of this compiler.
foreach(language C CXX)
  set(CMAKE_${language}_ARCHIVE_CREATE "<CMAKE_COMMAND> -E touch <TARGET>")
  set(CMAKE_${language}_ARCHIVE_APPEND "")
  set(CMAKE_${language}_ARCHIVE_FINISH "")
endforeach()
set(CMAKE_INSTALL_LIBDIR lib)  # nothing is installed; without it CMake warns
# Nothing is compiled to find out (CMAKE_C_COMPILER_FORCED).
set(CMAKE_SIZEOF_VOID_P 4)
