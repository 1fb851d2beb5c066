#!/bin/sh
# A file that is no scene is refused in one sentence, which says how a scene looks. If an expression
# has no value at run time, its place stands first, unless the method recovered.
# Usage: test_scene_files.sh DVI
. "$(dirname "$0")/../check.sh"

# ---- no scenes ----

mkdir folder folder.yaml
printf 't,x,p\n0,1,2\n' >table.csv
cp table.csv table.yaml
printf '\177ELF\002\001\001\000\000\000\000\000' >program.yaml
printf '# nothing\n' >empty.yaml
: >nothing.yaml
printf -- '- a\n- b\n' >list.yaml
printf 'hello\n' >word.yaml
printf '{"name": "x", "version": 3}\n' >other.yaml
cp other.yaml other.json
for command in run check order explain; do
  for file in table program empty nothing list word other; do
    expect 2 "$command $file.yaml" $command $file.yaml
    scene='that is a YAML mapping with coordinates, .*dvi init NAME.yaml writes one'
    says err "^dvi: $file.yaml.*, and no scene: $scene" "$command $file.yaml"
    [ "$(grep -c '^dvi: ' err)" -eq 1 ] || fail "$command $file.yaml: more than one sentence"
  done
  for file in table.csv other.json folder folder.yaml; do
    expect 2 "$command $file" $command "$file"
    says err "^dvi: '$file' is a .*, and no scene: that is a .*dvi init NAME.yaml writes one" \
      "$command $file"
  done
done
expect 2 'sweep of a folder' sweep folder.yaml --out s.csv
says err "'folder.yaml' is a folder, and no scene" 'sweep of a folder'
expect 2 'a problem that is no file' run keppler
says err "unknown problem 'keppler' (did you mean 'kepler'?)" 'slips of names are told as before'

# ---- no values ----

# The first line of standard error is the place.
first() { head -n 1 err | grep -q -e "$1" || { fail "$2: not first:"; sed 's/^/    /' err; }; }

cat >wall.yaml <<'END'
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 - log(x - 1)
initial: {x: 1.3, y: 0, x': -1, y': 2}
method: verlet
step: 0.02
until: 10
END
expect 1 'a logarithm' run wall.yaml
first \
  '^dvi: wall.yaml:2:31: log(x - 1), x - 1 = -0.00592.* is not finite, at t = 0.2, where x = 0.99' \
  'the place, the time, the coordinate'
says err 'verlet: step 10 from t = 0.18 .*: potential has no value there$' \
  'what the method was doing'
grep -q callback err && fail 'callbacks are no words of scenes'
expect 1 'a logarithm by an implicit method' run wall.yaml --method galerkin:degree=2
first '^dvi: wall.yaml:2:31: log(x - 1)' 'the place'

sed 's/^step/invariants: {w: sqrt(x - 1.1)}\nstep/' wall.yaml >watched.yaml
expect 1 'an invariant' run watched.yaml
first '^dvi: watched.yaml:5:17: sqrt(x - 1.1), x - 1.1 = .* is not finite, at t = .*, where x = ' \
  'the place'
says err "invariant 'w' has no value there; try a smaller --h" 'which'

sed 's/^initial:.*/initial: {x: 0.5, y: 0}/; s/- log/- y*log/' wall.yaml >start.yaml
expect 1 'at the start' run start.yaml
first "^dvi: start.yaml:2:33: log(x - 1), x - 1 = -0.5 is not finite, at t = 0, where x = 0.5" \
  'the place'
sed "s/- log(x - 1)/+ x'*log(x - 1)/; s/x: 1.3/x: 0.5/" wall.yaml >momentum.yaml
expect 2 'the momentum at the start' run momentum.yaml
first '^dvi: momentum.yaml:2:34: at the start: log(x - 1), x - 1 = -0.5 is not finite' 'the place'

# The solution of a long step continues those of shorter steps up to the end of the root's domain,
# and the message names this place.
cat >stale.yaml <<'END'
coordinates: {x: scalar, y: scalar}
lagrangian: (x'^2 + y'^2)/2 - (sqrt(abs(x) - 0.2)*20)
initial: {x: 0.5, y: 0, x': -1, y': 2}
method: midpoint
step: 0.5
until: 10
END
expect 1 'no solution' run stale.yaml
says err '^dvi: stale.yaml:2:32: sqrt(abs(x) - 0.2), .* is not finite' 'the place'
says err 'failed; .* up to h = 0.1.*: potential has no value there' 'the reason'

# ---- kinks ----

cat >kink.yaml <<'END'
coordinates: {x: scalar}
lagrangian: x'^2/2 - max(x, 0)^2
initial: {x: 1}
method: galerkin:degree=2
step: 0.1
until: 1
END
expect 0 'a kink' run kink.yaml --final
jump='the second derivative of the Lagrangian jumps here: .* orders above 2 are lost'
says err "^dvi: run: kink.yaml:2:22: max(x, 0): $jump" 'run'
expect 0 'explain' explain kink.yaml
says out '^kink: kink.yaml:2:22: max(x, 0)' 'explain'
expect 0 'check' check kink.yaml
says out '^kink: kink.yaml:2:22: max(x, 0)' 'check'
# One of the points lies at a kink of a velocity. Differences across it do not test the
# derivatives.
cat >rest.yaml <<'E1'
coordinates: {y: scalar}
lagrangian: y'^2/2 - 3*max(y,0)^2 + 0.1*abs(y')*y
initial: {y: 0.5}
step: 0.01
until: 10
E1
expect 0 'a kink at rest' check rest.yaml
says out "^kink: rest.yaml:2:41: abs(y'): the first derivative" 'check tells it'
says out 'at 4 points near the start .*; left out: 1 at a kink' 'why a point is left out'
cat >many.yaml <<'E1'
coordinates: {"x[1000]": scalar}
lagrangian: sum(i=1..1000, x[i]'^2/2 + 0.1*abs(x[i]')*x[i])
initial: {"x[i]": 0.5}
step: 0.01
until: 10
E1
expect 3 'kinks at every point' check many.yaml
says err 'differences across a kink look like this, too; try a start away from it' \
  'what may be the cause'
says err "many.yaml:2:44: abs(x\[i\]'): the first derivative" 'and where'
"$dvi" order kink.yaml >out 2>err
says err '^dvi: order: kink.yaml:2:22: max(x, 0)' 'order'
sed 's/max(x, 0)/x/' kink.yaml >smooth.yaml
expect 0 'no kink' run smooth.yaml --final
[ ! -s err ] || fail 'there is no kink'

finish
