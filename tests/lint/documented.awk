# Every function and every type with content of a public header follows its comment, or a
# declaration that shares it.
# Prints every breach, and exits with 1 if there is one.
# Usage: awk -f documented.awk HEADER...

function starts_declaration() {
  return /^typedef (struct|enum|union|int|double)/ ||
    /^(const |unsigned )*[a-z][a-z_]* \**dvi_[a-z_0-9]+\(/
}

# An opaque handle needs no comment if its header opens with one: its functions explain it.
function opaque() { return /^typedef struct dvi_[a-z_]+ dvi_[a-z_]+;/ && header_comment }

FNR == 1 { covered = 0; header_comment = /^\/\*\* .*\*\/$/ }

starts_declaration() && !covered && !opaque() {
  printf "%s:%d: no comment: %s\n", FILENAME, FNR, $0
  failed = 1
}

# A comment covers what follows it directly; a blank line ends that.
/\*\/[ ]*$/ && !starts_declaration() { covered = 1; next }
/^$/ { covered = 0 }

END { exit failed }
