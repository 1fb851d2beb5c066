#!/bin/sh
# Runs an awk script over all C sources.  Usage: sources.sh TOP SCRIPT [METHODS]
set -u
cd "$1" || exit 1
find lib apps tests -type f -name '*.[ch]' -exec awk -v methods="${3:-}" -f "$2" {} +
