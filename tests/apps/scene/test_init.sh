#!/bin/sh
# dvi init: the example runs, and nothing is overwritten.  Usage: test_init.sh DVI
. "$(dirname "$0")/../check.sh"

expect 0 'the example' init cart.yaml
expect 0 'it runs' run cart.yaml --final
says out '^t,x,theta,p_x,p_theta,energy,along_the_rail,height$' 'its columns'
expect 0 'its derivatives are right' check cart.yaml
expect 0 'parameters' run cart.yaml --set l=0.7 --final
expect 0 'standard output' init -
same out cart.yaml 'standard output has what the file has'

# Every template is a scene that runs, with right derivatives, and in C.
for template in cart mechanism crane field; do
  expect 0 "$template" init "$template-here.yaml" --template $template
  expect 0 "$template: derivatives" check "$template-here.yaml"
  expect 0 "$template: a run" run "$template-here.yaml" --final
done
expect 0 'a method of the claimed order' order mechanism-here.yaml
expect 0 'another parameter' run mechanism-here.yaml --set torque=0 --set a0=1 --final
expect 0 'C' emit-c mechanism-here.yaml --out mechanism.c
expect 2 'controls in C' emit-c crane-here.yaml --out crane.c
expect 2 'a field in C' emit-c field-here.yaml --out field.c
# With sanitizers this takes minutes.
if [ -z "${DVI_TEST_FEWER:-}" ]; then
  expect 0 'control' control crane-here.yaml --out crane.csv
  says out 'minimum: 242 negative for 242 multipliers, 0 zero' 'a minimum'
  says crane.csv '^3,2,' 'the end'
fi
expect 0 'sensitivities' gradient crane-here.yaml
says out '^objective,-[0-9.]*,$' 'the objective'
expect 2 'no template' init new.yaml --template boat
says err 'templates: cart, crane, field, mechanism' 'which there are'
[ ! -e new.yaml ] || fail 'a file without a template'

echo mine >mine.yaml
expect 1 'a file that is there' init mine.yaml
says err 'mine.yaml. is there already' 'the reason'
[ "$(cat mine.yaml)" = mine ] || fail 'the file was overwritten'
expect 2 'no scene' init cart.txt
says err 'end in .yaml or .yml' 'what a name looks like'
expect 2 'no name' init
expect 1 'no such folder' init none/cart.yaml
no_trace 'init'
finish
