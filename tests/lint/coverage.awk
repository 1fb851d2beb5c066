# Prints a row a room from the summaries of `gcov -b -n`: lines executed, and branches taken at
# least once.
# Usage: awk -v root=/top/lib/src/ -f coverage.awk SUMMARIES

function amount(text) { sub(/.* of /, "", text); return text + 0 }
function share(text) { sub(/.*:/, "", text); return text / 100 }
function percent(part, whole) { return whole > 0 ? sprintf("%.2f %%", 100 * part / whole) : "" }
function row(name, at) {
  printf "| %-20s | %5d | %9s | %8d | %9s |\n", name, lines[at], percent(run[at], lines[at]),
    branches[at], percent(taken[at], branches[at])
}

/^File / {
  room = ""
  path = substr($0, 7, length($0) - 7)
  if (index(path, root) == 1) {
    room = substr(path, length(root) + 1)
    if (!sub(/\/[^\/]*$/, "", room)) room = "."
    if (!(room in lines)) { order[++rooms] = room; lines[room] = 0 }
  }
}
/^Lines executed:/ && room != "" { n = amount($0); lines[room] += n; run[room] += n * share($2) }
/^Taken at least once:/ && room != "" {
  n = amount($0)
  branches[room] += n
  taken[room] += n * share($4)
}
/^(Calls executed|No calls)/ { room = "" } # the sum of all files comes last, and has none

END {
  print "| room                 | lines | executed  | branches | taken     |"
  print "|----------------------|-------|-----------|----------|-----------|"
  for (i = 2; i <= rooms; i++)
    for (j = i; j > 1 && order[j - 1] > order[j]; j--) {
      t = order[j]
      order[j] = order[j - 1]
      order[j - 1] = t
    }
  for (i = 1; i <= rooms; i++) {
    row(order[i], order[i])
    lines[0] += lines[order[i]]
    run[0] += run[order[i]]
    branches[0] += branches[order[i]]
    taken[0] += taken[order[i]]
  }
  row("all", 0)
}
