#include "view/layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { ROTATION = 9, CHAIN_LEAST = 3, FAMILY_LEAST = 2 };

/* The names of the coordinates. */
typedef struct names {
  int count;
  word_at at;
  const void *list;
} names;

static const char *name_of(const names *n, int i)
{
  return i < n->count ? n->at(i, n->list) : "";
}

/* ---- groups of names ---- */

/* Return the place where two names of one length differ, if that is the only one, else -1. */
static int only_difference(const char *a, const char *b)
{
  int place = -1;
  if (strlen(a) != strlen(b)) return -1;
  for (int k = 0; a[k] != '\0'; k++) {
    if (a[k] == b[k]) continue;
    if (place >= 0) return -1;
    place = k;
  }
  return place;
}

/* Return the number of coordinates, 2 or 3, of the point that begins at i, or 0, and where its
 * names have the axis. */
static int point_at(const names *n, int i, int *axis)
{
  const char *x = name_of(n, i), *y = name_of(n, i + 1), *z = name_of(n, i + 2);
  *axis = only_difference(x, y);
  if (*axis < 0 || x[*axis] != 'x' || y[*axis] != 'y') return 0;
  return only_difference(x, z) == *axis && z[*axis] == 'z' ? 3 : 2;
}

/* Return whether nine names from i on are those of a matrix, with the place of their digits. */
static bool rotation_at(const names *n, int i, int *digits)
{
  const char *first = name_of(n, i), *eleven = NULL;
  for (const char *at = strstr(first, "11"); at != NULL; at = strstr(at + 1, "11"))
    if (at > first && (at[-1] == 'R' || at[-1] == '_')) eleven = at;
  if (eleven == NULL) return false;
  *digits = (int)(eleven - first);
  for (int k = 0; k < ROTATION; k++) {
    const char *name = name_of(n, i + k);
    if (strlen(name) != strlen(first) || strncmp(name, first, (size_t)*digits) != 0 ||
        name[*digits] != '1' + k / 3 || name[*digits + 1] != '1' + k % 3)
      return false;
  }
  return true;
}

static bool angle_at(const names *n, int i, size_t *stem)
{
  const char *cosine = name_of(n, i), *sine = name_of(n, i + 1), *end = strrchr(cosine, '_');
  if (end == NULL || strcmp(end, "_cos") != 0) return false;
  *stem = (size_t)(end - cosine);
  return strncmp(cosine, sine, *stem) == 0 && strcmp(sine + *stem, "_sin") == 0;
}

/* Read the indices at the end of a name, one or two, as q_3, q3 or u_1_2. Returns their number. */
static int indices_of(const char *name, int index[2], size_t *stem)
{
  size_t end = strlen(name);
  int count = 0;
  while (count < 2) {
    size_t at = end;
    while (at > 0 && name[at - 1] >= '0' && name[at - 1] <= '9') at--;
    if (at == end || at == 0 || (count == 1 && name[end] != '_')) break;
    if (count == 1) index[1] = index[0];
    index[0] = (int)strtol(name + at, NULL, 10);
    count++;
    end = at - (name[at - 1] == '_');
    if (name[at - 1] != '_') break;
  }
  *stem = end;
  return count;
}

/* Return whether the names i and next belong to one chain or net. */
static bool is_next(const names *n, int i, int next)
{
  int a[2] = {0}, b[2] = {0};
  size_t stem, other;
  const int count = indices_of(name_of(n, i), a, &stem);
  return count > 0 && count == indices_of(name_of(n, next), b, &other) && stem == other &&
         strncmp(name_of(n, i), name_of(n, next), stem) == 0;
}

/* ---- points and bodies ---- */

static view_point *add_point(view_layout *layout, const char *name, size_t length)
{
  view_point *p = &layout->point[layout->points++];
  *p = (view_point){.from = {VIEW_NONE, VIEW_NONE, VIEW_NONE}};
  (void)snprintf(p->name, sizeof p->name, "%.*s", (int)length, name);
  return p;
}

