#!/bin/sh
# Runs text.awk over the sources: C, shell, awk and CMake.  Usage: text.sh TOP
set -u
lint=$(cd "$(dirname "$0")" && pwd)
cd "$1" || exit 1
find lib apps tests cmake .ci CMakeLists.txt -type f \( -name '*.[ch]' -o -name '*.sh' \
  -o -name '*.awk' -o -name '*.cmake' -o -name CMakeLists.txt -o -path .ci/run \) \
  -exec awk -f "$lint/text.awk" {} +
