#!/bin/sh
# The commands beside the figures of docs/performance.md exist and run. What takes long is cut
# short: spans, levels, rounds, peers and sizes.  Usage: test_performance.sh DVI
top=$(cd "$(dirname "$0")/../../.." && pwd)
. "$(dirname "$0")/../check.sh"
page=$top/docs/performance.md

# A command `dvi` that makes its options cheap and keeps a list of what failed.
mkdir bin
cat >bin/dvi <<'END'
#!/bin/sh
command=$1
shift
count=$# scaled=''
while [ "$count" -gt 0 ]; do
  option=$1 value=${2:-}
  shift
  count=$((count - 1))
  case $command$option in
    bench--rounds | bench--steps | bench--t-end | bench--at | bench--csv | bench--plot | \
      order--t-end | order--levels | order--plot | order--axes | run--t-end | run--every | \
      path--steps)
      value='' ;;
    bench--scale)
      scaled=1
      case $value in
        threads=* | degree=*) value="$option $value" ;;
        members=*) value="$option members=2" ;;
        *) value="$option ${value%%=*}=10,12" ;;
      esac ;;
    bench--against) value="$option cvode" ;;
    *--set) case $value in n=*e*) value="$option n=1000" ;; *) value="$option $value" ;; esac ;;
    *)
      set -- "$@" "$option"
      continue ;;
  esac
  shift
  count=$((count - 1))
  # The values hold no blanks.
  # shellcheck disable=SC2086
  set -- "$@" $value
done
case $command$scaled in
  bench1) set -- "$@" --rounds 1 --steps 1 ;;
  bench) set -- "$@" --rounds 1 --levels 1 ;;
  order) set -- "$@" --levels 1 ;;
  run) set -- "$@" --t-end 10 ;;
  path) set -- "$@" --steps 20 ;;
  solve) sed -i 's/58/6/g' "$1" ;;
esac
echo "dvi $command $*" >>"$FOLDER/ran"
code=0
"$DVI" "$command" "$@" 2>err.dvi || code=$?
# A single level decides nothing about an order.
[ $code -eq 0 ] || [ $command$code = order3 ] || {
  echo "dvi $command $*"
  cat err.dvi
} >>"$FOLDER/failed"
exit $code
END
# Programs that are no part of the command, and scripts, need only exist.
cat >bin/sh <<'END'
#!/bin/sh
[ -e "$1" ] || echo "sh $1" >>"$FOLDER/failed"
END
for name in apt-get cmake gcc taskset density_cost mesh_cost; do echo '#!/bin/sh' >bin/$name; done
# Shells other than bash have no word for it, and bare systems no program.
printf '#!/bin/sh\nexec "$@"\n' >bin/time
chmod +x bin/*
DVI=$dvi FOLDER=$folder
export DVI FOLDER

# The page's files: scenes of the catalogue, and one of another page.
ln -s "$top/apps" "$top/lib" "$top/tests" .
awk '/^# cartesian\.yaml/ { inside = 1 } /^```$/ { inside = 0 } inside' \
  "$top/docs/methods/multiscale.md" >cartesian.yaml
awk '/^```sh$/ { n++; inside = 1; next }
  /^```$/ { inside = 0 }
  inside { print > ("block." n) }' "$page"
for block in $(some block.*); do
  sed "s:/usr/bin/time -f [\"'][^\"']*[\"'] ::" "$block" >commands
  PATH=$folder/bin:$PATH /bin/sh commands >out 2>err
  [ $? -lt 126 ] || { fail "$block"; cat err; }
  grep 'not found' err && fail "$block"
done
[ ! -e failed ] || { fail 'commands of the page'; cat failed; }
[ -n "${DVI_TEST_FEWER:-}" ] || [ "$(grep -c '^dvi bench' ran)" -ge 60 ] ||
  fail 'all commands of the page'
# What ctest is asked for exists, and so does each program that the page names.
grep -o 'ctest -R [a-z_/]*' "$page" | sed 's/.* //' | while read -r name; do
  find "$top/tests/${name%/*}" -name "test_${name#*/}.c" | grep -q . || echo "ctest -R $name"
done >missing
grep -o 'apps/examples/[a-z_]*\.[a-z]*' "$page" | while read -r file; do
  [ -e "$top/$file" ] || echo "$file"
done >>missing
[ ! -s missing ] || { fail 'tests and programs that the page names'; cat missing; }
finish
