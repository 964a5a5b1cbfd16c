# The instruction sets for which the lanes are compiled. VOUSSOIR_ISA names them:
#   native   what this processor takes (default)
#   all      v3 and v4
#   a list of v3 and v4; or scalar, for none of them
# The plain set, of the flags that all other code has, is always there. Those are the flags of the baseline of x86-64,
# unless Kokkos or CMAKE_CXX_FLAGS asks for a certain processor. The result:
#   voussoir_wide_sets   of v3 and v4 those that are compiled besides the plain one
#   voussoir_own_set     the largest of them that this processor takes; plain where there is none
include(CheckCXXCompilerFlag)
include(CheckCXXSourceCompiles)

set(VOUSSOIR_ISA native CACHE STRING "Instruction sets of the lanes besides the scalar one: native, all, or a list of v3 and v4")

set(voussoir_v3_macros __AVX2__ __FMA__ __BMI2__ __LZCNT__ __MOVBE__ __F16C__)
set(voussoir_v4_macros ${voussoir_v3_macros} __AVX512F__ __AVX512BW__ __AVX512CD__ __AVX512DQ__ __AVX512VL__)

# Sets `result` to whether the compiler defines all `macros` with the flags `flags` and those of `libraries`.
function(voussoir_flags_define result flags libraries)
  set(CMAKE_REQUIRED_QUIET ON)
  set(CMAKE_REQUIRED_FLAGS "${flags}")
  set(CMAKE_REQUIRED_LIBRARIES ${libraries})
  list(TRANSFORM ARGN REPLACE "(.+)" "!defined(\\1)" OUTPUT_VARIABLE missing)
  list(JOIN missing " || " missing)
  check_cxx_source_compiles("#if ${missing}\n#error\n#endif\nint main() { return 0; }" ${result})
endfunction()

# Kokkos' flags may change with another Kokkos in the same build tree, so that this question is asked anew each time.
unset(voussoir_plain_is_special CACHE)
set(voussoir_wide_sets "")
set(voussoir_own_set plain)

function(voussoir_find_sets)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    message(STATUS "Lanes: one RVE at a time; wide instruction sets are known for x86-64 only")
    return()
  endif()
  voussoir_flags_define(voussoir_plain_is_special "" Kokkos::kokkos __SSE3__)
  if(voussoir_plain_is_special)
    set(hint "")
    if(Kokkos_DIR MATCHES "^${PROJECT_SOURCE_DIR}/.prefix/")
      set(hint " tools/setup builds a Kokkos without such flags.")
    endif()
    message(WARNING "The flags of Kokkos in ${Kokkos_DIR} (or CMAKE_CXX_FLAGS) are for certain processors only. The "
                    "program will run only on processors that have all their instructions, and it holds the one set "
                    "of lanes that these flags give.${hint}")
    if(NOT VOUSSOIR_ISA STREQUAL native)
      message(FATAL_ERROR "VOUSSOIR_ISA=${VOUSSOIR_ISA} needs a Kokkos without flags for certain processors")
    endif()
    return()
  endif()
  if(Kokkos_ENABLE_CUDA)
    message(STATUS "Lanes: one RVE at a time; wide lanes are not compiled by nvcc")
    return()
  endif()
  voussoir_flags_define(voussoir_native_is_v3 -march=native "" ${voussoir_v3_macros})
  voussoir_flags_define(voussoir_native_is_v4 -march=native "" ${voussoir_v4_macros})
  set(takes "")
  if(voussoir_native_is_v3)
    list(APPEND takes v3)
  endif()
  if(voussoir_native_is_v4)
    list(APPEND takes v4)
  endif()
  if(VOUSSOIR_ISA STREQUAL native)
    set(sets "")
    if(takes)
      list(GET takes -1 sets)  # the largest
    endif()
  elseif(VOUSSOIR_ISA STREQUAL all)
    set(sets v3 v4)
  elseif(VOUSSOIR_ISA STREQUAL scalar)
    set(sets "")
  else()
    set(sets ${VOUSSOIR_ISA})
  endif()
  set(own plain)
  foreach(set IN LISTS sets)
    if(NOT set MATCHES "^v[34]$")
      message(FATAL_ERROR "VOUSSOIR_ISA=${VOUSSOIR_ISA}: ${set} is not native, all, scalar, or a list of v3 and v4")
    endif()
    check_cxx_compiler_flag(-march=x86-64-${set} voussoir_knows_${set})
    if(NOT voussoir_knows_${set})
      message(FATAL_ERROR "The compiler does not know x86-64-${set}; VOUSSOIR_ISA=scalar does without")
    endif()
    if(set IN_LIST takes)
      set(own ${set})
    endif()
  endforeach()
  message(STATUS "Lanes: scalar ${sets} (VOUSSOIR_ISA=${VOUSSOIR_ISA})")
  set(voussoir_wide_sets "${sets}" PARENT_SCOPE)
  set(voussoir_own_set ${own} PARENT_SCOPE)
