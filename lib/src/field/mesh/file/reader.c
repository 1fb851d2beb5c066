#include "field/mesh/file/reader.h"

#include <dvi/number.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"

/* ---- the whole file ---- */

/* Read on until the end. The room doubles, so that the copies cost no more than the reading. */
static dvi_status load_stream(FILE *stream, const char *path, unsigned char **byte, size_t *size)
{
  size_t room = 0, got = 1;
  *size = 0;
  for (; got > 0; *size += got) {
    if (*size == room) {
      room = room > 0 ? 2 * room : (size_t)1 << 16;
      unsigned char *more = DVI_NEW(unsigned char, room);
      if (more != NULL && *size > 0) memcpy(more, *byte, *size);
      dvi__release(*byte);
      *byte = more;
      if (more == NULL) return dvi__fail(DVI_NO_MEMORY, "%.300s: no memory for the file", path);
    }
    got = fread(*byte + *size, 1, room - *size, stream);
  }
  return ferror(stream) ? dvi__fail(DVI_IO_ERROR, "cannot read %.300s: %s", path, strerror(errno))
                        : DVI_OK;
}

dvi_status dvi__load(const char *path, unsigned char **byte, size_t *size)
{
  *byte = NULL;
  FILE *stream = fopen(path, "rb");
  if (stream == NULL)
    return dvi__fail(DVI_IO_ERROR, "cannot open %.300s: %s", path, strerror(errno));
  const dvi_status status = load_stream(stream, path, byte, size);
  (void)fclose(stream);
  if (status == DVI_OK) return DVI_OK;
  dvi__release(*byte);
  *byte = NULL;
  return status;
}

/* ---- refusals ---- */

/* Count lines only here: files that are fine need no lines. */
static long long line_of(const dvi__reader *r, size_t place)
{
  long long line = 1;
  for (size_t i = 0; i < place && i < r->size; i++) line += r->byte[i] == '\n';
  return line;
}

dvi_status dvi__reject(const dvi__reader *r, size_t place, const char *format, ...)
{
  char sentence[DVI__SENTENCE_SIZE / 2];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  if (r->is_binary)
    return dvi__fail(DVI_BAD_FILE, "%.300s: byte %zu: %s", r->path, place, sentence);
  return dvi__fail(DVI_BAD_FILE, "%.300s:%lld: %s", r->path, line_of(r, place), sentence);
}

/* The last number of a text may have no blank behind it. */
dvi_status dvi__claim(const dvi__reader *r, const char *things, int64_t count, int64_t text_bytes,
                      int64_t binary_bytes)
{
  const int64_t left = (int64_t)(r->size - r->at),
                most = r->is_binary ? left / binary_bytes : (left + 1) / text_bytes;
  if (count <= most) return DVI_OK;
  return dvi__reject(r, r->mark,
                     "%lld %s are announced, but the file has only %lld bytes more: it is cut, or "
                     "the number is wrong",
                     (long long)count, things, (long long)left);
}

static dvi_status refuse_end(const dvi__reader *r, const char *what)
{
  return dvi__reject(r, r->size, "the file ends where %s is expected", what);
}

/* ---- words ---- */

static int is_blank(unsigned char c)
{
  return c == ' ' || (c >= '\t' && c <= '\r');
}

void dvi__skip_line(dvi__reader *r)
{
  while (r->at < r->size && r->byte[r->at] != '\n') r->at++;
  if (r->at < r->size) r->at++;
}

int dvi__skip_blanks(dvi__reader *r)
{
  for (;;) {
    while (r->at < r->size && is_blank(r->byte[r->at])) r->at++;
    if (r->at == r->size) return 0;
    if (r->comment == 0 || r->byte[r->at] != (unsigned char)r->comment) return 1;
    dvi__skip_line(r);
  }
}

static char printable(unsigned char c)
{
  return (char)(c > ' ' && c < 127 ? c : '?');
}

dvi_status dvi__read_word(dvi__reader *r, const char *what, dvi__word *word)
{
  *word = (dvi__word){.length = 0};
  if (!dvi__skip_blanks(r)) return refuse_end(r, what);
  r->mark = r->at;
  for (; r->at < r->size && !is_blank(r->byte[r->at]); r->at++, word->length++)
    if (word->length + 1 < sizeof word->text) word->text[word->length] = printable(r->byte[r->at]);
  return DVI_OK;
}

static dvi_status refuse_word(const dvi__reader *r, const char *what, const dvi__word *word)
{
  return dvi__reject(r, r->mark, "found \"%s\"%s where %s is expected", word->text,
                     word->length >= sizeof word->text ? ".." : "", what);
}

