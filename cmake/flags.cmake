# dvi_flags(TARGET): set the compiler's options that every source of this project gets.
# dvi_exports(TARGET MAP): let a shared library export the names of a version script alone, and
# refuse to link it with names that nobody defines, where the linker can.
#
# Results must not depend on the machine: no -march=native, no -ffast-math, and no fused
# multiply-adds that the compiler chooses. Warnings are errors only on request (DVI_WERROR, set in
# continuous integration), so that a newer compiler does not stop a user.

# Lanes of numbers become vectors with -O3 only, which neither a distribution's flags nor
# RelWithDebInfo ask for. Debug stays as it is, and so does a build whose flags ask for less than
# -O2, as with sanitizers.
set(DVI_FULLY_OPTIMISED "")
foreach(config ${CMAKE_CONFIGURATION_TYPES} ${CMAKE_BUILD_TYPE})
  string(TOUPPER "${config}" upper)
  if(NOT upper STREQUAL DEBUG AND NOT "${CMAKE_C_FLAGS} ${CMAKE_C_FLAGS_${upper}} " MATCHES
                                      "-O[01gsz] ")
    list(APPEND DVI_FULLY_OPTIMISED ${config})
  endif()
endforeach()
list(JOIN DVI_FULLY_OPTIMISED "," DVI_FULLY_OPTIMISED)

function(dvi_flags target)
  set_target_properties(${target} PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wpedantic -Wconversion
                                           -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla)
  if(DVI_FULLY_OPTIMISED)
    target_compile_options(${target} PRIVATE $<$<CONFIG:${DVI_FULLY_OPTIMISED}>:-O3>)
  endif()
  # Only gcc warns of promotions: clang 19 finds one in NAN and INFINITY, constants of type float.
  if(NOT CMAKE_C_COMPILER_ID MATCHES Clang)
    target_compile_options(${target} PRIVATE -Wdouble-promotion)
  endif()
  if(DVI_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(DVI_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${DVI_SANITIZE} -fno-sanitize-recover=all
                                             -fno-omit-frame-pointer)
    # Loops that are compiled for several instruction sets inline all their parts into each version,
    # and watched, such versions take clang up to half a minute. Calls do the same.
    target_compile_definitions(${target} PRIVATE always_inline=unused)
    target_link_options(${target} PRIVATE -fsanitize=${DVI_SANITIZE})
  endif()
endfunction()

# The script of the check has no name that the checked program lacks: lld would refuse it.
include(CheckLinkerFlag)
set(checked_script "${PROJECT_BINARY_DIR}/checked.map")
file(WRITE "${checked_script}" "CHECKED { global: main; local: *; };\n")
check_linker_flag(C "LINKER:--version-script=${checked_script}" DVI_LINKER_HAS_VERSION_SCRIPTS)
check_linker_flag(C "LINKER:--no-undefined" DVI_LINKER_HAS_NO_UNDEFINED)

function(dvi_exports target map)
  if(DVI_LINKER_HAS_VERSION_SCRIPTS)
    target_link_options(${target} PRIVATE "LINKER:--version-script=${map}")
    set_target_properties(${target} PROPERTIES LINK_DEPENDS "${map}")
  endif()
  # Sanitized libraries find the sanitizer's symbols in the program that loads them.
  if(DVI_LINKER_HAS_NO_UNDEFINED AND NOT DVI_SANITIZE)
    target_link_options(${target} PRIVATE "LINKER:--no-undefined")
  endif()
endfunction()
