# Sizes and letters of the sources.  Usage: awk -f text.awk FILE...   Prints every breach, exits 1 if there is one.
# A function's body stands between a brace in the first column and the next closing one in the first column. Lines
# that hold nothing but text in quotes, or a member of an initialiser, are not counted.

function breach(line, why) { printf "%s:%d: %s\n", file, line, why; failed = 1 }

function end_of_file() { if (file != "" && lines > 600) breach(lines, "file of " lines " lines; 600 at most") }

FNR == 1 { end_of_file(); file = FILENAME; inside = lines = 0 }

!/^ *(\{?\.[a-z_]+ = |"[^"]*"[,;)}]*$)/ { lines++ }
length($0) > 100 { breach(FNR, "line of " length($0) " columns; 100 at most") }

/^\{/ { inside = lines }
/^\}/ && inside {
  if (lines - inside + 1 > 60) breach(FNR, "function of " (lines - inside + 1) " lines; 60 at most")
  inside = 0
}

/\t/ { breach(FNR, "tab") }
/[ \r]$/ { breach(FNR, "white space at the end of the line") }
/(^|[^A-Za-z_])(TODO|FIXME|XXX|HACK)([^A-Za-z_]|$)/ { breach(FNR, "unfinished work belongs to the tracker, not to the source") }
/[^ -~]/ && /[^\001-\176]/ { breach(FNR, "character outside ASCII") }

END { end_of_file(); exit failed }
