# Nothing: wasi.cmake says it all. Without this file CMake asks for it.
