# dvi_flags(TARGET): set the compiler's options that every source of this project gets.
#
# Results must not depend on the machine: no -march=native, no -ffast-math, and no fused
# multiply-adds that the compiler chooses. Warnings are errors only on request (DVI_WERROR, set in
# continuous integration), so that a newer compiler does not stop a user.

set(CMAKE_C_FLAGS_RELEASE "-O3 -DNDEBUG" CACHE STRING "Flags of a Release build")

function(dvi_flags target)
  set_target_properties(${target} PROPERTIES C_STANDARD 11 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wpedantic -Wconversion
                                           -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla)
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
