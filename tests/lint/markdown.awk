# Checks that the lines of Markdown end at 100 columns. Prints every breach, and exits with 1 if
# there is one.
# Usage: awk -f markdown.awk FILE...
# Not counted are lines of tables, blocks of commands with their output, and lines that consist of
# one link, one address or one picture, for none of these can be broken. Commands alone can.

FNR == 1 { block = "" }

/^ *```/ {
  block = block == "" ? $0 : ""
  next
}
block ~ /```(console|text)$/ || /^ *\|/ { next }
/^ *([-*] )?!?(\[[^]]*\]\([^)]*\)|<?https?:[^ ]*)[.,:]?$/ { next }

length($0) > 100 {
  printf "%s:%d: line of %d columns, 100 at most: wrap it\n", FILENAME, FNR, length($0)
  failed = 1
}

END { exit failed }
