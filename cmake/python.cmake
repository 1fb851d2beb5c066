# Find a Python with cffi, numpy, pytest and setuptools, and build the package for it: that of the
# path or, beside one installed by hand, that of the system. Without one there is no package.

if(NOT Python3_EXECUTABLE)
  find_program(python_of_path python3)
  foreach(candidate "${python_of_path}" /usr/bin/python3)
    execute_process(COMMAND "${candidate}" -c "import cffi, numpy, pytest, setuptools"
                    RESULT_VARIABLE lacks OUTPUT_QUIET ERROR_QUIET)
    if(lacks STREQUAL 0)
      set(Python3_EXECUTABLE "${candidate}" CACHE FILEPATH "Python of the package dvi")
      break()
    endif()
  endforeach()
endif()
if(Python3_EXECUTABLE)
  find_package(Python3 COMPONENTS Interpreter Development.Module)
endif()
if(Python3_FOUND)
  add_subdirectory(python)
else()
  message(STATUS "No Python package: no python3 has headers, cffi, numpy, pytest and setuptools")
endif()
