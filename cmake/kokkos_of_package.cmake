# `pip install .` finds a Kokkos (Kokkos_ROOT, or .prefix of tools/setup), or has tools/setup build one, which takes one to
# two minutes and a connection to a registry of Python packages.
find_package(Kokkos 4.4 QUIET)
if(NOT Kokkos_FOUND)
  message(STATUS "There is no Kokkos 4.4 or newer: tools/setup --kokkos builds one")
  execute_process(COMMAND bash "${PROJECT_SOURCE_DIR}/tools/setup" --kokkos RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "Kokkos was not found, and tools/setup --kokkos could not build it. Set Kokkos_ROOT to the folder "
                        "of a Kokkos 4.4 or newer that is compiled with -DCMAKE_POSITION_INDEPENDENT_CODE=ON and "
                        "-DKokkos_ENABLE_OPENMP=ON.")
  endif()
endif()
