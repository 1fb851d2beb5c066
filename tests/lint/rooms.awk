# Draws the rooms of a tree from the includes of its files.  Usage: awk -v root=lib/src/ -f rooms.awk FILE...
# A room is a folder below root.  An arrow is drawn where a room includes another room's headers, unless a longer
# way of arrows says the same.  Rooms stand on floors: a room is one floor above the highest room that it sees.
# Exits with 1, and names the rooms, if arrows run in a circle.

function folder(path) { return path ~ /\// ? substr(path, 1, match(path, /\/[^\/]*$/) - 1) : "." }

FNR == 1 { room = folder(substr(FILENAME, length(root) + 1)); known[room] = 1 }

/^[ \t]*#[ \t]*include[ \t]*"[^"]*\// {
  split($0, part, "\"")
  target = folder(part[2])
  if (target != room) sees[room, target] = known[target] = 1
}

# The room's floor; rooms on the way to it are marked, so that a circle is seen.
function floor_of(from,   to, above, highest) {
  if (from in floor) return floor[from]
  if (from in open) { print "rooms include each other in a circle: " from; circle = 1; return 0 }
  open[from] = 1
  highest = -1
  for (to in known) if ((from, to) in sees) { above = floor_of(to); if (above > highest) highest = above }
  delete open[from]
  return floor[from] = highest + 1
}

# Whether `to` is reached from `from` by two arrows or more.
function is_reached_farther(from, to,   over) {
  for (over in known) if ((from, over) in sees && over != to && ((over, to) in sees || is_reached_farther(over, to))) return 1
  return 0
}

END {
  for (room in known) if (floor_of(room) > top) top = floor[room]
  if (circle) exit 1
  count = 0
  for (room in known) name[++count] = room
  for (i = 2; i <= count; i++) for (j = i; j > 1 && name[j - 1] > name[j]; j--) { t = name[j]; name[j] = name[j - 1]; name[j - 1] = t }
  for (level = top; level >= 0; level--) {
    printf "floor %d\n", level
    for (i = 1; i <= count; i++) if (floor[name[i]] == level) {
      line = ""
      for (j = 1; j <= count; j++) if ((name[i], name[j]) in sees && !is_reached_farther(name[i], name[j])) line = line (line == "" ? "" : ", ") name[j]
      if (line == "") printf "    %s\n", name[i]; else printf "    %-20s -> %s\n", name[i], line
    }
  }
}
