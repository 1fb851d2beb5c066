# The rows of the registry of sections: name, presence, example and line, with tabs between them.
# Usage: awk -f sections.awk lib/src/scene/sections/sections.def

# All strings from one place on, up to a comma or the end: neighbours are one text. Sets `rest`.
function text_at(s,   text) {
  text = ""
  while (match(s, /^[ \n]*"([^"\\]|\\.)*"/)) {
    text = text substr(s, index(s, "\"") + 1, RLENGTH - index(s, "\"") - 1)
    s = substr(s, RLENGTH + 1)
  }
  rest = s
  return text
}

function print_row(row,   field, name, presence, example) {
  presence = row ~ /^REFUSED_/ ? "REFUSED" : ""
  sub(/^[A-Z_]*\(/, "", row)
  split(row, field, /, */)
  name = field[1]
  row = substr(row, index(row, ",") + 1)
  if (presence == "") {
    presence = field[2]
    row = substr(row, index(row, ",") + 1)
    if (row ~ /^[ \n]*NULL/) sub(/^[ \n]*NULL/, "", row)
    else { example = text_at(row); row = rest }
    sub(/^[ \n]*,/, "", row)
  }
  print name "\t" presence "\t" example "\t" text_at(row)
}

/^(REFUSED_)?SECTION\(/ { inside = 1; row = "" }
inside { row = row $0 "\n" }
inside && /\)$/ { print_row(row); inside = 0 }
