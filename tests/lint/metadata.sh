#!/bin/sh
# What names the project for others agrees with it: REUSE.toml covers all files with the one
# licence, and CITATION.cff, debian/changelog and the recipes have the version of the header.
# Usage: metadata.sh TOP
set -u
cd "$1" || exit 1
rc=0
fail() { echo "$*"; rc=1; }

version=$(sed -n 's/^#define DVI_VERSION_[A-Z]* \([0-9]*\)$/\1/p' lib/include/dvi/version.h |
  paste -s -d . -)
# has FILE LINE: require a line that is exactly this.
has() { grep -q -x -F -e "$2" "$1" || fail "$1: no line '$2'"; }
has CITATION.cff "version: $version"
has CITATION.cff 'license: BSD-3-Clause'
for recipe in packaging/spack/*/package.py; do
  has "$recipe" "    version(\"$version\")"
done
for recipe in packaging/conda/*/meta.yaml; do
  has "$recipe" "{% set version = \"$version\" %}"
done
has packaging/spack/py_dvi/package.py \
  "    depends_on(\"libdvi@$version\", type=(\"build\", \"link\", \"run\"))"
head -n 1 debian/changelog | grep -q -F "libdvi ($version-" ||
  fail "debian/changelog: the first entry is not of $version"
abi=${version%.*}
grep -q -x -F "Package: libdvi$abi" debian/control || fail "debian/control: no libdvi$abi"
[ -e "debian/libdvi$abi.install" ] || fail "debian/libdvi$abi.install is missing"

has REUSE.toml 'path = "**"'
has REUSE.toml 'SPDX-License-Identifier = "BSD-3-Clause"'
cmp LICENSE LICENSES/BSD-3-Clause.txt || fail 'LICENSES has another text than LICENSE'
for text in LICENSES/*.txt; do
  name=$(basename "$text" .txt)
  grep -q -e "^SPDX-License-Identifier = .*$name" REUSE.toml || fail "REUSE.toml: no file has $name"
done
exit $rc
