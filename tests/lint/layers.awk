# Checks which room includes which, which calls the library leaves to others, and that functions of
# several versions have names of their own. Prints every breach, and exits with 1 if there is one.
# Usage: awk -f layers.awk [-v methods="a b"] FILE...
# Paths are relative to the top of the tree.

BEGIN {
  # The rooms of lib/src that a room may include, besides itself. A name without a sub-room stands
  # for all of its sub-rooms.
  sees["core"] = ""
  sees["num/simd"] = "core"
  sees["num/fft"] = "core num/simd"
  sees["num/supernodal"] = "core num/simd"
  sees["num"] = "core num/simd num/fft num/supernodal"
  sees["group"] = "core num"
  sees["space"] = "core num"
  sees["solve"] = "core num"
  sees["system"] = "core num group"
  sees["system/term"] = "core num system"
  sees["system/evaluate"] = "core num system system/term"
  sees["system/dynamics"] = "core num system system/term system/evaluate"
  sees["system/chart"] = "core num group system system/term system/evaluate system/dynamics"
  sees["system/rescale"] = "core num system system/evaluate system/term"
  sees["system/check"] = "core num system system/evaluate system/term"
  sees["system/declare"] = sees["system/chart"] " system/term system/chart system/rescale"
  sees["joint"] = "core num"
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
  sees["record"] = "core march num system method integrator"
  sees["boundary"] = "core num solve system step/element method/element"
  sees["sensitivity"] = "core num system step/element method/element"
  sees["diagnostics"] = "core num system"
  sees["reference"] = "core num system"
  sees["field/algebra"] = "core num"
  sees["field/mesh"] = "core num"
  sees["field/mesh/delaunay"] = "core num field/mesh"
  sees["field/mesh/generate"] = "core field/mesh"
  sees["field/mesh/file"] = "core field/mesh"
  sees["field/forms"] = "core num field/algebra field/mesh"
  sees["field/audit"] = "core num field/algebra field/mesh field/forms"
  sees["field/yee"] = "core num num/simd march field/algebra"
  sees["field/pencil"] = "core field/algebra field/mesh"
  sees["field/model"] = "core num solve field/algebra field/mesh field/forms field/pencil"
  sees["field/step"] = "core num march field/algebra field/mesh field/model"
  sees["field/implicit"] = sees["field/step"] " field/step"
  sees["field/avi"] = sees["field/step"] " field/forms field/step"
  sees["field/tents"] = sees["field/avi"]
  sees["field/method"] = sees["field/avi"] " field/avi field/implicit field/tents"
  sees["field/spectra"] = "core"
  sees["field/multiscale"] = "core num field/algebra"
  sees["field/space"] = "core num num/fft space field/algebra field/mesh field/multiscale"
  sees["field/density"] = "core num field/algebra field/mesh field/space"
  sees["field/schroedinger"] = "core num solve march field/algebra field/space field/density"
  sees["field/multisymplectic"] = "core num march field/algebra"
  sees["field/moving"] = "core num field/mesh field/space"
  sees["field/elastic"] = "core num field/algebra field/mesh field/pencil"
  sees["field/elastic_avi"] = sees["field/step"] " field/step field/elastic"
  sees["field/rotations"] = "core field/algebra"
  sees["field/regge"] = "core num solve field/algebra field/mesh"
  sees["field/connection"] = "core num field/algebra field/mesh field/forms field/regge"
  # The library of scenes includes libdvi's public headers, too.
  sees["text"] = ""
  sees["expr"] = "text"
  sees["expr/compile"] = "text expr"
  sees["expr/function"] = "text expr expr/compile"
  sees["scene/text"] = "text"
  sees["scene/elaborate"] = "text expr expr/compile expr/function scene/text"
  sees["scene/terms"] = sees["scene/elaborate"] " scene/elaborate"
  sees["scene/sections"] = sees["scene/terms"] " scene/terms"
  sees["scene/field"] = sees["scene/sections"] " scene/sections"
  sees["scene/elastic"] = sees["scene/field"] " scene/field"
  sees["scene/density"] = sees["scene/sections"] " scene/sections"
  sees["scene"] = sees["scene/field"] " scene/field scene/elastic scene/density core"
  sees["scene/emit"] = sees["scene"] " scene"
  # So does the library of studies.
  sees["study"] = "core"
  # The command includes public headers and those of the problems, too.
  uses["cli"] = ""
  uses["hdf5"] = ""
  uses["petsc"] = ""
  uses["module"] = "cli hdf5 petsc"
  uses["csv"] = "cli hdf5 module"
  uses["load"] = "cli csv module"
  uses["plot"] = "cli csv"
  uses["sweep"] = "cli csv load"
  uses["boundary"] = "cli csv load"
  uses["varied"] = "cli csv load"
  uses["picture"] = "cli plot"
  uses["study"] = "cli csv plot"
  uses["mechanics"] = uses["study"] " study load"
  uses["store"] = "cli csv load hdf5 module"
  uses["shares"] = "cli csv load module"
  uses["bench"] = uses["mechanics"] " mechanics"
  uses["scaling"] = uses["bench"] " bench module shares"
  uses["frames"] = "cli plot picture hdf5 module"
  uses["watch"] = uses["bench"] " picture hdf5 module store frames"
  uses["view"] = "cli csv load picture module"
  uses["cmd"] = uses["watch"] " module watch bench scaling shares sweep boundary varied view"
  uses["main.c"] = "cli"
  # Single headers of other rooms that a room may include.
  also["reference solve/sundials.h"] = 1
  also["field/mesh/file march/whole_file.h"] = 1
  # libdvi shares these headers with sister libraries (lib/exports.map, DVI_PRIVATE).
  also["text core/memory.h"] = also["expr/compile num/simd/lanes.h"] = 1
  # The component petsc sees these headers of the library.
  also["petsc core/memory.h"] = also["petsc core/status.h"] = also["petsc num/accumulator.h"] = 1
  also["petsc field/mesh/given.h"] = also["petsc field/mesh/shape.h"] = 1
  also["petsc field/model/elliptic.h"] = also["petsc solve/solver.h"] = 1
  also["petsc march/parts.h"] = 1
  # Standard headers that a public header may need.
  split("math.h stdarg.h stddef.h stdint.h string.h", open_headers)
  for (i in open_headers) standard[open_headers[i]] = 1
  count = split(methods, names, " ")
  for (i = 1; i <= count; i++) method[names[i] ".h"] = 1
}

