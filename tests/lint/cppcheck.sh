#!/bin/sh
# cppcheck over the library and the apps.  Usage: cppcheck.sh TOP BUILD CPPCHECK
set -eu
cd "$1"
# The suppressed messages: system headers are not read. Callbacks have the signatures that their
# tables ask for, so an argument may be unused or could be const. Programs call public functions.
# Some branches are left undecided. Uninitialised variables are left to the compilers, the analyzer
# of clang and valgrind, because cppcheck reports every array that a callee fills. It does not know
# the size of the type of 113 bits in apps/mechanics/quad_step.c.
mkdir -p "$2/cppcheck"
exec "$3" -j 2 --quiet --std=c11 --language=c --enable=warning,style,performance,portability \
  --inline-suppr --error-exitcode=1 --cppcheck-build-dir="$2/cppcheck" \
  --suppress=missingIncludeSystem --suppress=unusedFunction \
  --suppress=constParameter --suppress=constParameterCallback --suppress=constParameterPointer \
  --suppress=constVariablePointer --suppress=unusedStructMember --suppress=uninitvar \
  --suppress=ctuArrayIndex:apps/mechanics/quad_step.c --suppress=redundantContinue \
  --suppress=shadowFunction --suppress=duplicateCondition \
  --suppress=normalCheckLevelMaxBranches --suppress=checkersReport \
  -I lib/include -I lib/src -I apps/problems lib/src lib/petsc apps