static void add_coordinates(view_layout *layout, view_point *p, int first, int count)
{
  for (int k = 0; k < count; k++) {
    p->from[k] = first + k;
    layout->owner[first + k] = (int)(p - layout->point);
  }
}

/* Cut the axis and the _ before it out of a name, as in q_2_x, x_1 and x1. */
static void name_point(view_point *p, const char *name, int axis)
{
  const char *rest = name + axis + 1;
  int end = axis;
  if (end > 0 && name[end - 1] == '_')
    end--;
  else if (end == 0 && *rest == '_')
    rest++;
  (void)snprintf(p->name, sizeof p->name, "%.*s%s", end, name, rest);
  if (p->name[0] == '\0') (void)snprintf(p->name, sizeof p->name, "point");
}

static int take_point(view_layout *layout, const names *n, int i)
{
  int axis;
  const int size = point_at(n, i, &axis);
  if (size == 0) return 0;
  view_point *p = add_point(layout, "", 0);
  name_point(p, name_of(n, i), axis);
  add_coordinates(layout, p, i, size);
  if (size == 3) layout->is_plane = false;
  return size;
}

/* Take a rotation, or a motion, whose place follows its rotation and has the same stem. */
static int take_body(view_layout *layout, const names *n, int i)
{
  int digits, axis;
  if (!rotation_at(n, i, &digits)) return 0;
  view_body *body = &layout->body[layout->bodies++];
  const char *first = name_of(n, i), *place = name_of(n, i + ROTATION);
  int letter = digits - 1;
  while (letter > 0 && first[letter] != 'R') letter--;
  *body = (view_body){.rotation = i, .point = VIEW_NONE};
  const int stem = first[digits - 1] == '_' ? digits - 1 : digits;
  (void)snprintf(body->name, sizeof body->name, "%.*s%s", stem, first, first + digits + 2);
  layout->is_plane = false;
  int taken = ROTATION;
  if (point_at(n, i + ROTATION, &axis) == 3 && strncmp(first, place, (size_t)letter) == 0 &&
      place[letter] == 'x') {
    body->point = layout->points;
    taken += take_point(layout, n, i + ROTATION);
  }
  for (int k = 0; k < ROTATION; k++) layout->owner[i + k] = body->point;
  return taken;
}

/* Return whether the names from i and from `other` on differ in their first letter only, which is
 * that axis, and are one net or chain. */
static bool is_axis_of(const names *n, int i, int other, int count, char axis)
{
  for (int k = 0; k < count; k++) {
    const char *first = name_of(n, i + k), *name = name_of(n, other + k);
    if (name[0] != axis || strcmp(first + 1, name + 1) != 0) return false;
  }
  return true;
}

/* Take the points of a net or chain whose axes are families of their own, x_1_1, x_1_2 .. and
 * y_1_1, y_1_2 .. Returns the number of coordinates. */
static int take_families(view_layout *layout, const names *n, int i)
{
  int count = 1;
  if (name_of(n, i)[0] != 'x') return 0;
  while (is_next(n, i, i + count)) count++;
  if (count < FAMILY_LEAST || !is_axis_of(n, i, i + count, count, 'y')) return 0;
  const int axes = is_axis_of(n, i, i + 2 * count, count, 'z') ? 3 : 2;
  for (int k = 0; k < count; k++) {
    view_point *p = add_point(layout, "", 0);
    name_point(p, name_of(n, i + k), 0);
    for (int a = 0; a < axes; a++) {
      p->from[a] = i + a * count + k;
      layout->owner[p->from[a]] = (int)(p - layout->point);
    }
  }
  if (axes == 3) layout->is_plane = false;
  return axes * count;
}

static int take_angle(view_layout *layout, const names *n, int i)
{
  size_t stem;
  if (!angle_at(n, i, &stem)) return 0;
  add_coordinates(layout, add_point(layout, name_of(n, i), stem), i, 2);
  return 2;
}

/* ---- numbers alone ---- */

/* Draw the numbers of a chain or of a net as heights over their indices. Links follow those in the
 * chain, and in both directions of a net. */
