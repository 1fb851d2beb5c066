/* Errors as compilers print them, with the place, the sentence, the line and a caret. Whatever a
 * hostile file holds, the message can be printed and is of bounded length. */
#include "text/complaint.h"
#include "text/heap.h"
#include "text/utf8.h"

#include <dvi/number.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum {
  SHOWN = 114,   /* most characters of a line */
  BEFORE = 70,   /* most characters before the caret, where the line is cut */
  WORD_MAX = 63, /* most letters of words that are compared */
  LISTED_MOST = 12,
  SENTENCE = 1024 /* in bytes */
};

int dvi__print(char *text, size_t size, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  const int length = dvi_number_vprint(text, size, format, arguments);
  va_end(arguments);
  return length;
}

/* A message that is being written, as many whole characters as fit. */
typedef struct writer {
  char *text;
  size_t size, used;
} writer;

static void put_bytes(writer *w, const char *bytes, size_t count)
{
  if (w->size < count + 1 || w->used > w->size - count - 1) {
    w->size = w->used + 1; /* nothing is written after a part that did not fit */
    return;
  }
  memcpy(w->text + w->used, bytes, count);
  w->used += count;
  w->text[w->used] = '\0';
}

static void put_text(writer *w, const char *text)
{
  put_bytes(w, text, strlen(text));
}

static size_t character_width(const char *text, size_t size)
{
  unsigned code = 0;
  const size_t width = dvi__utf8(text, size, &code);
  return width == 0 ? 1 : width;
}

/* Put one character as the message shows it. Tabs stay, because the line of the caret has them,
 * too. Returns the number of bytes. */
static size_t put_shown(writer *w, const char *text, size_t size)
{
  unsigned code = 0;
  const size_t width = dvi__utf8(text, size, &code);
  const int shown = width > 0 && dvi__utf8_printable(code) && code != '\n' && code != '\r';
  if (shown)
    put_bytes(w, text, width);
  else
    put_bytes(w, "?", 1);
  return width == 0 ? 1 : width;
}

static void put_sentence(writer *w, const char *text)
{
  const size_t length = strlen(text);
  for (size_t k = 0; k < length;) k += put_shown(w, text + k, length - k);
}

const dvi__source_part *dvi__source_part_at(const dvi__source *source, size_t offset)
{
  if (source->part_count == 0) return NULL;
  int k = source->part_count - 1;
  while (k > 0 && source->part[k].first > offset) k--;
  return &source->part[k];
}

const char *dvi__source_name(const dvi__source *source, size_t offset)
{
  const dvi__source_part *part = dvi__source_part_at(source, offset);
  return part == NULL || offset > source->size ? source->name : part->name;
}

/* Return the file of a place as a source of its own, and turn the place to one of it. */
static dvi__source file_of(const dvi__source *source, size_t *offset)
{
  const dvi__source_part *part = dvi__source_part_at(source, *offset);
  if (part == NULL || *offset > source->size) return *source;
  *offset -= part->first;
  return (dvi__source){.name = part->name, .text = source->text + part->first, .size = part->size};
}

static size_t line_start(const dvi__source *source, size_t offset)
{
  while (offset > 0 && source->text[offset - 1] != '\n' && source->text[offset - 1] != '\r')
    offset--;
  return offset;
}

static size_t line_end(const dvi__source *source, size_t offset)
{
  while (offset < source->size && source->text[offset] != '\n' && source->text[offset] != '\r')
    offset++;
  return offset;
}

/* Count the characters between two places. */
static size_t count_characters(const dvi__source *source, size_t from, size_t to)
{
  size_t count = 0;
  for (size_t k = from; k < to; k += character_width(source->text + k, source->size - k)) count++;
  return count;
}

/* Give the place that is so many characters after another one, at most `end`. */
static size_t characters_ahead(const dvi__source *source, size_t from, size_t count, size_t end)
{
  for (; count > 0 && from < end; count--)
    from += character_width(source->text + from, source->size - from);
  return from < end ? from : end;
}

void dvi__source_place(const dvi__source *source, size_t offset, int *line, int *column)
{
  const dvi__source file = file_of(source, &offset);
  if (offset > file.size) offset = file.size;
  *line = 1;
  for (size_t k = 0; k < offset; k++) {
    const char c = file.text[k];
    const int pair = c == '\r' && k + 1 < file.size &&
                     file.text[k + 1] == '\n'; /* the second half of CR LF is counted */
    *line += (c == '\n' || c == '\r') && !pair;
  }
  *column = 1 + (int)count_characters(&file, line_start(&file, offset), offset);
}

/* Put the line with the span's head, cut to a length that can be shown, and a caret under it. */
static void put_excerpt(writer *w, const dvi__source *source, dvi__span where)
{
  size_t first = line_start(source, where.first);
  const size_t line_ends = line_end(source, where.first);
  const size_t before = count_characters(source, first, where.first);
  const int head_cut = before > BEFORE && count_characters(source, first, line_ends) > SHOWN;
  if (head_cut) first = characters_ahead(source, first, before - BEFORE, where.first);
  const size_t last = characters_ahead(source, first, SHOWN, line_ends);
  if (first == last) return;
  put_text(w, head_cut ? "\n  .." : "\n  ");
  for (size_t k = first; k < last;) k += put_shown(w, source->text + k, last - k);
  put_text(w, last < line_ends ? "..\n  " : "\n  ");
  if (head_cut) put_text(w, "  ");
  for (size_t k = first; k < where.first; k += character_width(source->text + k, source->size - k))
    put_text(w, source->text[k] == '\t' ? "\t" : " ");
  put_text(w, "^");
  const size_t end = where.size > last - where.first ? last : where.first + where.size;
  for (size_t k = count_characters(source, where.first, end); k > 1; k--) put_text(w, "~");
}

