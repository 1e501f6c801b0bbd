# SPDX-License-Identifier: Apache-2.0
# Man pages and bash completion, made of what the program itself says with --help.
find_package(Python3 COMPONENTS Interpreter)
if(TARGET slf_program AND Python3_FOUND AND NOT CMAKE_CROSSCOMPILING)
  set(manual ${PROJECT_BINARY_DIR}/manual)
  file(MAKE_DIRECTORY ${manual})
  add_custom_command(
    OUTPUT ${manual}/slf.1 ${manual}/slf.bash
    COMMAND Python3::Interpreter ${PROJECT_SOURCE_DIR}/tools/manual.py $<TARGET_FILE:slf_program>
            ${manual}
    COMMAND sh -c "rm -f *.1.gz && gzip -9nk *.1"  # as Debian has them, the same bytes each time
    WORKING_DIRECTORY ${manual}
    DEPENDS slf_program ${PROJECT_SOURCE_DIR}/tools/manual.py ${PROJECT_SOURCE_DIR}/tools/manual_texts.py
    COMMENT "Man pages and bash completion" VERBATIM)
  add_custom_target(slf_manual ALL DEPENDS ${manual}/slf.1 ${manual}/slf.bash)
  install(DIRECTORY ${manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program
          FILES_MATCHING PATTERN "*.1.gz")
  install(FILES ${manual}/slf.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME slf COMPONENT program)
endif()
