# The manual pages of the program are made from its own help, so that they cannot differ from it. Without help2man there are
# none. The pages of the figures' commands only lead to their help, which needs the modules of Python.
find_program(HELP2MAN help2man)
if(HELP2MAN AND NOT CMAKE_CROSSCOMPILING)
  set(pages "")
  foreach(command voussoir voussoir-run voussoir-check voussoir-sweep voussoir-ensemble voussoir-mesh voussoir-keys
          voussoir-info)
    string(REGEX REPLACE "^voussoir-?" "" subcommand ${command})
    set(page "${PROJECT_BINARY_DIR}/man/${command}.1")
    string(TOUPPER ${command} upper)
    string(REPLACE "-" " " title ${command})
    set(name "${title}: ground movement around tunnels, from grains")
    if(subcommand)
      set(name "the command ${subcommand} of voussoir")
    endif()
    add_custom_command(OUTPUT "${page}" DEPENDS voussoir VERBATIM COMMENT "Making the manual page of ${title}"
      COMMAND "${HELP2MAN}" --no-info --no-discard-stderr
              "--version-string=${PROJECT_VERSION}" "--name=${name}" "--help-option=${subcommand} --help"
              "--output=${page}" $<TARGET_FILE:voussoir>
      # help2man names each page after the program.
      COMMAND sed -i -e "s/^voussoir \\\\- /${command} \\\\- /" -e "s/^\\.TH VOUSSOIR/.TH ${upper}/" "${page}")
    list(APPEND pages "${page}")
  endforeach()
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/man")
  set(made_pages ${pages})
  foreach(command voussoir-figures voussoir-report)
    string(TOUPPER ${command} upper)
    configure_file(cmake/voussoir_command.1.in "${PROJECT_BINARY_DIR}/man/${command}.1" @ONLY)
    list(APPEND pages "${PROJECT_BINARY_DIR}/man/${command}.1")
  endforeach()
  add_custom_target(manual ALL DEPENDS ${made_pages})
  set(suffix "")
  if(VOUSSOIR_DEBIAN)  # whose manual pages are compressed
    find_program(GZIP gzip REQUIRED)
    set(suffix .gz)
    add_custom_command(TARGET manual POST_BUILD COMMAND "${GZIP}" -9nkf ${pages} VERBATIM)
  endif()
  list(TRANSFORM pages APPEND "${suffix}")
  install(FILES ${pages} DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program)
endif()