bool(dvi__complain)(dvi__complaint *complaint, dvi_status status, dvi__span where,
                    const char *format, ...)
{
  if (complaint->status != DVI_OK) return false;
  complaint->status = status;
  if (complaint->message == NULL || complaint->size == 0) return false;
  const dvi__source *source = complaint->source;
  writer w = {.text = complaint->message, .size = complaint->size};
  w.text[0] = '\0';
  put_sentence(&w, dvi__source_name(source, where.first));
  if (where.first <= source->size) {
    int line = 0;
    int column = 0;
    dvi__source_place(source, where.first, &line, &column);
    char place[32];
    (void)snprintf(place, sizeof place, ":%d:%d", line, column);
    put_text(&w, place);
  }
  put_text(&w, ": ");
  char sentence[SENTENCE];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  put_sentence(&w, sentence);
  if (where.first > source->size) return false;
  const dvi__source file = file_of(source, &where.first);
  put_excerpt(&w, &file, where);
  return false;
}

bool(dvi__complain_of_memory)(dvi__complaint *complaint)
{
  if (dvi__heap_refusal() == DVI_BAD_SIZE)
    return dvi__complain(complaint, DVI_BAD_SIZE, DVI__NOWHERE,
                         "more than 1 GiB of memory is needed");
  return dvi__complain(complaint, DVI_NO_MEMORY, DVI__NOWHERE, "memory ran out");
}

bool dvi__complain_of_file(dvi__complaint *complaint, dvi__span where, const char *is)
{
  return dvi__complain(complaint, DVI_BAD_FILE, where,
                       "%s, and no scene: that is a YAML mapping with coordinates, lagrangian, "
                       "initial, step and until; "
                       "dvi init NAME.yaml writes one",
                       is);
}

static int lower_case(char c)
{
  return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

/* Give the cost in half edits. Another letter is a whole edit, the same letter in the other case a
 * half. */
static int cost_of_replacement(char a, char b)
{
  return a == b ? 0 : lower_case(a) == lower_case(b) ? 1 : 2;
}

static int least_edits(int a, int b)
{
  return a < b ? a : b;
}

/* Count insertions, deletions, replacements and exchanges of neighbours between two words, in half
 * edits. Three rows of the table are kept. */
static int count_edits(const char *from, const char *to)
{
  const int columns = (int)strlen(to);
  int row[3][WORD_MAX + 1];
  for (int j = 0; j <= columns; j++) row[0][j] = 2 * j;
  int i = 0;
  while (from[i] != '\0') {
    i++;
    int *here = row[i % 3];
    const int *above = row[(i + 2) % 3];
    const int *second = row[(i + 1) % 3];
    here[0] = 2 * i;
    for (int j = 1; j <= columns; j++) {
      here[j] = least_edits(least_edits(above[j], here[j - 1]) + 2,
                            above[j - 1] + cost_of_replacement(from[i - 1], to[j - 1]));
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1])
        here[j] = least_edits(here[j], second[j - 2] + 2);
    }
  }
  return row[i % 3][columns];
}

const char *dvi__nearest(const char *word, int count, const char *const *candidate, char *hint,
                         size_t size)
{
  if (size > 0) hint[0] = '\0';
  const size_t length = strlen(word);
  if (length > WORD_MAX) return hint;
  int best = 2 * least_edits((int)length,
                             length < 6 ? 3 : 4); /* so many edits make another word, not a slip */
  const char *nearest = NULL;
  for (int k = 0; k < count; k++) {
    if (strlen(candidate[k]) > WORD_MAX || strcmp(candidate[k], word) == 0)
      continue; /* the word is known, but not here */
    const int begun = length > 1 && strncmp(candidate[k], word, length) == 0;
    const int distance = begun ? 2 : count_edits(word, candidate[k]);
    if (distance >= best) continue;
    best = distance;
    nearest = candidate[k];
  }
  if (nearest != NULL) (void)snprintf(hint, size, "; did you mean %s?", nearest);
  return hint;
}

const char *dvi__list_words(int count, const char *const *word, const char *last, char *list,
                            size_t size)
{
  size_t length = 0;
  list[0] = '\0';
  for (int k = 0; k < count && length < size; k++)
    length += (size_t)snprintf(list + length, size - length, "%s%s",
                               k == 0          ? ""
                               : k + 1 < count ? ", "
                                               : last,
                               word[k]);
  return list;
}

const char *dvi__nearest_or_all(const char *word, int count, const char *const *candidate,
                                char *hint, size_t size)
{
  static const char has[] = "; it has ";
  if (dvi__nearest(word, count, candidate, hint, size)[0] != '\0' || count > LISTED_MOST)
    return hint;
  (void)snprintf(hint, size, "%s", has);
  (void)dvi__list_words(count, candidate, " and ", hint + sizeof has - 1, size - (sizeof has - 1));
  return hint;
}
