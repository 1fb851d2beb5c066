# Which room may include which, and what the library leaves to others.  Usage: awk -f layers.awk [-v methods="a b"] FILE...   Paths are relative to the top of the tree.
# Prints every breach and exits 1 if there is one.

BEGIN {
  # Rooms of lib/src that a room may look into, besides itself.
  sees["core"] = ""
  sees["num"] = "core"
  sees["group"] = "core num"
  sees["space"] = "core num"
  sees["group"] = "core num"
  sees["system"] = "core num group"
  sees["solve"] = "core num"
  sees["action"] = "core num group space system"
  sees["method"] = "core num group space system action solve"
  sees["path"] = "core num group space system action solve method"
  sees["diagnostics"] = "core num system"
  sees["reference"] = "core num system"
  sees["scene"] = "" # a library of its own, beside libdvi's public headers
  # Single headers that are open to a room beyond that.
  also["reference solve/sundials_compat.h"] = 1
  # Standard headers that a public header may need.
  split("math.h stdarg.h stddef.h", open_headers)
  for (i in open_headers) standard[open_headers[i]] = 1
  count = split(methods, names, " ")
  for (i = 1; i <= count; i++) method["method/" names[i] ".h"] = 1
}

function breach(why) { printf "%s:%d: %s: %s\n", FILENAME, FNR, why, $0; failed = 1 }

function part_of_sundials(header) { return header ~ /^(sundials|kinsol|ida|idas|cvode|cvodes|arkode|nvector|sunlinsol|sunmatrix|sunnonlinsol)\// }

function part_of_suitesparse(header) { return header ~ /^(suitesparse\/)?(klu|amd|colamd|btf|SuiteSparse_config)\.h$/ }

function check_library(quoted, header,   target) {
  if (!quoted) {
    if (part_of_sundials(header) && room != "solve" && room != "reference") breach("SUNDIALS belongs to solve/ and reference/")
    if (header ~ /^gsl\//) breach("GSL is under the GPL, and not for the library")
    if (part_of_suitesparse(header) && room != "num" && room != "reference") breach("KLU belongs to num/ and reference/")
    return
  }
  if (header !~ /^[a-z]+\/[a-z_0-9]+\.(h|def)$/) { breach("write \"room/file.h\""); return }
  target = header
  sub(/\/.*/, "", target)
  if (header in method) breach("methods never include each other")
  if (target == room || (room " " header) in also) return
  if (index(" " sees[room] " ", " " target " ") == 0) breach(room "/ may not see " target "/")
}

function check_public(quoted, header) {
  if (quoted || (header !~ /^dvi\// && !(header in standard))) breach("a public header includes only <dvi/...>, <math.h>, <stdarg.h> and <stddef.h>")
}

# The command, the problems and the examples are users of the library.
function check_user(quoted, header) {
  if (part_of_sundials(header) || part_of_suitesparse(header)) breach("apps/ reach the solvers through the library")
  if (quoted && header ~ /\//) breach("apps/ include public headers and their own folder only")
}

FNR == 1 {
  room = FILENAME
  zone = "other"
  if (sub(/^lib\/src\//, "", room)) { zone = "library"; sub(/\/.*/, "", room); if (!(room in sees)) { breach("unknown room " room) } }
  else if (FILENAME ~ /^lib\/include\//) zone = "public"
  else if (FILENAME ~ /^apps\//) zone = "user"
}

/^[ \t]*#[ \t]*include/ {
  header = $0
  sub(/^[ \t]*#[ \t]*include[ \t]*/, "", header)
  quoted = header ~ /^"/
  sub(/^["<]/, "", header)
  sub(/[">].*/, "", header)
  if (zone == "library") check_library(quoted, header)
  if (zone == "public") check_public(quoted, header)
  if (zone == "user") check_user(quoted, header)
}

# What stands in quotes is text: the library writes C, too.
zone == "library" {
  code = $0
  gsub(/"([^"\\]|\\.)*"/, "\"\"", code)
  if (code ~ /(^|[^A-Za-z0-9_])(printf|puts|putchar|exit|abort|assert)\(|std(out|err)/) breach("the library never prints, exits or aborts")
}
# A program may have set a locale with a decimal comma.
FILENAME != "lib/src/core/number.c" && (zone == "library" && /[^A-Za-z0-9_]vsnprintf\(/ || (zone == "library" || zone == "user") && /[^A-Za-z0-9_](strtod|strtof|strtold|atof|setlocale)\(/) {
  breach("numbers are read and written by dvi/number.h, the same in every locale")
}
# Scenes are a library of their own, with a door of their own.
zone == "library" && FILENAME != "lib/src/core/memory.c" && FILENAME != "lib/src/scene/heap.c" && /(^|[^A-Za-z0-9_])(malloc|calloc|realloc|strdup)\(/ {
  breach("the heap is behind core/memory.h, and scene/heap.h")
}
# SUNDIALS hands over some strings that are to be freed.
zone == "library" && FILENAME != "lib/src/core/memory.c" && FILENAME != "lib/src/scene/heap.c" && room != "solve" && room != "reference" && /(^|[^A-Za-z0-9_])free\(/ {
  breach("the heap is behind core/memory.h, and scene/heap.h")
}
zone == "user" && /dvi__/ { breach("apps/ may not use internal names") }
zone == "public" && /dvi__/ { breach("internal name in a public header") }

END { exit failed }
