# Finds ARPACK with its C interface.
# Gives ARPACK::ARPACK, and ARPACK_FOUND.

find_path(ARPACK_INCLUDE_DIR arpack/arpack.h)
find_library(ARPACK_LIBRARY arpack)
mark_as_advanced(ARPACK_INCLUDE_DIR ARPACK_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ARPACK REQUIRED_VARS ARPACK_INCLUDE_DIR ARPACK_LIBRARY)

if(ARPACK_FOUND AND NOT TARGET ARPACK::ARPACK)
  add_library(ARPACK::ARPACK INTERFACE IMPORTED)
  set_target_properties(
    ARPACK::ARPACK PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${ARPACK_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${ARPACK_LIBRARY}")
endif()
