# Which room may include which, and what the library leaves to others.  Usage: awk -f layers.awk [-v methods="a b"] FILE...   Paths are relative to the top of the tree.
# Prints every breach and exits 1 if there is one.

BEGIN {
  # Rooms of lib/src that a room may look into, besides itself; a room without its sub-room's name stands for all of them.
  sees["core"] = ""
  sees["num/simd"] = "core"
  sees["num"] = "core num/simd"
  sees["group"] = "core num"
  sees["space"] = "core num"
  sees["solve"] = "core num"
  sees["system"] = "core num group"
  sees["system/term"] = "core num system"
  sees["system/evaluate"] = "core num system system/term"
  sees["system/dynamics"] = "core num system system/term system/evaluate"
  sees["system/chart"] = "core num group system system/evaluate"
  sees["system/rescale"] = "core num system system/evaluate system/term"
  sees["system/check"] = "core num system system/evaluate system/term"
  sees["system/declare"] = "core num group system system/term system/evaluate system/chart system/rescale"
  sees["step"] = "core num system"
  sees["step/element"] = "core num group space system step"
  sees["step/onestep"] = "core num space system step"
  sees["step/degenerate"] = "core num system step step/onestep"
  sees["step/hamiltonian"] = "core num space system step step/element step/onestep"
  sees["step/split"] = "core num group system step"
  sees["step/lie"] = "core num group system step step/split"
  sees["method"] = "core num solve system step/element"
  sees["method/element"] = sees["method"] " space method"
  sees["method/degenerate"] = sees["method"] " method method/element step/degenerate"
  sees["method/hamiltonian"] = sees["method/degenerate"] " method/degenerate step/hamiltonian"
  sees["method/lie"] = sees["method"] " method method/element step/lie"
  sees["method/shooting"] = sees["method"] " method space step/onestep"
  sees["method/split"] = sees["method"] " method method/element space step/split"
  sees["march"] = "core"
  sees["integrator"] = "core march num space solve system method"
  sees["boundary"] = "core num solve system step/element method/element"
  sees["diagnostics"] = "core num system"
  sees["reference"] = "core num system"
  # A library of its own, beside libdvi's public headers.
  sees["text"] = ""
  sees["expr"] = "text"
  sees["expr/compile"] = "text expr"
  sees["expr/function"] = "text expr expr/compile"
  sees["scene/text"] = "text"
  sees["scene/elaborate"] = "text expr expr/compile expr/function scene/text"
  sees["scene/terms"] = sees["scene/elaborate"] " scene/elaborate"
  sees["scene/sections"] = sees["scene/terms"] " scene/terms"
  sees["scene"] = sees["scene/sections"] " scene/sections"
  sees["scene/emit"] = sees["scene"] " scene"
  # The command, on public headers and those of the problems.
  uses["cli"] = ""
  uses["csv"] = "cli"
  uses["load"] = "cli"
  uses["plot"] = "cli csv"
  uses["sweep"] = "cli csv load"
  uses["study"] = "cli csv plot"
  uses["mechanics"] = uses["study"] " study load"
  uses["watch"] = uses["bench"] = uses["mechanics"] " mechanics"
  uses["cmd"] = uses["watch"] " watch bench sweep"
  uses["main.c"] = "cli bench"
  # Single headers that are open to a room beyond that.
  also["reference solve/sundials_compat.h"] = 1
  # What libdvi shares with sister libraries (lib/exports.map, DVI_PRIVATE).
  also["text core/memory.h"] = also["expr/compile num/simd/lanes.h"] = 1
  # Standard headers that a public header may need.
  split("math.h stdarg.h stddef.h", open_headers)
  for (i in open_headers) standard[open_headers[i]] = 1
  count = split(methods, names, " ")
  for (i = 1; i <= count; i++) method[names[i] ".h"] = 1
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
  if (header !~ /^[a-z]+\/([a-z]+\/)?[a-z_0-9]+\.(h|def)$/) { breach("write \"room/file.h\""); return }
  target = file = header
  sub(/\/[^\/]*$/, "", target)
  sub(/.*\//, "", file)
  if (target ~ /^method/ && file in method) breach("methods never include each other")
  if (target == room || (room " " header) in also || is_seen(target)) return
  breach(room "/ may not see " target "/")
}

# A room, or the one that it is a part of.
function is_seen(target,   whole) {
  whole = target
  sub(/\/.*/, "", whole)
  return index(" " sees[room] " ", " " target " ") > 0 || (whole != hall && index(" " sees[room] " ", " " whole " ") > 0)
}

function check_public(quoted, header) {
  if (quoted || (header !~ /^dvi\// && !(header in standard))) breach("a public header includes only <dvi/...>, <math.h>, <stdarg.h> and <stddef.h>")
}

# The command, the problems and the examples are users of the library.
function check_user(quoted, header,   target) {
  if (part_of_sundials(header) || part_of_suitesparse(header)) breach("apps/ reach the solvers through the library")
  if (!quoted || header !~ /\//) return
  target = header
  sub(/\/.*/, "", target)
  if (target == room || index(" " uses[room] " ", " " target " ") > 0) return
  if (room == "problems" && target ~ /^(bodies|degenerate)$/) return
  breach("apps/" room " may not see apps/" target)
}

FNR == 1 {
  room = FILENAME
  zone = "other"
  if (sub(/^lib\/src\//, "", room)) { zone = "library"; sub(/\/[^\/]*$/, "", room); hall = room; sub(/\/.*/, "", hall); if (!(room in sees)) { breach("unknown room " room) } }
  else if (FILENAME ~ /^lib\/include\//) zone = "public"
  else if (sub(/^apps\//, "", room)) { zone = "user"; sub(/\/.*/, "", room) }
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
zone == "library" && FILENAME != "lib/src/core/memory.c" && /(^|[^A-Za-z0-9_])(malloc|calloc|realloc|strdup)\(/ {
  breach("the heap is behind core/memory.h")
}
# SUNDIALS hands over some strings that are to be freed.
zone == "library" && FILENAME != "lib/src/core/memory.c" && room != "solve" && room != "reference" && /(^|[^A-Za-z0-9_])free\(/ {
  breach("the heap is behind core/memory.h")
}
zone == "user" && /dvi__/ { breach("apps/ may not use internal names") }
zone == "public" && /dvi__/ { breach("internal name in a public header") }

END { exit failed }
