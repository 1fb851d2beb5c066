/* Names in a hash table, since a scene of 1 MiB may hold 100000 of them. */
#include "scene/elaborate/names.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "scene/elaborate/hints.h"
#include "scene/elaborate/words.h"

static uint32_t hash_of(const char *text)
{
  uint32_t hash = 2166136261U;
  for (; *text != '\0'; text++) hash = (hash ^ (unsigned char)*text) * 16777619U;
  return hash;
}

/* Return the place of a text in the table, or the free place for it. */
static int name_slot(const dvi__names *names, const char *text)
{
  const int mask = names->table_size - 1;
  int slot = (int)(hash_of(text) & (uint32_t)mask);
  while (names->table[slot] != 0 && strcmp(names->name[names->table[slot] - 1].text, text) != 0)
    slot = (slot + 1) & mask;
  return slot;
}

const dvi__name *dvi__names_find(const dvi__names *names, const char *text)
{
  if (names->count == 0) return NULL;
  const int place = names->table[name_slot(names, text)];
  return place == 0 ? NULL : &names->name[place - 1];
}

/* Make room for one more. The table is at most half full. */
static bool names_grow(dvi__names *names, dvi__arena *arena)
{
  if (names->name != NULL && 2 * names->count < names->table_size) return true;
  const int room = names->count == 0 ? 1 : 2 * names->count;
  dvi__name *moved = dvi__arena_grow(arena, names->name, (size_t)names->count, sizeof *moved);
  int *table = dvi__arena_take(arena, 2 * (size_t)room, sizeof *table);
  if (moved == NULL || table == NULL) return false;
  names->name = moved;
  names->table = table;
  names->table_size = 2 * room;
  for (int i = 0; i < names->count; i++) table[name_slot(names, moved[i].text)] = i + 1;
  return true;
}

bool dvi__is_identifier(const char *text)
{
  static const char mark[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
  return *text != '\0' && (*text < '0' || *text > '9') && text[strspn(text, mark)] == '\0';
}

bool dvi__names_add(dvi__names *names, dvi__arena *arena, dvi__complaint *complaint,
                    const char *text, dvi__span span, dvi__sort sort, int number)
{
  if (!dvi__is_identifier(text))
    return dvi__complain(complaint, DVI_BAD_FILE, span,
                         "'%s' is no name: letters, digits and _, a letter first", text);
  if (dvi__is_word(text))
    return dvi__complain(complaint, DVI_BAD_FILE, span,
                         "'%s' is a word of the language; choose another name", text);
  const dvi__name *other = dvi__names_find(names, text);
  if (other != NULL)
    return dvi__complain(complaint, DVI_BAD_FILE, span, "there is a %s '%s' already",
                         dvi__sort_name(other->sort), text);
  if (!names_grow(names, arena)) return dvi__complain_of_memory(complaint);
  names->name[names->count] = (dvi__name){text, sort, number};
  names->table[name_slot(names, text)] = ++names->count;
  return true;
}

bool(dvi__names_unknown)(const dvi__names *names, dvi__arena *arena, dvi__complaint *complaint,
                         const char *text, dvi__span span)
{
  char hint[96] = "";
  const int words = dvi__word_count(), count = words + names->count;
  const char **candidate = dvi__arena_take(arena, (size_t)count, sizeof *candidate);
  for (int i = 0; candidate != NULL && i < count; i++)
    candidate[i] = i < names->count ? names->name[i].text : dvi__word(i - names->count);
  (void)dvi__hint_of_name(names, text, hint, sizeof hint);
  if (hint[0] == '\0' && candidate != NULL)
    (void)dvi__nearest(text, count, candidate, hint, sizeof hint);
  return dvi__complain(complaint, DVI_BAD_FILE, span, "there is no '%s'%s", text, hint);
}

const char *dvi__sort_name(dvi__sort sort)
{
  static const char *const name[] = {"parameter", "coordinate", "definition", "control"};
  return name[sort];
}

const char *dvi__shape_text(dvi__shape shape, char *text, size_t size)
{
  if (shape.rank == 0)
    (void)snprintf(text, size, "a number");
  else if (shape.rank == 1)
    (void)snprintf(text, size, "a vector of %d", shape.rows);
  else
    (void)snprintf(text, size, "a %d x %d matrix", shape.rows, shape.columns);
  return text;
}
