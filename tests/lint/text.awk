# Checks the sizes and the letters of the sources. Prints every breach, and exits with 1 if there is
# one.
# Usage: awk -f text.awk FILE...
# In C a function's body stands between a brace in the first column and the next closing one in the
# first column. A file's lines are counted without those that hold only text in quotes, or a member
# of an initialiser.

function breach(line, why) { printf "%s:%d: %s\n", file, line, why; failed = 1 }

function end_of_file() {
  if (file == "" || lines <= 600) return
  breach(lines, "file of " lines " lines, 600 at most: split it by what its functions do")
}

FNR == 1 { end_of_file(); file = FILENAME; inside = lines = 0; c = file ~ /\.[ch]$/ }

!/^ *(\{?\.[a-z_]+ = |"[^"]*"[,;)}]*$)/ { lines++ }
length($0) > 100 {
  breach(FNR, "line of " length($0) " columns, 100 at most: break it where a person would")
}

c && /^\{/ { inside = FNR }
c && /^\}/ && inside {
  count = FNR - inside + 1
  if (count > 60)
    breach(FNR, "function of " count " lines, 60 at most: move a part into a function with a name")
  inside = 0
}

/\t/ { breach(FNR, "tab: write blanks") }
/[ \r]$/ { breach(FNR, "white space at the end of the line: remove it") }
# The brackets keep this line from matching itself.
/(^|[^A-Za-z_])(TOD[O]|FIXM[E]|XX[X]|HAC[K])([^A-Za-z_]|$)/ {
  breach(FNR, "unfinished work: finish it, or move it to the tracker")
}
/[^ -~]/ && /[^\001-\176]/ { breach(FNR, "character outside ASCII: write it in ASCII") }

END { end_of_file(); exit failed }
