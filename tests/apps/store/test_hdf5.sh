#!/bin/sh
# Files of HDF5: rows with their facts, killed and resumed runs, failures, tables and fields.
# Usage: test_hdf5.sh DVI
. "$(dirname "$0")/../check.sh"

python=
for candidate in python3 /usr/bin/python3; do
  if "$candidate" -c 'import importlib.util as u, sys; sys.exit(not u.find_spec("h5py"))'; then
    python=$candidate
    break
  fi
done
[ -n "$python" ] || { echo 'no python3 has h5py'; exit 77; }
if ! "$dvi" run kepler --method verlet --h 0.1 --t-end 1 --out probe.h5 2>err; then
  says err 'has no module for it.*libhdf5-dev' 'what is missing'
  [ "$failures" -eq 0 ] && exit 77
  finish
fi

cat >one.yaml <<END
title: one
coordinates: {x: scalar}
lagrangian: x'^2/2 - x^2/2
initial: {x: 1}
method: verlet
step: 0.1
until: 1
END
# This mesh moves.
cat >block.yaml <<END
mesh: {generator: kuhn, cells: [2, 2], size: [1, 0.5]}
field: elastic
materials: {all: {law: neo-hookean, young: 100, poisson: 0.3, rho: 1}}
loads: {gravity: "[0, -9.81]"}
method: avi
step: {fraction: 0.5}
until: 0.2
report: {every: 4}
END
# Space repeats itself along x: the grid that is drawn has more points than the mesh.
cat >ring.yaml <<END
mesh: {generator: box, cells: [6, 3], size: [2, 1], periodic: [1, 0]}
field: wave
initial: {u: cos(pi*x), u': y}
method: verlet
step: 0.05
until: 1
report: {every: 4}
END

kepler='run kepler --method galerkin:degree=2 --h 0.015625 --every 3'

# later STATE: print a time of a whole step behind a checkpoint.
# shellcheck disable=SC2086
later() {
  "$dvi" $kepler --t-end 0.015625 --resume "$1" 2>&1 |
    sed -n 's/.*stands at t = \([0-9.]*\), past.*/\1/p' | awk '{ print $1 + 2 }'
}

# refused_to_append NAME WORDS ARGUMENTS...: require that a run cannot go on in part.h5.
refused_to_append() {
  name=$1 words=$2
  shift 2
  expect 1 "$name" run "$@" --t-end 9 --out part.h5 --resume part.state
  says err "^dvi: run: --resume cannot append to 'part.h5': $words; give another --out$" "$name"
}

# shellcheck disable=SC2086
{
# Rows are those of CSV.
expect 0 'rows' $kepler --set e=0.5 --t-end 8 --out rows.h5
expect 0 'the same as CSV' $kepler --set e=0.5 --t-end 8 --out rows.csv
expect 0 'one row' run kepler --method verlet --h 0.1 --t-end 1 --final --out final.h5
no_trace 'complete runs'

# A run that was killed, or that ended between two rows, goes on.
"$dvi" $kepler --t-end 1e6 --out killed.h5 --checkpoint killed.state --checkpoint-every 50 &
for _ in $(seq 500); do [ -e killed.state ] && break; sleep 0.01; done
expect 1 'a second writer' $kepler --t-end 1e6 --out killed.h5 --resume killed.state
says err "cannot append to 'killed.h5': another process writes it" 'the first writer'
kill -9 $!
wait $! 2>/dev/null
rm -f killed.state.part-*
cp killed.h5 dead.h5
end=$(later killed.state)
expect 0 'a killed run goes on' $kepler --t-end "$end" --out killed.h5 --resume killed.state
expect 0 'an uninterrupted run' $kepler --t-end "$end" --out whole.h5
expect 0 'a part' $kepler --t-end 1.5 --out part.h5 --checkpoint part.state
cp part.state early.state
expect 0 'its rest elsewhere' $kepler --t-end 2 --out rest.h5 --resume early.state
expect 0 'it goes on' $kepler --t-end 4.0625 --out part.h5 --checkpoint part.state \
  --resume part.state
cp part.h5 again.h5
expect 0 'from before the last rows' $kepler --t-end "$end" --out again.h5 --resume early.state

# What does not fit is refused, and stays as it was.
same='--method galerkin:degree=2 --every 3'
cp part.h5 kept.h5
refused_to_append 'another step' 'its h is 0.015625, not 0.03125' kepler $same --h 0.03125
refused_to_append 'another interval' 'its every is 3, not 1' kepler --method galerkin:degree=2 \
  --h 0.015625
refused_to_append 'other columns' 'it has other columns' kepler $same --h 0.015625 --columns x
cp kept.h5 part.h5
expect 0 'the start of a scene' run one.yaml --out one.h5 --checkpoint one.state
sed 's/title: one/title: two/' one.yaml >two.yaml && mv two.yaml one.yaml
expect 0 'the same as CSV' run one.yaml --out one.csv
expect 1 'another scene' run one.yaml --t-end 2 --out one.h5 --resume one.state
says err "cannot append to 'one.h5': its scene is " 'it says so'
expect 1 'a gap' $kepler --t-end 9 --out rest.h5 --resume part.state
head -c 8000 part.h5 >part.cut && mv part.cut part.h5
refused_to_append 'a file that was cut' 'it is cut short' kepler $same --h 0.015625
: >part.h5
refused_to_append 'an empty file' 'it is no file of HDF5' kepler $same --h 0.015625

# Failures keep what was flushed, and say why.
expect 1 'no folder' $kepler --t-end 1 --out nowhere/rows.h5
says err "^dvi: cannot write 'nowhere/rows.h5': No such file or directory$" 'no folder'
ln -s /dev/null null.h5
expect 1 'a device' $kepler --t-end 1 --out null.h5
says err 'a file of HDF5 is no device and no pipe' 'a device'
(ulimit -f 1500; exec "$dvi" $kepler --t-end 4000 --out full.h5 --checkpoint full.state \
  --checkpoint-every 5000 2>err) && fail 'a full disk'
says err "^dvi: cannot write 'full.h5': File too large$" 'a full disk'
[ "$(wc -l <err)" -eq 1 ] || fail 'one sentence about a full disk'
no_trace 'failures'

# Commands that read CSV read these files, and give the same.
for kind in csv h5; do
  expect 0 "a spectrum of $kind" spectrum rows.$kind --columns x,energy --csv lines_$kind.csv
  expect 0 "a plot of $kind" plot rows.$kind --axes x:y,t:x --title rows --out rows_$kind.svg
  expect 0 "a page of $kind" view rows.$kind --title rows --out page_$kind.html
  expect 0 "a page of $kind with its scene" view rows.$kind --scene kepler --title rows \
    --out scene_$kind.html
  expect 0 "a guess of $kind" path kepler --method galerkin:degree=2 --ends fixed --steps 20 \
    --t-end 1.5 --guess rows.$kind --out path_$kind.csv
  expect 0 "a fit to $kind" fit one.yaml --to one.$kind --vary x --columns x,p_x --out fit_$kind.csv
  sed -i '/^"made":/d' page_$kind.html scene_$kind.html
done
same lines_csv.csv lines_h5.csv 'a spectrum'
same rows_csv.svg rows_h5.svg 'a plot'
same page_csv.html page_h5.html 'a page'
same scene_csv.html scene_h5.html 'a page with its scene'
same path_csv.csv path_h5.csv 'a guess'
same fit_csv.csv fit_h5.csv 'a fit'
expect 0 'a killed run is read' spectrum dead.h5 --columns x --count 1
says out '^Spectrum of dead.h5: ' 'a killed run'
expect 2 'no such column' plot rows.h5 --axes x:enrgy --out x.svg
says err "^dvi: plot: 'rows.h5' has no column 'enrgy' (did you mean 'energy'?)$" 'no such column'
# not_read FILE WORDS: require that a file is refused by a sentence.
not_read() {
  expect 1 "$1" spectrum "$1"
  says err "^dvi: cannot read '$1': $2$" "$1"
  [ "$(wc -l <err)" -eq 1 ] || fail "$1: one sentence"
}
for size in 100 3000 9000; do
  head -c $size rows.h5 >cut.h5
  not_read cut.h5 'it is cut short'
done
head -c -1 dead.h5 >cut.h5
not_read cut.h5 'it is cut short'
cp rows.csv text.h5
not_read text.h5 'it is no file of HDF5'
not_read nowhere.h5 'No such file or directory'
"$python" - <<END
import h5py
for name, facts in ("other", {}), ("newer", {"layout": "dvi rows 9"}), \
        ("nameless", {"layout": "dvi rows 1"}):
    with h5py.File(name + ".h5", "w") as file:
        file["rows"] = [[0.0, 1.0], [1.0, 2.0]]
        file.attrs.update(facts)
END
not_read other.h5 'dvi has not written it'
not_read newer.h5 "its layout is 'dvi rows 9', and this dvi knows 'dvi rows 1'"
not_read nameless.h5 'its columns have no names'

# A sweep is a table, and frames of fields are those of .vtu files.
sweep='sweep kepler --method verlet --h 0.1 --t-end 1 --set e=0:0.5:3'
expect 0 'a sweep' $sweep --out table.h5
expect 0 'the same as CSV' $sweep --out table.csv
for kind in csv h5; do
  expect 0 "a plot of a sweep" plot table.$kind --axes e:energy --title e --out table_$kind.svg
done
same table_csv.svg table_h5.svg 'a plot of a sweep'
way='--method galerkin:degree=2 --ends fixed --steps 9 --t-end 1'
for reader in 'view table.h5 --out x.html' 'spectrum table.h5' \
  'fit one.yaml --to table.h5 --vary x' "path kepler $way --guess table.h5"; do
  expect 2 "$reader" $reader
  says err "^dvi: ${reader%% *}: 'table.h5' is the table of a sweep, and the rows of a run are" \
    "$reader"
done
# CSV is written under no name of HDF5, and read from none, nor HDF5 from standard input.
for writer in "path kepler $way --out" 'list problems --csv' 'mesh disk --csv' \
  'control nowhere.yaml --out' 'gradient nowhere.yaml --out' 'fit nowhere.yaml --out' \
  'order kepler --csv' 'resonance kepler --csv' 'solve nowhere.yaml --csv' \
  'modes nowhere.yaml --csv' 'stability nowhere.yaml --csv' 'spectrum rows.csv --csv' \
  'bench kepler --csv' 'bench kepler --at-csv' 'run one.yaml --csv' 'run one.yaml --events' \
  'curvature nowhere.vtu --csv' 'regge nowhere.vtu --csv'; do
  expect 2 "$writer" $writer none.h5
  says err "^dvi: ${writer%% *}: ${writer##* } none.h5: CSV is written there" "$writer"
done
[ ! -e none.h5 ] || fail 'CSV under a name of HDF5'
for reader in 'spectrum -' 'plot - --axes x:y --out x.svg' 'view - --out x.html'; do
  "$dvi" $reader <rows.h5 >out 2>err && fail "$reader: HDF5"
  says err '^dvi: standard input has a file of HDF5, which is read by its name' "$reader"
done
cp rows.h5 named.csv
expect 1 'HDF5 under a name of CSV' spectrum named.csv
says err "^dvi: 'named.csv' is a file of HDF5; give it a name that ends in .h5$" 'its name'

for scene in ring block; do
  expect 0 "frames of a $scene" run $scene.yaml --pvd $scene.vtkhdf --out $scene.h5
  expect 0 "a list of a $scene" run $scene.yaml --pvd $scene.pvd --out $scene.csv
  expect 0 "a page of its list" view $scene.pvd --rows $scene.csv --title $scene --out listed.html
  expect 0 "a page of its frames" view $scene.vtkhdf --rows $scene.h5 --title $scene \
    --out stored.html
  sed -i '/^"made":/d' listed.html stored.html
  same listed.html stored.html "a page of a $scene"
done
expect 2 'no such field' view block.vtkhdf --field v --out x.html
says err "no field 'v' among" 'no such field'
for size in 100 3000 20000; do
  head -c $size block.vtkhdf >cut.vtkhdf
  expect 1 'fields that were cut' view cut.vtkhdf --out x.html
  says err "^dvi: cannot read 'cut.vtkhdf': it is cut short$" 'fields that were cut'
done
cp rows.h5 rows.vtkhdf
expect 1 'rows under a name of fields' view rows.vtkhdf --out x.html
says err "^dvi: cannot read 'rows.vtkhdf': it has no 'VTKHDF'$" 'rows under a name of fields'
cp rows.csv text.vtkhdf
expect 1 'no HDF5' view text.vtkhdf --out x.html
says err "^dvi: cannot read 'text.vtkhdf': it is no file of HDF5$" 'no HDF5'
expect 1 'no fields' view nowhere.vtkhdf --out x.html
[ ! -e x.html ] || fail 'a page without fields'
"$python" - <<END
import h5py
for name, array, at, number in ("cell", "Connectivity", 3, 10**6), \
        ("point", "Points", 0, float("nan")), ("kind", "Types", 0, 7), \
        ("count", "NumberOfCells", 0, 10**12), \
        ("offset", "Steps/PointOffsets", 0, -5), ("offset2", "Steps/CellDataOffsets/u", 0, 10**12):
    with open("block.vtkhdf", "rb") as old, open(name + ".vtkhdf", "wb") as new:
        new.write(old.read())
    with h5py.File(name + ".vtkhdf", "r+") as file:
        root = file["VTKHDF"]
        if array not in root:
            array = "Steps/PointDataOffsets/" + next(iter(root["PointData"]))
        root[array][at] = number
END
for damaged in cell point kind count offset offset2; do
  expect 1 "a damaged $damaged" view $damaged.vtkhdf --out x.html
  says err "^dvi: cannot read '$damaged.vtkhdf': " "a damaged $damaged"
done
expect 1 'lines of fields' spectrum ring.vtkhdf
says err "^dvi: 'ring.vtkhdf' has fields at the times of a run, and no rows" 'lines of fields'
expect 2 'a picture of all times' plot ring.vtkhdf --out x.svg
says err '^dvi: plot: ring.vtkhdf has fields at the times of a run, which dvi view shows' \
  'a picture of all times'
march='run ring.yaml --method leapfrog'
expect 0 'a march' $march --t-end 0.55 --out march.h5 --pvd march.vtkhdf --checkpoint march.state
cp march.h5 early_march.h5
expect 0 'its list' $march --t-end 0.55 --out march.csv --pvd march.pvd
expect 0 'it goes on' $march --out march.h5 --resume march.state
expect 0 'an uninterrupted march' $march --out whole_march.h5
expect 2 'another ending' run ring.yaml --pvd ring.vtk
says err 'the name ends in .pvd or .vtkhdf' 'another ending'
}

cat >check.py <<'END'
import re
import sys

import h5py
import numpy as np

failures = 0


def check(name, holds):
    global failures
    if not holds:
        print("FAILED:", name)
        failures += 1


def rows(name, **how):
    with h5py.File(name, "r", **how) as file:
        return file["rows"][:]


def head_of(csv):
    with open(csv, encoding="ascii") as lines:
        return lines.readline().strip().split(",")


def vtu(name):
    """Return the arrays of a .vtu file by their names."""
    with open(name, "rb") as file:
        text = file.read()
    begin = text.index(b"_", text.index(b"<AppendedData")) + 1
    types = {b"Float64": "<f8", b"Int64": "<i8", b"UInt8": "u1"}
    found = {}
    for kind, of, width, at in re.findall(
            rb'type="(\w+)" Name="([^"]+)" NumberOfComponents="(\d+)".*offset="(\d+)"', text):
        place = begin + int(at)
        size = int(np.frombuffer(text, "<u8", 1, place)[0])
        array = np.frombuffer(text[place + 8:place + 8 + size], types[kind])
        found[of.decode()] = array.reshape(-1, int(width)) if int(width) > 1 else array
    return found


def frames(name, listed, moves):
    """Compare a file with the .vtu files of the same run."""
    with h5py.File(name, "r") as file:
        root = file["VTKHDF"]
        steps = root["Steps"]
        count = steps.attrs["NSteps"]
        check(name + ": version and type", list(root.attrs["Version"]) == [2, 0] and
              root.attrs["Type"] == b"UnstructuredGrid")
        check(name + ": steps", count == len(listed) == len(steps["Values"]) and
              all(steps["NumberOfParts"][:] == 1) and not any(steps["PartOffsets"][:]))
        points, cells = root["NumberOfPoints"][0], root["NumberOfCells"][0]
        ids = root["NumberOfConnectivityIds"][0]
        check(name + ": points are there once, unless they move",
              len(root["Points"]) == points * (count if moves else 1))
        for k, path in enumerate(listed):
            wanted = vtu(path)
            begin = steps["PointOffsets"][k]
            cell = steps["CellOffsets"][k, 0]
            corner = steps["ConnectivityIdOffsets"][k, 0]
            parts = {"Points": root["Points"][begin:begin + points],
                     "connectivity": root["Connectivity"][corner:corner + ids],
                     "offsets": root["Offsets"][cell + 1:cell + cells + 1],
                     "types": root["Types"][cell:cell + cells]}
            for of, number in ("Point", points), ("Cell", cells):
                for field in root[of + "Data"]:
                    at = steps[of + "DataOffsets"][field][k]
                    parts[field] = root[of + "Data"][field][at:at + number]
            check(f"{name}: step {k} is {path}", parts.keys() == wanted.keys() and
                  all(np.array_equal(parts[part], wanted[part]) for part in parts))


with h5py.File("rows.h5", "r") as file:
    check("facts", file.attrs["method"] == "galerkin:degree=2" and file.attrs["h"] == 0.015625 and
          file.attrs["problem"] == "kepler" and "lagrangian" in file.attrs["scene"] and
          file.attrs["command"].startswith("dvi run kepler --method galerkin:degree=2 --h") and
          {"dvi", "sundials", "settings", "every"} <= file.attrs.keys())
    check("columns", list(file["rows"].attrs["columns"]) == head_of("rows.csv"))
check("rows are those of CSV",
      np.array_equal(rows("rows.h5"), np.loadtxt("rows.csv", delimiter=",", skiprows=1)))
check("a final row", rows("final.h5").shape[0] == 1 and rows("final.h5")[0, 0] == 1)
dead, whole = rows("dead.h5", swmr=True), rows("whole.h5")
check("a killed run can be read", len(dead) > 16 and
      np.array_equal(dead[:len(whole)], whole[:len(dead)]))
for name in "killed.h5", "again.h5":
    check(name + " has the rows of an uninterrupted run", np.array_equal(rows(name), whole))
kept = rows("kept.h5")
check("a part has them, and its end", np.array_equal(kept[:-1], whole[:len(kept) - 1]) and
      kept[-1, 0] == 4.0625)
check("another file begins at the checkpoint", rows("rest.h5")[0, 0] == 1.5)
full = rows("full.h5", swmr=True)
check("a full disk has what was flushed", len(full) > 100 and
      np.array_equal(full, whole[:len(full)]) or len(full) > len(whole))

with h5py.File("table.h5", "r") as file, open("table.csv", encoding="ascii") as lines:
    names = list(file["rows"].attrs["columns"])
    header = lines.readline().strip().split(",")
    check("columns of a table", names + ["status"] == [n for n in header if n != "status"] +
          ["status"])
    for k, line in enumerate(lines):
        cells = dict(zip(header, line.strip().split(",")))
        check("a row of a table", cells.pop("status") == file["text/status"][k].decode() and
              [float(cells[name]) for name in names] == list(file["rows"][k]))

for scene, moves in ("ring", False), ("block", True):
    frames(scene + ".vtkhdf", [f"{scene}_{k:06d}.vtu" for k in range(len(rows(scene + ".h5")))],
           moves)
    check(scene + ": times", np.array_equal(
        h5py.File(scene + ".vtkhdf", "r")["VTKHDF/Steps/Values"][:], rows(scene + ".h5")[:, 0]))
frames("march.vtkhdf", [f"march_{k:06d}.vtu" for k in range(len(rows("early_march.h5")))], False)
check("a march goes on", np.array_equal(rows("march.h5"), rows("whole_march.h5")))
sys.exit(failures > 0)
END
"$python" check.py || failures=$((failures + 1))
finish