function breach(why) { printf "%s:%d: %s: %s\n", FILENAME, FNR, why, $0; failed = 1 }

function part_of_sundials(header) {
  return header ~ /^(sundials|kinsol|idas?|cvodes?|arkode)\// ||
    header ~ /^(nvector|sunlinsol|sunmatrix|sunnonlinsol)\//
}

function part_of_suitesparse(header) {
  return header ~ /^(suitesparse\/)?(klu|amd|colamd|btf|SuiteSparse_config)\.h$/
}

function part_of_mpi(header) {
  return header ~ /^(mpi|(petsc|slepc)[a-z]*)\.h$/ || header == "dvi/petsc.h"
}

# lib/petsc is the only component that is linked to PETSc and MPI.
function check_component(quoted, header) {
  if (quoted && header ~ /\// && !(("petsc " header) in also))
    breach("lib/petsc may include public headers, and of libdvi's own core/memory.h, " \
           "core/status.h, field/mesh/{given,shape}.h, field/model/elliptic.h, " \
           "march/parts.h and num/accumulator.h")
}

function check_library(quoted, header,   target) {
  if (!quoted) {
    if (part_of_sundials(header) && room != "solve" && room != "reference")
      breach("call SUNDIALS in solve/ or reference/ only")
    if (part_of_suitesparse(header) && room != "num" && room != "reference")
      breach("call KLU in num/ or reference/ only")
    return
  }
  if (header !~ /^[a-z]+\/([a-z_]+\/)*[a-z_0-9]+\.(h|def)$/) {
    breach("write \"room/file.h\", relative to lib/src")
    return
  }
  target = file = header
  sub(/\/[^\/]*$/, "", target)
  sub(/.*\//, "", file)
  if (target ~ /^method/ && file in method)
    breach("methods never include each other: move shared code to step/ or num/")
  if (target == room || (room " " header) in also || is_seen(target)) return
  breach(room "/ may not include " target "/: move the code, or allow it in tests/lint/layers.awk")
}

# Tells if the file's room may include the target room, or the whole top-level room of which the
# target is a part.
function is_seen(target,   whole) {
  whole = target
  sub(/\/.*/, "", whole)
  if (index(" " sees[room] " ", " " target " ") > 0) return 1
  return whole != top && index(" " sees[room] " ", " " whole " ") > 0
}

function check_public(quoted, header) {
  if (quoted || (header !~ /^dvi\// && !(header in standard)))
    breach("a public header includes only <dvi/...>, <math.h>, <stdarg.h>, <stddef.h>, " \
           "<stdint.h>, <string.h>")
}

# The command, the problems and the examples are users of the library.
function check_user(quoted, header,   target) {
  if (part_of_sundials(header) || part_of_suitesparse(header))
    breach("call the solvers through the library: apps/ may not include their headers")
  if (!quoted || header !~ /\//) return
  target = header
  sub(/\/.*/, "", target)
  if (target == room || index(" " uses[room] " ", " " target " ") > 0) return
  if (room == "problems" && target ~ /^(bodies|constrained|degenerate|rolling)$/) return
  breach("apps/" room " may not include apps/" target \
    ": move the code, or allow it in tests/lint/layers.awk")
}

FNR == 1 {
  room = FILENAME
  zone = "other"
  if (sub(/^lib\/src\//, "", room)) {
    zone = "library"
    sub(/\/[^\/]*$/, "", room)
    top = room
    sub(/\/.*/, "", top)
    if (!(room in sees)) breach("unknown room " room ": add it to tests/lint/layers.awk")
  }
  else if (FILENAME ~ /^lib\/include\//) zone = "public"
  else if (FILENAME ~ /^lib\/petsc\/src\//) zone = "component"
  else if (sub(/^apps\//, "", room)) { zone = "user"; sub(/\/.*/, "", room) }
}

/^[ \t]*#[ \t]*include/ {
  header = $0
  sub(/^[ \t]*#[ \t]*include[ \t]*/, "", header)
  quoted = header ~ /^"/
  sub(/^["<]/, "", header)
  sub(/[">].*/, "", header)
  if (part_of_mpi(header) && FILENAME !~ /^(lib|apps|tests)\/petsc\//)
    breach("call PETSc and MPI in lib/petsc, apps/petsc and tests/petsc only")
  if (zone == "component") check_component(quoted, header)
  if (zone == "library") check_library(quoted, header)
  if (zone == "public") check_public(quoted, header)
  if (zone == "user") check_user(quoted, header)
}

# The choice between the versions of a function (num/simd/wide.h) is a global name with clang.
zone == "library" && /^(WIDE|FUSED) static .*\(/ {
  name = $0
  sub(/\(.*/, "", name)
  sub(/.*[ *]/, "", name)
  if (name in versions)
    breach("clang cannot link this beside " name " of " versions[name] ": give it another name")
  versions[name] = FILENAME
}

# Text in quotes is left out, because the library writes C, too.
zone == "library" || zone == "component" {
  code = $0
  gsub(/"([^"\\]|\\.)*"/, "\"\"", code)
  if (code ~ /(^|[^A-Za-z0-9_])(printf|puts|putchar|exit|abort|assert)\(|std(out|err)/)
    breach("the library never prints, exits or aborts: return a status by dvi__fail")
}

# The program may have set a locale with a decimal comma.
function check_numbers() {
  if (zone == "library" && /[^A-Za-z0-9_]vsnprintf\(/ ||
      (zone == "library" || zone == "user") &&
      /[^A-Za-z0-9_](strtod|strtof|strtold|atof|setlocale)\(/)
    breach("read and write numbers by dvi/number.h, the same in every locale")
}

# SUNDIALS hands over some strings that the caller frees.
function check_heap() {
  if (/(^|[^A-Za-z0-9_])(malloc|calloc|realloc|strdup)\(/ ||
      room != "solve" && room != "reference" && /(^|[^A-Za-z0-9_])free\(/)
    breach("call the heap by core/memory.h")
}

FILENAME != "lib/src/core/number.c" { check_numbers() }
(zone == "library" || zone == "component") && FILENAME != "lib/src/core/memory.c" { check_heap() }
# One file measures how SUNDIALS was compiled, by a function that libdvi has for it alone.
zone == "user" && FILENAME == "apps/bench/sundials_build.c" { gsub(/dvi__sundials_sum_time/, "") }
zone == "user" && /dvi__/ { breach("use public names: apps/ may not use internal ones") }
zone == "public" && /dvi__/ { breach("a public header may not have internal names") }

END { exit failed }
