# SPDX-License-Identifier: Apache-2.0
# Libraries go where Debian has them, lib/x86_64-linux-gnu and the like, below any prefix: its linker, pkg-config and
# cmake look there, and packages of two architectures lie side by side. GNUInstallDirs does it below /usr alone.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_INSTALL_LIBDIR AND CMAKE_LIBRARY_ARCHITECTURE AND EXISTS /etc/debian_version)
  set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE} CACHE PATH "Libraries, below the prefix")
endif()