static bool take_chain(view_layout *layout, const names *n, int first, int count)
{
  int start[2] = {0}, index[2] = {0}, row = 0;
  size_t stem;
  const int indices = indices_of(name_of(n, first), start, &stem), begin = layout->points;
  bool good = true;
  layout->is_chain = true;
  layout->is_plane = layout->is_plane && indices == 1;
  for (int k = 0; k < count && good; k++) {
    const char *name = name_of(n, first + k);
    (void)indices_of(name, index, &stem);
    view_point *p = add_point(layout, name, strlen(name));
    p->fixed[0] = index[0] - start[0];
    p->fixed[1] = indices == 2 ? index[1] - start[1] : 0;
    if (row == 0 && index[0] != start[0]) row = k;
    p->from[indices] = first + k;
    layout->owner[first + k] = begin + k;
    if (k > 0 && (indices == 1 || index[1] != start[1]))
      good = layout_link(layout, begin + k - 1, begin + k);
    if (good && indices == 2 && row > 0) good = layout_link(layout, begin + k - row, begin + k);
  }
  return good;
}

/* Draw numbers that are neither points nor bodies. */
static bool take_numbers(view_layout *layout, const names *n)
{
  for (int i = 0, count; i < n->count; i += count) {
    for (count = 1; i + count < n->count && is_next(n, i, i + count);) count++;
    if (count >= CHAIN_LEAST && !take_chain(layout, n, i, count)) return false;
  }
  if (layout->points > 0 || n->count == 0) return true;
  const int count = n->count < 3 ? n->count : 3;
  add_coordinates(layout, add_point(layout, "state", 5), 0, count);
  layout->is_plane = count < 3;
  layout->is_state = true;
  return true;
}

/* Place bodies that have no place side by side, as the sections of a rod. A single one is at
 * the origin. */
static void spread_bodies(view_layout *layout)
{
  const bool have_places = layout->points > 0;
  for (int k = 0; k < layout->bodies && layout->bodies > 1 && !have_places; k++) {
    const char *name = layout->body[k].name;
    view_point *p = add_point(layout, name, strlen(name));
    p->fixed[0] = k;
    layout->body[k].point = layout->points - 1;
  }
}

bool layout_find(int coordinates, word_at name_at, const void *list, view_layout *layout)
{
  const names n = {.count = coordinates, .at = name_at, .list = list};
  const size_t room = (size_t)coordinates + 1;
  *layout = (view_layout){.point = calloc(room, sizeof *layout->point),
                          .body = calloc(room / ROTATION + 1, sizeof *layout->body),
                          .owner = calloc(room, sizeof *layout->owner),
                          .is_plane = true};
  bool good = layout->point != NULL && layout->body != NULL && layout->owner != NULL;
  for (int i = 0; i < coordinates && good; i++) layout->owner[i] = VIEW_NONE;
  for (int i = 0, taken; i < coordinates && good; i += taken > 0 ? taken : 1) {
    taken = take_body(layout, &n, i);
    if (taken == 0) taken = take_point(layout, &n, i);
    if (taken == 0) taken = take_families(layout, &n, i);
    if (taken == 0) taken = take_angle(layout, &n, i);
  }
  if (good && layout->points == 0 && layout->bodies == 0) good = take_numbers(layout, &n);
  if (good) spread_bodies(layout);
  if (!good) complain("out of memory");
  return good;
}

bool layout_link(view_layout *layout, int from, int to)
{
  if (layout->links == layout->link_room) {
    const int room = 2 * layout->link_room + 16;
    view_link *grown = realloc(layout->link, (size_t)room * sizeof *grown);
    if (grown == NULL) return false;
    layout->link = grown;
    layout->link_room = room;
  }
  layout->link[layout->links++] = (view_link){from, to};
  return true;
}

int layout_point(const view_layout *layout, const char *name)
{
  for (int k = 0; k < layout->points; k++)
    if (strcmp(layout->point[k].name, name) == 0) return k;
  return VIEW_NONE;
}

void layout_clear(view_layout *layout)
{
  free(layout->point);
  free(layout->body);
  free(layout->link);
  free(layout->owner);
  memset(layout, 0, sizeof *layout);
}
