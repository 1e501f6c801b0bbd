# SPDX-License-Identifier: Apache-2.0
# Installation: libraries, public headers, the program, and what find_package(slf) reads. Components
# are Debian's packages: lib (shared C interface), dev, program.
include(CMakePackageConfigHelpers)
set(SLF_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/slf)

set_target_properties(slf_decoder PROPERTIES EXPORT_NAME decoder)
install(TARGETS ${SLF_LIBRARIES} EXPORT slfTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        COMPONENT dev)
if(TARGET slf_c)
  install(TARGETS slf_c EXPORT slfTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT lib
          NAMELINK_COMPONENT dev RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT lib)
endif()
install(DIRECTORY include/slf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
        FILES_MATCHING PATTERN "*.h")
install(EXPORT slfTargets NAMESPACE slf:: DESTINATION ${SLF_CMAKE_DIR} COMPONENT dev)
if(TARGET slf_program)
  install(TARGETS slf_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  # What desktops and `file -m` know files by. libmagic has no folder for entries of others.
  install(FILES tools/desktop/slf.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages
          COMPONENT program)
  install(FILES tools/desktop/slf.thumbnailer DESTINATION ${CMAKE_INSTALL_DATADIR}/thumbnailers COMPONENT program)
  install(FILES tools/desktop/slf.magic DESTINATION ${CMAKE_INSTALL_DATADIR}/slf COMPONENT program)
endif()

configure_package_config_file(tools/cmake/slfConfig.cmake.in ${PROJECT_BINARY_DIR}/slfConfig.cmake
                              INSTALL_DESTINATION ${SLF_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/slfConfigVersion.cmake
                                 COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/slfConfig.cmake ${PROJECT_BINARY_DIR}/slfConfigVersion.cmake
        DESTINATION ${SLF_CMAKE_DIR} COMPONENT dev)
include(tools/cmake/slf_pkg_config.cmake)
include(tools/cmake/slf_manual.cmake)
if(PROJECT_IS_TOP_LEVEL)
  include(tools/cmake/slf_debian.cmake)
endif()
