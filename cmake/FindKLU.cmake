# Finds KLU and LDL of SuiteSparse by their headers and libraries: SuiteSparse has a CMake package
# only from version 7 on.
# Gives KLU::KLU, and KLU_FOUND.

find_path(KLU_INCLUDE_DIR klu.h PATH_SUFFIXES suitesparse)
set(klu_required KLU_INCLUDE_DIR)
set(KLU_LIBRARIES "")
foreach(part klu ldl amd colamd btf suitesparseconfig)
  string(TOUPPER ${part} upper)
  find_library(KLU_${upper}_LIBRARY ${part})
  list(APPEND klu_required KLU_${upper}_LIBRARY)
  list(APPEND KLU_LIBRARIES "${KLU_${upper}_LIBRARY}")
endforeach()
mark_as_advanced(${klu_required})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(KLU REQUIRED_VARS ${klu_required})

if(KLU_FOUND AND NOT TARGET KLU::KLU)
  add_library(KLU::KLU INTERFACE IMPORTED)
  set_target_properties(KLU::KLU PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${KLU_INCLUDE_DIR}"
                                            INTERFACE_LINK_LIBRARIES "${KLU_LIBRARIES}")
endif()
