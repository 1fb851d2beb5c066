#!/bin/sh
# Pages of dvi view in a browser without a window: all controls are pressed (presses.js), and the
# pictures compared with stored ones.  Usage: test_view_browser.sh DVI [--update]
# --update stores the pictures anew. Without a Chromium the test is skipped.
here=$(cd "$(dirname "$0")" && pwd) || exit 1
for browser in chromium-headless-shell chromium chromium-browser ''; do
  command -v "$browser" >/dev/null 2>&1 && break
done
[ -n "$browser" ] || { echo 'no Chromium: the pages are not tested in a browser'; exit 77; }
update=${2:-}
. "$here/../check.sh"
scenes=$here/../../../apps/scenes
HOME=$folder
export HOME

# press PAGE: open the page, press its controls, and leave what was seen in the file seen.
press() {
  {
    sed '/^<\/body>/,$d' "$1"
    echo '<script>'
    cat "$here/presses.js"
    echo '</script></body>'
  } >pressed.html
  timeout 60 "$browser" --headless --no-sandbox --use-angle=swiftshader \
    --enable-unsafe-swiftshader --window-size=700,400 --dump-dom \
    "file://$folder/pressed.html" >dom 2>log
  sed -n '/<pre id="report">/,$s/.*<pre id="report">//; /<\/pre>/,$s/<\/pre>.*//
          /^[a-z][a-z ]*: /p' dom >seen
  says seen '^trouble: none$' "$1"
}

# looks NAME: require the picture that is stored, up to small differences of drawing.
looks() {
  sed -n 's/^picture: //p' seen >picture
  if [ "$update" = --update ]; then cp picture "$here/$1.colours"; fi
  paste -d ' ' picture "$here/$1.colours" | awk '
    { n = NF / 2
      for (i = 1; i <= n; i++) {
        d = $i > $(i + n) ? $i - $(i + n) : $(i + n) - $i
        sum += d
        if (d > most) most = d
        drawn += $i < 250
      }
    }
    END { exit !(n == 1152 && drawn > 20 && sum / n < 2 && most < 60) }' ||
    fail "$1: the picture is another one"
}

# A heavy body and a light one.
expect 0 'bodies' view "$scenes/bodies/two-body.yaml" --out bodies.html
press bodies.html
for line in 'title: two extended bodies that attract each other' 'trails: shown' 'shape: shown' \
  'field: hidden' 'raised: hidden' 'pressed play: Pause' 'played: true' 'paused: true' \
  'faster: true' 'at the end: true' 'then: Play' 'last time: t = ' 'slid: true' \
  'trails changes the picture: true' 'trails changes it back: true' \
  'shape changes the picture: true' 'shape changes it back: true' 'the eye turned: true'; do
  says seen "^$line" "bodies"
done
looks bodies

# A membrane, whose field is drawn in colours.
cat >wave.yaml <<'END'
mesh: {generator: disk, cells: [8]}
field: wave
boundary: fixed
initial: {u: "1 - x^2 - y^2"}
method: leapfrog
step: {fraction: 0.5}
until: 4
END
expect 0 'a field' view wave.yaml --out wave.html
press wave.html
for line in 'trails: hidden' 'shape: hidden' 'field: shown' 'raised: shown' 'played: true' \
  'at the end: true' 'slid: true' 'raised changes the picture: true' 'the eye turned: true'; do
  says seen "^$line" "a field"
done
looks wave
finish
