# Finds the reentrant library of qhull.
# Gives Qhull::Qhull, and Qhull_FOUND.

find_path(Qhull_INCLUDE_DIR libqhull_r/qhull_ra.h)
find_library(Qhull_LIBRARY qhull_r)
mark_as_advanced(Qhull_INCLUDE_DIR Qhull_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Qhull REQUIRED_VARS Qhull_INCLUDE_DIR Qhull_LIBRARY)

if(Qhull_FOUND AND NOT TARGET Qhull::Qhull)
  add_library(Qhull::Qhull INTERFACE IMPORTED)
  set_target_properties(
    Qhull::Qhull PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Qhull_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${Qhull_LIBRARY}")
endif()
