# Finds the asked components of SUNDIALS by their headers and libraries. The package files that
# SUNDIALS installs ask for everything that it was configured with (PETSc, OpenMP, ...); this file
# asks only for components that are used.
# Gives SUNDIALS::<component> and SUNDIALS::SUNDIALS (all asked components), SUNDIALS_VERSION and
# SUNDIALS_FOUND.

find_path(SUNDIALS_INCLUDE_DIR sundials/sundials_config.h)
if(SUNDIALS_INCLUDE_DIR)
  file(STRINGS "${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h" line
       REGEX "define SUNDIALS_VERSION \"")
  string(REGEX REPLACE ".*\"([0-9.]+).*" "\\1" SUNDIALS_VERSION "${line}")
endif()

# From version 7 on the code that all components share is a library of its own.
set(sundials_parts ${SUNDIALS_FIND_COMPONENTS})
if(SUNDIALS_VERSION VERSION_GREATER_EQUAL 7)
  list(APPEND sundials_parts core)
endif()

set(sundials_required SUNDIALS_INCLUDE_DIR)
set(SUNDIALS_LIBRARIES "")
foreach(part ${sundials_parts})
  find_library(SUNDIALS_${part}_LIBRARY sundials_${part})
  list(APPEND sundials_required SUNDIALS_${part}_LIBRARY)
  list(APPEND SUNDIALS_LIBRARIES "${SUNDIALS_${part}_LIBRARY}")
endforeach()
mark_as_advanced(${sundials_required})

# From version 7 on the headers of a SUNDIALS that was built with MPI include mpi.h, and its null
# communicator is MPI's.
set(SUNDIALS_MPI "")
if(SUNDIALS_VERSION VERSION_GREATER_EQUAL 7)
  file(STRINGS "${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h" line
       REGEX "^#define SUNDIALS_MPI_ENABLED 1")
  if(line)
    set(MPI_C_SKIP_MPICXX ON)
    find_package(MPI COMPONENTS C QUIET)
    set(SUNDIALS_MPI MPI::MPI_C)
    list(APPEND sundials_required MPI_C_FOUND)
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SUNDIALS REQUIRED_VARS ${sundials_required}
                                  VERSION_VAR SUNDIALS_VERSION HANDLE_VERSION_RANGE)

if(SUNDIALS_FOUND AND NOT TARGET SUNDIALS::SUNDIALS)
  add_library(SUNDIALS::SUNDIALS INTERFACE IMPORTED)
  set_target_properties(SUNDIALS::SUNDIALS PROPERTIES
                        INTERFACE_INCLUDE_DIRECTORIES "${SUNDIALS_INCLUDE_DIR}"
                        INTERFACE_LINK_LIBRARIES "${SUNDIALS_LIBRARIES};${SUNDIALS_MPI}")
endif()
