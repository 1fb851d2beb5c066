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
