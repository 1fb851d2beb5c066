#!/bin/sh
# Runs markdown.awk over the pages. Those of docs/scene-errors.md are the messages of the sources,
# one a line.
# Usage: markdown.sh TOP
set -u
lint=$(cd "$(dirname "$0")" && pwd)
cd "$1" || exit 1
find ./*.md docs -name '*.md' ! -name scene-errors.md -exec awk -f "$lint/markdown.awk" {} +
