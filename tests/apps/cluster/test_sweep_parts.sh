#!/bin/sh
# Parts of a sweep: joined they are the file of one machine; what is refused; killed parts go on;
# tasks of a job array; GNU parallel where it is.  Usage: test_sweep_parts.sh DVI
. "$(dirname "$0")/../check.sh"
"$dvi" init cart.yaml
grid='--set l=0.2:1:7 --set m=0.2,0.3 --set g=9:10:2'
cart="sweep cart.yaml --t-end 1 $grid"
refuses() { # CODE WORDS NAME ARGUMENTS...
  code=$1 words=$2 name=$3
  shift 3
  expect "$code" "$name" "$@" --out no.csv
  says err "$words" "$name: the reason"
  [ ! -e no.csv ] || { fail "$name: a file was written"; rm no.csv; }
}

# shellcheck disable=SC2086
{
# 28 points in 3 parts, whose order and threads do not matter.
expect 0 'one machine' $cart --out one.csv
cp one.csv whole.csv
for k in 3 1 2; do expect 0 "part $k/3" $cart --threads $k --out one.csv --part $k/3; done
same one.csv whole.csv 'parts leave the file of the sweep alone'
rm one.csv
expect 0 'joined' $cart --out one.csv --join one.csv.2-of-3 one.csv.1-of-3 one.csv.3-of-3
same one.csv whole.csv 'joined parts are the file of one machine'
[ ! -e one.csv.part ] || fail 'a join leaves no unfinished sweep'
expect 0 'a part that is there' $cart --out one.csv --part 2/3
says err '9 of 9 points are in .one.csv.2-of-3. already' 'nothing is run again'
if "$dvi" $cart --out one.h5 2>err; then
  mv one.h5 whole.h5
  sleep 1.1 # the time must not stand in files
  expect 0 'joined as HDF5' $cart --out one.h5 --join one.csv.*-of-3
  same one.h5 whole.h5 'joined parts are the file of one machine, HDF5'
else
  echo 'no HDF5: files of it are not joined'
fi

# More parts than points, and the whole as one part.
few='sweep kepler --method verlet --h 0.1 --t-end 1 --set e=0,0.1,2'
expect 1 'a point fails' $few --out whole.csv
says err '1 of 3 points failed; column status of .whole.csv.' 'where'
for k in 1 2 4; do expect 0 "part $k/4" $few --out few.csv --part $k/4; done
expect 1 'the part of the point' $few --out few.csv --part 3/4
says err '1 of 1 points failed; column status of .few.csv.3-of-4. ' 'where'
expect 1 'the join' $few --out few.csv --join few.csv.*-of-4
same few.csv whole.csv 'points that fail, and a part without points'
expect 1 'a single part' $few --out few.csv --part 1/1
expect 1 'its join' $few --out few.csv --join few.csv.1-of-1
same few.csv whole.csv 'a single part'

# What is refused.
parts='one.csv.1-of-3 one.csv.2-of-3 one.csv.3-of-3'
sed 's/theta: 1$/theta: 1.5/' cart.yaml >other.yaml
refuses 1 'one.csv.1-of-3. is a part of a sweep of another scene' 'another scene' \
  sweep other.yaml --t-end 1 $grid --join $parts
refuses 1 'with another --method, --h or --t-end' 'another step' $cart --h 0.01 --join $parts
refuses 1 'with another --method, --h or --t-end' 'another method' $cart \
  --method galerkin:degree=3 --join $parts
refuses 1 'is a part of a sweep over other values' 'another grid' sweep cart.yaml --t-end 1 \
  --set l=0.2:1:7 --set m=0.2,0.4 --set g=9:10:2 --join $parts
sed '1s/sweep [^ ]*/sweep 0.0.0/' one.csv.1-of-3 >old
refuses 1 'old. was made by another version of dvi' 'another version' $cart --join old
refuses 1 '2 of 3 parts are missing, the first one is 1/3' 'missing' $cart --join one.csv.3-of-3
cp one.csv.2-of-3 copy
refuses 1 'part 2/3 is there twice, .one.csv.2-of-3. and .copy.' 'doubled' $cart --join \
  one.csv.2-of-3 copy
expect 0 'a half' $cart --out one.csv --part 1/2
refuses 1 'one.csv.1-of-2. is one of 2 parts, but the files before it are of 3' 'mixed' $cart \
  --join one.csv.3-of-3 one.csv.1-of-2
refuses 1 'whole.csv. is no part of a sweep' 'no part' $cart --join whole.csv
refuses 1 'cannot read .none.: No such file' 'no file' $cart --join $parts none
for size in 0 80 300; do
  head -c $size one.csv.1-of-3 >damaged
  refuses 1 'is no part of a sweep\|has [0-9] of its 10 points.*part 1/3 goes on' \
    "cut to $size bytes" $cart --join damaged
done
sed '3s/,0\.[23],/,0.7,/' one.csv.1-of-3 >damaged
refuses 1 'has 1 of its 10 points: it is unfinished, cut short or damaged' 'another digit' \
  $cart --join damaged
sed 's/part 1/part 2/' one.csv.1-of-3 >damaged
refuses 1 'damaged. has 0 of its 9 points' 'another number of the part' $cart --join damaged
for k in 0/3 4/3 1 1/0 1/ -1/3 1/3/3 1.5/3 1/99999999999999999999; do
  refuses 2 '--part wants K/N' "part $k" $cart --part $k
done
refuses 2 'exclude each other' 'part and join' $cart --part 1/3 --join $parts
refuses 2 '--join needs a value' 'no files' $cart --join
refuses 2 '--join needs a value' 'one word' $cart --join=one.csv.1-of-3
expect 2 'over a part' $cart --out ./one.csv.1-of-3 --join $parts
says err 'is one of the parts' 'the reason'

# Tasks of a job array, by the environment that Slurm sets.
task() { # ID MIN MAX COUNT STEP
  SLURM_ARRAY_TASK_ID=$1 SLURM_ARRAY_TASK_MIN=$2 SLURM_ARRAY_TASK_MAX=$3
  SLURM_ARRAY_TASK_COUNT=$4 SLURM_ARRAY_TASK_STEP=$5
  export SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_MIN SLURM_ARRAY_TASK_MAX SLURM_ARRAY_TASK_COUNT \
    SLURM_ARRAY_TASK_STEP
}
expect 0 'one machine' $cart --out whole.csv
refuses 2 'this is no task of a job array' 'no array' $cart --part slurm
for id in 3 5 7; do
  task $id 3 8 3 2
  expect 0 "task $id of 3-8:2" $cart --out array.csv --part slurm
done
expect 0 'the join of the tasks' $cart --out array.csv --join array.csv.*-of-3
same array.csv whole.csv 'tasks of an array'
task 2 2 2 1 1
refuses 2 'scontrol requeue' 'a task alone' $cart --part slurm
for bad in '2 1 4 3 1' '4 1 4 3 2' '1 2 4 3 1' '6 1 5 3 2' '1 1 3 3 0'; do
  task $bad
  refuses 2 'no equal gaps' "task $bad" $cart --part slurm
done
task x 1 3 3 1
refuses 2 'this is no task of a job array' 'a task without a number' $cart --part slurm
unset SLURM_ARRAY_TASK_ID

# A killed part goes on, also behind a torn row, and is refused by a join until then.
end=60
[ -z "${DVI_TEST_FEWER:-}" ] || end=20
long="sweep cart.yaml --set l=0.5 --set m=0.2 --set g=9:10:24 --t-end $end --out cut.csv"
"$dvi" $long --threads 1 --part 2/2 2>err &
for _ in $(seq 200); do
  [ "$(cat cut.csv.2-of-2 2>/dev/null | wc -l)" -ge 3 ] && break
  sleep 0.01
done
kill -9 $! 2>/dev/null
# on a busy machine all rows may be there by now
wait $! || [ $? -eq 137 ] || fail 'a killed part'
head -n 3 cut.csv.2-of-2 >rows
printf '17 0 00' >>rows
mv rows cut.csv.2-of-2
expect 0 'the other part' $long --part 1/2
expect 1 'joined too early' $long --join cut.csv.1-of-2 cut.csv.2-of-2
says err 'the command of part 2/2 goes on from there' 'the remedy'
[ ! -e cut.csv ] || fail 'a refused join wrote a file'
expect 1 'another step' $long --h 0.01 --part 2/2
says err 'was begun with another scene or other settings' 'the reason'
head -c 30 cut.csv.1-of-2 >torn
expect 0 'the killed part' $long --part 2/2
says err 'of 12 points are in .cut.csv.2-of-2. already' 'it went on'
mv torn cut.csv.1-of-2
expect 0 'a part that was killed in its first line' $long --part 1/2
expect 0 'joined' $long --join cut.csv.1-of-2 cut.csv.2-of-2
mv cut.csv cut_joined.csv
expect 0 'one machine' $long
same cut_joined.csv cut.csv 'as if nothing had happened'

# GNU parallel runs the parts, as the page on clusters says.
if parallel --version 2>/dev/null | grep -q '^GNU parallel'; then
  HOME=$folder parallel --will-cite -j 2 "$dvi" $cart --out p.csv --part {}/4 ::: 1 2 3 4 ||
    fail 'GNU parallel'
  expect 0 'joined' $cart --out p.csv --join p.csv.*-of-4
  same p.csv whole.csv 'parts by GNU parallel'
  # Methods of an order study, of which only the process times differ.
  study='order kepler --h 0.02 --levels 4 --t-end 1'
  expect 0 'two methods' $study --method midpoint --method verlet --csv all.csv
  HOME=$folder parallel --will-cite -j 2 "$dvi" $study --method {} --csv order-{#}.csv \
    ::: midpoint verlet >out || fail 'orders by GNU parallel'
  awk 'FNR > 1 || NR == 1' order-?.csv | cut -d, -f1-7,9- >joined
  cut -d, -f1-7,9- all.csv >whole
  same joined whole 'tables of methods by GNU parallel'
else
  echo 'no GNU parallel (package parallel): parts are run one after the other only'
fi
}
no_trace 'parts'
finish
