# Make a manual page of what a command prints for --help.
# Usage: dvi run --help | awk -v name=dvi-run -v version=0.1.0 -f manual.awk
# A text has lines "Usage: ...", a summary, "Options:" or "Commands:" with indented rows, further
# paragraphs, and "Examples:".

function roff(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  if (text ~ /^[.']/) text = "\\&" text
  return text
}

function section(title) {
  if (title != at) print ".SH " title
  at = title
}

# Print an option: its word bold, its value in italics, its explanation below.
function put_option(line,   spelled, words, count) {
  spelled = line
  if (substr(line, 26, 1) == " ") spelled = substr(line, 1, 26)
  count = split(spelled, words, " ")
  if (count > 2) count = 2
  line = substr(line, index(line, words[count]) + length(words[count]))
  sub(/^ +/, "", line)
  print ".TP"
  print ".B " roff(words[1]) (count > 1 ? " \\fI" roff(words[2]) "\\fR" : "")
  print roff(line)
}

BEGIN {
  printf ".\\\" Made from %s --help\n", name
  printf ".TH %s 1 \"\" \"dvi %s\" \"User Commands\"\n", toupper(name), version
  print ".ad l"
}

/^Usage: / {
  synopsis = substr($0, 8)
  next
}

synopsis != "" && !described && /^ +dvi / {
  sub(/^ +/, "")
  synopsis = synopsis "\n.br\n" $0
  next
}

# The summary. Its first sentence explains the name.
synopsis != "" && !described && NF {
  summary = summary (summary == "" ? "" : "\n") roff($0)
  next
}

summary != "" && !described {
  described = 1
  short = summary
  gsub(/\n/, " ", short)
  sub(/[.:;].*/, "", short)
  section("NAME")
  print roff(name) " \\- " tolower(substr(short, 1, 1)) substr(short, 2)
  section("SYNOPSIS")
  print roff(synopsis)
  section("DESCRIPTION")
  print summary
  next
}

/^(Options|Commands):$/ {
  section(toupper(substr($0, 1, length($0) - 1)))
  rows = 1
  next
}

/^Examples:$/ || /^A first session:$/ || /^A scene of one's own:$/ {
  section("EXAMPLES")
  print ".PP\n.EX"
  example = 1
  next
}

!NF {
  if (example) print ".EE"
  if (rows || example) at_text = 1
  rows = example = 0
  pending = described
  next
}

rows && /^  --/ { put_option($0); next }

rows {
  gap = match($0, /[^ ]   +/)
  if (substr($0, 26, 2) ~ /^ [^ ]/) {
    gap = 25
    RLENGTH = 2
  }
  spelled = substr($0, 3, gap - 2)
  sub(/ +$/, "", spelled)
  print ".TP"
  print ".B " roff(spelled)
  print roff(substr($0, gap + RLENGTH))
  next
}

{
  if (at_text && !example) section(/^Exit codes:/ ? "EXIT STATUS" : "NOTES")
  if (pending && !example) print ".PP"
  else if (/^  dvi / && !example) print ".br"
  pending = 0
  line = $0
  sub(/^  /, "", line)
  print roff(line)
}

END {
  if (example) print ".EE"
  print ".SH SEE ALSO"
  print name == "dvi" ? "dvi\\-run(1), and the pages of each command" : ".BR dvi (1)"
}
