# Installation: headers, the libraries, the command, its manual pages and completions, and the files
# that find_package and pkg-config read.

include(CMakePackageConfigHelpers)
set(package_directory "${CMAKE_INSTALL_LIBDIR}/cmake/dvi")

install(DIRECTORY lib/include/dvi DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(TARGETS dvi dvi_scene dvi_study EXPORT dviTargets)
# Programs do not link this one, libdvi loads it.
install(TARGETS dvi_sundials LIBRARY NAMELINK_SKIP)
install(TARGETS dvi_static EXPORT dviStaticTargets)
if(TARGET dvi_petsc)
  install(DIRECTORY lib/petsc/include/dvi DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(TARGETS dvi_petsc EXPORT dviPetscTargets)
  set_target_properties(dvi_petsc PROPERTIES INSTALL_RPATH "$ORIGIN"
                                             INSTALL_RPATH_USE_LINK_PATH ON)
endif()
set_target_properties(dvi dvi_scene dvi_study PROPERTIES INSTALL_RPATH "$ORIGIN")
# Libraries from a prefix are found after the installation, too.
set_target_properties(dvi dvi_sundials PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
if(TARGET dvi_command)
  file(RELATIVE_PATH to_libraries "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set_target_properties(
    dvi_command PROPERTIES INSTALL_RPATH "$ORIGIN/${to_libraries};$ORIGIN/${to_libraries}/dvi"
                           INSTALL_RPATH_USE_LINK_PATH ON)
  install(TARGETS dvi_command)
endif()
if(TARGET dvi_hdf5)
  install(TARGETS dvi_hdf5 DESTINATION "${CMAKE_INSTALL_LIBDIR}/dvi")
endif()
if(TARGET dvi_petsc_module)
  set_target_properties(dvi_petsc_module PROPERTIES INSTALL_RPATH "$ORIGIN/.."
                                                    INSTALL_RPATH_USE_LINK_PATH ON)
  install(TARGETS dvi_petsc_module DESTINATION "${CMAKE_INSTALL_LIBDIR}/dvi")
endif()
file(GLOB scenes CONFIGURE_DEPENDS apps/scenes/*.yaml apps/scenes/*/*.yaml)
install(FILES ${scenes} DESTINATION "${CMAKE_INSTALL_DATADIR}/dvi/scenes")
# The pages keep their folders, and everything that they link to is installed with them.
install(FILES README.md CHANGELOG.md LICENSE LICENSES/MIT.txt
        DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}"
        FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png" PATTERN "*.bib")
install(DIRECTORY apps/examples apps/problems apps/scenes DESTINATION "${CMAKE_INSTALL_DOCDIR}/apps"
        PATTERN "CMakeLists.txt" EXCLUDE)
install(DIRECTORY python/notebooks DESTINATION "${CMAKE_INSTALL_DOCDIR}/python"
        FILES_MATCHING PATTERN "*.ipynb" PATTERN "*.md" PATTERN "*.yaml")
# Manual pages and completions are made from what the command prints for --help.
if(TARGET dvi_command AND NOT CMAKE_CROSSCOMPILING)
  set(from_help "${PROJECT_BINARY_DIR}/from_help")
  set(DVI_ZSH_COMPLETIONS "${CMAKE_INSTALL_DATADIR}/zsh/site-functions"
      CACHE STRING "Folder of zsh's completions")
  add_custom_command(
    OUTPUT "${from_help}/zsh/_dvi"
    COMMAND sh "${PROJECT_SOURCE_DIR}/cmake/from_help.sh" $<TARGET_FILE:dvi_command> "${from_help}"
    DEPENDS dvi_command cmake/from_help.sh cmake/manual.awk cmake/completions.awk
    COMMENT "Making manual pages and completions" VERBATIM)
  add_custom_target(dvi_from_help ALL DEPENDS "${from_help}/zsh/_dvi")
  install(DIRECTORY "${from_help}/man1" DESTINATION "${CMAKE_INSTALL_MANDIR}")
  install(FILES "${from_help}/bash/dvi"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
  install(FILES "${from_help}/zsh/_dvi" DESTINATION "${DVI_ZSH_COMPLETIONS}")
endif()

# A program that links the static library needs SUNDIALS and SuiteSparse; the shared library brings
# them along. With several export sets only projects that ask for the component `static` must have
# them, and only those that ask for `petsc` MPI.
install(EXPORT dviTargets NAMESPACE dvi:: DESTINATION "${package_directory}")
install(EXPORT dviStaticTargets NAMESPACE dvi:: DESTINATION "${package_directory}")
if(TARGET dvi_petsc)
  install(EXPORT dviPetscTargets NAMESPACE dvi:: DESTINATION "${package_directory}")
endif()
install(FILES cmake/FindSUNDIALS.cmake cmake/FindSuiteSparse.cmake cmake/FindARPACK.cmake
        DESTINATION "${package_directory}")
configure_package_config_file(
  cmake/dviConfig.cmake.in dviConfig.cmake INSTALL_DESTINATION "${package_directory}"
  NO_SET_AND_CHECK_MACRO)
# Before version 1.0 a new minor version may change the interface.
write_basic_package_version_file(dviConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/dviConfig.cmake" "${PROJECT_BINARY_DIR}/dviConfigVersion.cmake"
        DESTINATION "${package_directory}")

# pkg-config names libraries as the linker does.
set(pc_private "")
foreach(library ${SUNDIALS_LIBRARIES} ${SuiteSparse_LIBRARIES} ${ARPACK_LIBRARY}
                ${LAPACK_LIBRARIES} ${MPI_C_LIBRARIES} ${CMAKE_THREAD_LIBS_INIT} m)
  get_filename_component(name "${library}" NAME_WE)
  string(REGEX REPLACE "^(lib|-l)" "" name "${name}")
  list(APPEND pc_private "-l${name}")
endforeach()
list(REMOVE_DUPLICATES pc_private)
list(JOIN pc_private " " pc_private)
file(RELATIVE_PATH pc_prefix "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" pc_prefix "${pc_prefix}")
configure_file(cmake/dvi.pc.in dvi.pc @ONLY)
configure_file(cmake/dvi-scene.pc.in dvi-scene.pc @ONLY)
configure_file(cmake/dvi-study.pc.in dvi-study.pc @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/dvi.pc" "${PROJECT_BINARY_DIR}/dvi-scene.pc"
              "${PROJECT_BINARY_DIR}/dvi-study.pc"
        DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
if(TARGET dvi_petsc)
  configure_file(cmake/dvi-petsc.pc.in dvi-petsc.pc @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/dvi-petsc.pc"
          DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endif()
