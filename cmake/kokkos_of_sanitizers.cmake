# With sanitizers the rooms are shared libraries. A test program would otherwise hold 200 MB of instrumented code, and some
# ninety of them 12 GB. A static Kokkos becomes a shared library as well, because each room would otherwise hold a copy of
# its own, and each copy would construct the same static objects.
set(BUILD_SHARED_LIBS ON)
get_target_property(kokkos_type Kokkos::kokkoscore TYPE)
if(NOT kokkos_type STREQUAL STATIC_LIBRARY)
  target_link_libraries(voussoir_kokkos INTERFACE Kokkos::kokkos)
  return()
endif()

file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/kokkos.cpp" CONTENT "// The library is made of the archives of Kokkos.\n")
add_library(voussoir_shared_kokkos SHARED "${PROJECT_BINARY_DIR}/kokkos.cpp")
set(archives Kokkos::kokkoscore Kokkos::kokkoscontainers Kokkos::kokkossimd)
list(TRANSFORM archives REPLACE "(.+)" "$<TARGET_FILE:\\1>")
list(JOIN archives "," archives)
target_link_libraries(voussoir_shared_kokkos PRIVATE "$<LINK_LIBRARY:WHOLE_ARCHIVE,${archives}>" ${CMAKE_DL_LIBS})
target_link_libraries(voussoir_kokkos INTERFACE voussoir_shared_kokkos)
foreach(property COMPILE_DEFINITIONS COMPILE_FEATURES COMPILE_OPTIONS)
  set_property(TARGET voussoir_kokkos PROPERTY INTERFACE_${property} $<TARGET_PROPERTY:Kokkos::kokkos,INTERFACE_${property}>)
endforeach()
target_include_directories(voussoir_kokkos SYSTEM INTERFACE
                           $<TARGET_PROPERTY:Kokkos::kokkos,INTERFACE_INCLUDE_DIRECTORIES>)
