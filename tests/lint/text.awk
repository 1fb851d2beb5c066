# Sizes and letters of the sources.  Usage: awk -f text.awk FILE...   Prints every breach and exits 1 if there is one.
# A function's body stands between a brace in the first column and the next closing one in the first column.

function breach(line, why) { printf "%s:%d: %s\n", file, line, why; failed = 1 }

function end_of_file() { if (file != "" && lines > 500) breach(lines, "file of " lines " lines; 500 at most") }

FNR == 1 { end_of_file(); file = FILENAME; inside = 0 }

{ lines = FNR }

/^\{/ { inside = FNR }
/^\}/ && inside {
  if (FNR - inside + 1 > 60) breach(inside, "function of " (FNR - inside + 1) " lines; 60 at most")
  inside = 0
}

/\t/ { breach(FNR, "tab") }
/[ \r]$/ { breach(FNR, "white space at the end of the line") }
/(^|[^A-Za-z_])(TODO|FIXME|XXX|HACK)([^A-Za-z_]|$)/ { breach(FNR, "unfinished work belongs to the tracker, not to the source") }
/[^ -~]/ && /[^\001-\176]/ { breach(FNR, "character outside ASCII") }

END { end_of_file(); exit failed }