endfunction()
voussoir_find_sets()

# Gives a target the flags of a set. Kokkos' own header of its configuration knows no wide instructions, since they are
# not its own flags; its SIMD types ask for these macros.
function(voussoir_set_flags target scope set)
  target_compile_definitions(${target} ${scope} VOUSSOIR_LANES=${set})
  if(set STREQUAL v4)
    target_compile_options(${target} ${scope} -march=x86-64-v4)
    target_compile_definitions(${target} ${scope} KOKKOS_ARCH_AVX512XEON)
  elseif(set STREQUAL v3)
    target_compile_options(${target} ${scope} -march=x86-64-v3)
    target_compile_definitions(${target} ${scope} KOKKOS_ARCH_AVX2)
  endif()
endfunction()

# GNU ld is needed to join the objects of a set, whichever linker makes the programs.
if(voussoir_wide_sets)
  execute_process(COMMAND "${CMAKE_LINKER}" --help OUTPUT_VARIABLE help ERROR_QUIET)
  if(help MATCHES "force-group-allocation")
    set(voussoir_joining_linker "${CMAKE_LINKER}")
  else()
    find_program(voussoir_joining_linker ld.bfd)
  endif()
  if(NOT voussoir_joining_linker OR NOT CMAKE_OBJCOPY)
    message(FATAL_ERROR "Wide sets of lanes need GNU ld and objcopy (binutils 2.29 or newer); VOUSSOIR_ISA=scalar does without")
  endif()
endif()

# Compiles the sources for a set into an object of their own and adds it to voussoir_kernels. All names in this object
# but that of its LaneSet are made local: the inline functions in it, compiled for wide instructions, would otherwise
# compete with the same functions in other objects, and the linker keeps whichever it meets first.
# `--force-group-allocation` makes ordinary functions of inline ones, which could not become local otherwise. The code gets
# a section of its own, by which tests/regression/instruction_sets_test.py tells it from all other code. The constructors of
# static objects (Kokkos' headers have some) must not run before main on a processor without the instructions; they are
# gathered between two symbols, and the set runs them when it is chosen (advance_lanes.cpp). Functions that the set would
# run at the program's end (only sanitizers have some) are not run. The addresses 0 make the
# symbols' values those within their section.
function(voussoir_add_wide_set set)
  add_library(voussoir_lanes_${set} OBJECT ${ARGN})
  set_target_properties(voussoir_lanes_${set} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  target_link_libraries(voussoir_lanes_${set} PRIVATE voussoir_flags voussoir_kernel_flags Kokkos::kokkos)
  # Without the last option g++ lets the whole program share the static objects of inline functions by their names.
  target_compile_options(voussoir_lanes_${set} PRIVATE -fno-signed-zeros $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  target_compile_definitions(voussoir_lanes_${set} PRIVATE VOUSSOIR_JOINED)
  voussoir_set_flags(voussoir_lanes_${set} PRIVATE ${set})

  set(object "${CMAKE_CURRENT_BINARY_DIR}/lanes_${set}.o")
  set(script "${CMAKE_CURRENT_BINARY_DIR}/lanes_${set}.ld")
  file(CONFIGURE OUTPUT "${script}" CONTENT
"SECTIONS {
  lanes_@set@ 0 : { *(.text .text.*) }
  lanes_@set@_starts 0 : { voussoir_starts = .; *(.init_array .init_array.*); voussoir_starts_end = .; }
  lanes_@set@_ends 0 : { *(.fini_array .fini_array.*) }
}
" @ONLY)
  add_custom_command(OUTPUT "${object}"
    COMMAND "${voussoir_joining_linker}" -r --force-group-allocation -T "${script}" -o "${object}.joined"
            $<TARGET_OBJECTS:voussoir_lanes_${set}>
    COMMAND "${CMAKE_OBJCOPY}" --keep-global-symbol=voussoir_lanes_${set} "${object}.joined" "${object}"
    DEPENDS $<TARGET_OBJECTS:voussoir_lanes_${set}> "${script}"
    COMMAND_EXPAND_LISTS VERBATIM COMMENT "Joining the lanes for ${set}")
  target_sources(voussoir_kernels PRIVATE "${object}")
  set_source_files_properties("${object}" PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set_property(GLOBAL APPEND PROPERTY voussoir_joined_lanes "${object}")  # for a library that is made of these objects, too
  string(TOUPPER ${set} upper)
  target_compile_definitions(voussoir_kernels PRIVATE VOUSSOIR_HAS_${upper})
endfunction()
