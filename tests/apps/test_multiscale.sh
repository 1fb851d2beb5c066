#!/bin/sh
# Multiscale elements in the commands: they take their coefficient from the density.
# Usage: test_multiscale.sh DVI
. "$(dirname "$0")/check.sh"

cat >rod.yaml <<END
domain: {x: [0, 1]}
space: msfem:cells=8,fine=400
fields: {u: scalar}
density: -10/(1 + 0.95*sin(2*pi*x/0.025))*d(u,x)^2/2 - x^2*u
boundary: fixed
probes: {a: u(0.25), b: u(0.5)}
END
# the exact values are those at the ends of cells
for cells in 4 16; do
  sed "s/cells=8/cells=$cells/" rod.yaml >cells.yaml
  expect 0 "$cells cells" solve cells.yaml
  says out '^a  *-0.0020212505[45]' 'u at a quarter'
  says out '^b  *-0.0035985842[01]' 'u in the middle'
done

sed "s/^density: /&u'^2\/2 /;s/ - x^2\*u//" rod.yaml >wave.yaml
expect 0 'the lowest mode' modes wave.yaml --count 1
# the coarse wave has (k h)^2 of error, beside 9.934237889
says out ' 9.997469272' 'its frequency'
sed 's/cells=8/cells=32/' wave.yaml >finer.yaml
expect 0 'the lowest mode of more cells' modes finer.yaml --count 1
says out ' 9.93812806' 'its frequency'

cat >sheet.yaml <<END
parameters: {e: 1/16}
domain: {x: [0, 1], y: [0, 1]}
space: msfem:cells=8,fine=16
fields: {u: scalar}
density: -(2 + 1.8*sin(2*pi*x/e))/(2 + 1.8*cos(2*pi*y/e))*dot(grad(u),grad(u))/2 + u
boundary: fixed
END
expect 0 'a sheet' solve sheet.yaml
sed 's/dot(grad(u),grad(u))/(d(u,x)^2 + 2*d(u,y)^2)/' sheet.yaml >two.yaml
expect 2 'two coefficients' solve two.yaml
says err '^dvi: two.yaml:5:10: msfem has one coefficient for all components and axes' 'the reason'
sed 's/scalar/vector(2)/;s/dot(grad(u),grad(u))/(dot(d(u,x),d(u,x)) + dot(d(u,y),d(u,y)))/
  s/ + u$//' sheet.yaml >vector.yaml
expect 0 'components with one coefficient' solve vector.yaml

finish
