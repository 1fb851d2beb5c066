#!/bin/sh
# The sources are laid out as .clang-format says. Other major versions lay out differently, so only
# version 14 decides. Exit code 77 means that the test was skipped.
# Usage: format.sh TOP [CLANG_FORMAT]
set -u
cd "$1" || exit 1
tool=${2:-}
case $tool in '' | *NOTFOUND) echo "no clang-format: skipped"; exit 77 ;; esac
version=$("$tool" --version)
case $version in *'version 14.'*) ;; *) echo "$version: not 14, skipped"; exit 77 ;; esac
find lib apps tests -name '*.[ch]' -exec "$tool" --dry-run -Werror --ferror-limit=3 {} + || {
  echo "lay these files out anew by: clang-format -i FILE..."
  exit 1
}
