# SPDX-License-Identifier: Apache-2.0
# With CMAKE_UNITY_BUILD=ON, as tools/demo.sh and tools/test.sh build, up to twelve files of a folder are one
# for the compiler, which is done in half the time: most of it goes into headers and templates that
# they share. Names in a folder's unnamed namespaces are unlike each other for this. With
# SLF_PRECOMPILED=ON, as the developers' preset has it, each is compiled alone, and what most of them
# include once a library: all of them take longer, one file a tenth of its dozen.
set(SLF_FILES_AT_ONCE 12)
# Adapters of libraries stay alone: their headers define short names.
set(SLF_COMPILED_ALONE "/(av1_codec|hevc_decoder|hevc_encoder|jpeg_adapter|jpeg_encoder|nearest|png_adapter|webp_adapter|zip_bundle|zstd_adapter)\\.cpp$")

function(slf_unity target)
  get_target_property(sources ${target} SOURCES)
  get_target_property(directory ${target} SOURCE_DIR)
  foreach(source ${sources})
    if(NOT source MATCHES "\\.cpp$")
      continue()
    endif()
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${directory})
    if(source MATCHES "${SLF_COMPILED_ALONE}")
      continue()
    endif()
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(REPLACE / _ folder ${folder})
    math(EXPR ${folder}_files "${${folder}_files} + 1")
    math(EXPR part "(${${folder}_files} - 1) / ${SLF_FILES_AT_ONCE}")
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${folder}_${part})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

if(CMAKE_UNITY_BUILD)
  set(CMAKE_UNITY_BUILD OFF)  # of programs of one file each; tests say it themselves
  set(SLF_UNITY ON)
endif()

function(slf_precompiled target)
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <memory> <numeric> <optional> <span>
    <string> <utility> <vector>)
  # Adapters define macros before they include anything, and some files have options of their own.
  get_target_property(sources ${target} SOURCES)
  get_target_property(directory ${target} SOURCE_DIR)
  foreach(source ${sources})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${directory})
    get_property(options SOURCE ${source} TARGET_DIRECTORY ${target} PROPERTY COMPILE_OPTIONS)
    if(options OR source MATCHES "${SLF_COMPILED_ALONE}|\\.c$")
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
endfunction()
