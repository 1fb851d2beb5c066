# Finds KLU and LDL by their headers and libraries: SuiteSparse has CMake packages only
# from version 7 on.
# Gives SuiteSparse::SuiteSparse, and SuiteSparse_FOUND.

find_path(SuiteSparse_INCLUDE_DIR klu.h PATH_SUFFIXES suitesparse)
set(suitesparse_required SuiteSparse_INCLUDE_DIR)
set(SuiteSparse_LIBRARIES "")
foreach(part klu ldl amd colamd btf suitesparseconfig)
  string(TOUPPER ${part} upper)
  find_library(SuiteSparse_${upper}_LIBRARY ${part})
  list(APPEND suitesparse_required SuiteSparse_${upper}_LIBRARY)
  list(APPEND SuiteSparse_LIBRARIES "${SuiteSparse_${upper}_LIBRARY}")
endforeach()
mark_as_advanced(${suitesparse_required})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS ${suitesparse_required})

if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::SuiteSparse)
  add_library(SuiteSparse::SuiteSparse INTERFACE IMPORTED)
  set_target_properties(
    SuiteSparse::SuiteSparse PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${SuiteSparse_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${SuiteSparse_LIBRARIES}")
endif()