dvi_status dvi__expect_word(dvi__reader *r, const char *known)
{
  dvi__word word;
  DVI_TRY(dvi__read_word(r, known, &word));
  return strcmp(word.text, known) == 0 ? DVI_OK : refuse_word(r, known, &word);
}

dvi_status dvi__end_line(dvi__reader *r, const char *behind)
{
  while (r->at < r->size && r->byte[r->at] != '\n' && is_blank(r->byte[r->at])) r->at++;
  if (r->at == r->size) return DVI_OK;
  if (r->byte[r->at] == '\n') {
    r->at++;
    return DVI_OK;
  }
  dvi__word word;
  DVI_TRY(dvi__read_word(r, "the end of the line", &word));
  return dvi__reject(r, r->mark, "found \"%s\" behind %s, where the line should end", word.text,
                     behind);
}

/* ---- numbers ---- */

/* Returns 0 if the word is no integer of 64 bits. */
static int integer_of(const dvi__word *word, int64_t *value)
{
  const char *c = word->text;
  const int is_negative = *c == '-';
  uint64_t size = 0;
  if (*c == '-' || *c == '+') c++;
  if (*c == 0 || word->length >= sizeof word->text) return 0;
  for (; *c != 0; c++) {
    if (*c < '0' || *c > '9') return 0;
    const uint64_t digit = (uint64_t)(*c - '0');
    if (size > ((uint64_t)INT64_MAX - digit) / 10) return 0;
    size = 10 * size + digit;
  }
  *value = is_negative ? -(int64_t)size : (int64_t)size;
  return 1;
}

static dvi_status check_range(const dvi__reader *r, const char *what, int64_t least, int64_t most,
                              int64_t value)
{
  if (value >= least && value <= most) return DVI_OK;
  if (most == INT64_MAX || (most == INT32_MAX && value < least))
    return dvi__reject(r, r->mark, "%s is %lld, and must be at least %lld", what, (long long)value,
                       (long long)least);
  return dvi__reject(r, r->mark, "%s is %lld, and must be %lld to %lld", what, (long long)value,
                     (long long)least, (long long)most);
}

dvi_status dvi__read_text_integer(dvi__reader *r, const char *what, int64_t least, int64_t most,
                                  int64_t *value)
{
  dvi__word word;
  *value = 0;
  DVI_TRY(dvi__read_word(r, what, &word));
  if (!integer_of(&word, value)) return refuse_word(r, what, &word);
  return check_range(r, what, least, most, *value);
}

uint64_t dvi__little_endian(const unsigned char *byte, int width)
{
  uint64_t value = 0;
  for (int i = width - 1; i >= 0; i--) value = value << 8 | byte[i];
  return value;
}

dvi_status dvi__read_bytes(dvi__reader *r, const char *what, size_t count,
                           const unsigned char **byte)
{
  r->mark = r->at;
  if (r->size - r->at < count) return refuse_end(r, what);
  *byte = r->byte + r->at;
  r->at += count;
  return DVI_OK;
}

dvi_status dvi__read_integer(dvi__reader *r, const char *what, int width, int64_t least,
                             int64_t most, int64_t *value)
{
  const unsigned char *byte = r->byte;
  if (!r->is_binary) return dvi__read_text_integer(r, what, least, most, value);
  *value = 0;
  DVI_TRY(dvi__read_bytes(r, what, (size_t)width, &byte));
  const uint64_t bits = dvi__little_endian(byte, width);
  *value = width == 4 ? (int64_t)(int32_t)bits : (int64_t)bits;
  return check_range(r, what, least, most, *value);
}

static dvi_status read_text_real(dvi__reader *r, const char *what, double *value)
{
  dvi__word word;
  DVI_TRY(dvi__read_word(r, what, &word));
  const char *end = dvi_number_read(word.text, value);
  if (end == word.text || *end != 0 || word.length >= sizeof word.text)
    return refuse_word(r, what, &word);
  return DVI_OK;
}

static dvi_status read_binary_real(dvi__reader *r, const char *what, double *value)
{
  const unsigned char *byte = r->byte;
  DVI_TRY(dvi__read_bytes(r, what, sizeof *value, &byte));
  const uint64_t bits = dvi__little_endian(byte, sizeof bits);
  memcpy(value, &bits, sizeof bits);
  return DVI_OK;
}

dvi_status dvi__read_real(dvi__reader *r, const char *what, double *value)
{
  *value = 0;
  DVI_TRY(r->is_binary ? read_binary_real(r, what, value) : read_text_real(r, what, value));
  if (isfinite(*value)) return DVI_OK;
  return dvi__reject(r, r->mark, "%s is %g, and must be finite", what, *value);
}
