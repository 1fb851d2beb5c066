# Draws the rooms of a tree by levels, from the includes of its files.
# Usage: awk -v root=lib/src/ -f rooms.awk FILE...
# A room is a folder below root. It stands one level above the highest room that it includes. Beside
# it stand the rooms that it includes, without those that it includes by way of others.
# Exits with 1 and names the rooms if they include each other in a circle.

function folder(path) { return path ~ /\// ? substr(path, 1, match(path, /\/[^\/]*$/) - 1) : "" }

FNR == 1 {
  room = folder(substr(FILENAME, length(root) + 1))
  if (room == "") room = substr(FILENAME, length(root) + 1)
  is_room[room] = 1
}

/^[ \t]*#[ \t]*include[ \t]*"[^"]*\// {
  split($0, part, "\"")
  includes[room, folder(part[2])] = 1
}

# The catalogue includes its own folders without its own name.
function find_target(from, target,   inside) {
  inside = from
  sub(/\/.*/, "", inside)
  inside = inside "/" target
  return !(target in is_room) && inside in is_room ? inside : target
}

function find_arrows(   pair, end, target) {
  for (pair in includes) {
    split(pair, end, SUBSEP)
    target = find_target(end[1], end[2])
    if (target != end[1]) sees[end[1], target] = is_room[target] = 1
  }
}

# Gives the room's level. The rooms on the way to it are marked, so that a circle shows.
function level_of(from, way,   to, below, highest) {
  if (from in level) return level[from]
  if (from in open) {
    print "rooms include each other in a circle:" way " " from \
      ": move the header that closes it into a room below both"
    circle = 1
    return 0
  }
  open[from] = 1
  highest = -1
  for (to in is_room)
    if ((from, to) in sees) {
      below = level_of(to, way " " from " ->")
      if (below > highest) highest = below
    }
  delete open[from]
  return level[from] = highest + 1
}

function is_seen_farther(from, to,   over) {
  for (over in is_room)
    if ((from, over) in sees && over != to)
      if ((over, to) in sees || is_seen_farther(over, to)) return 1
  return 0
}

function list_seen(from,   i, text) {
  text = ""
  for (i = 1; i <= count; i++)
    if ((from, name[i]) in sees && !is_seen_farther(from, name[i]))
      text = text (text == "" ? "" : ", ") name[i]
  return text
}

function sort_rooms(   room, i, j, t) {
  for (room in is_room) name[++count] = room
  for (i = 2; i <= count; i++)
    for (j = i; j > 1 && name[j - 1] > name[j]; j--) {
      t = name[j]
      name[j] = name[j - 1]
      name[j - 1] = t
    }
}

function draw_level(at,   i, first, line) {
  first = 1
  for (i = 1; i <= count; i++)
    if (level[name[i]] == at) {
      line = sprintf("%5s  %-*s  %s", first ? at : "", widest, name[i], list_seen(name[i]))
      sub(/ *$/, "", line)
      print line
      first = 0
    }
}

END {
  find_arrows()
  sort_rooms()
  for (i = 1; i <= count; i++) {
    if (level_of(name[i], "") > top) top = level[name[i]]
    if (length(name[i]) > widest) widest = length(name[i])
  }
  if (circle) exit 1
  printf "level  %-*s  includes\n", widest, "room"
  for (i = top; i >= 0; i--) { print ""; draw_level(i) }
}
