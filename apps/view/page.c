#include "view/page.h"

#include <stdlib.h>
#include <string.h>

#include "load/catalogue.h"
#include "view/texts.h"

/* ---- the page ---- */

static const catalogue_text *text_of(const char *name)
{
  const catalogue_text *at = page_texts;
  while (at->name != NULL && strcmp(at->name, name) != 0) at++;
  return at;
}

/* Write a part of the page: from behind one of its marks to before another. NULL stands for the
 * ends. */
static void write_part(FILE *stream, const char *from, const char *to)
{
  const catalogue_text *whole = text_of("page");
  const char *begin = whole->text, *end = whole->text + whole->length;
  for (const char *at = whole->text; at < end; at++) {
    const size_t left = (size_t)(end - at);
    if (from != NULL && left >= strlen(from) && memcmp(at, from, strlen(from)) == 0)
      begin = at + strlen(from);
    if (to != NULL && left >= strlen(to) && memcmp(at, to, strlen(to)) == 0) end = at;
  }
  (void)fwrite(begin, 1, (size_t)(end - begin), stream);
}

static const char title_mark[] = "<!-- title -->", run_mark[] = "<!-- run -->",
                  program_mark[] = "<!-- program -->";

static void write_escaped(FILE *stream, const char *text)
{
  for (; *text != '\0'; text++) switch (*text) {
    case '<': (void)fputs("&lt;", stream); break;
    case '&': (void)fputs("&amp;", stream); break;
    default: (void)fputc(*text, stream);
    }
}

void page_begin(page *p, FILE *stream, const char *title)
{
  *p = (page){.stream = stream};
  write_part(stream, NULL, title_mark);
  (void)fputs("<title>", stream);
  write_escaped(stream, title);
  (void)fputs("</title>", stream);
  write_part(stream, title_mark, run_mark);
  (void)fputs("<script type=\"application/json\" id=\"run\">\n", stream);
}

void page_end(page *p)
{
  const catalogue_text *program = text_of("program");
  (void)fputs("\n</script>", p->stream);
  write_part(p->stream, run_mark, program_mark);
  (void)fputs("<script>\n", p->stream);
  (void)fwrite(program->text, 1, program->length, p->stream);
  (void)fputs("</script>", p->stream);
  write_part(p->stream, program_mark, NULL);
}

/* ---- numbers ---- */

void page_text(page *p, const char *text)
{
  (void)fputc('"', p->stream);
  for (; *text != '\0'; text++) {
    const unsigned char c = (unsigned char)*text;
    if (c < ' ' || c == '"' || c == '\\' || c == '<')
      (void)fprintf(p->stream, "\\u%04x", c);
    else
      (void)fputc(c, p->stream);
  }
  (void)fputc('"', p->stream);
}

/* Write the waiting bytes, 1 to 3 of them, as four letters. */
static void write_letters(page *p)
{
  static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (int k = p->waiting; k < 3; k++) p->rest[k] = 0;
  const unsigned bits = (unsigned)p->rest[0] << 16 | (unsigned)p->rest[1] << 8 | p->rest[2];
  for (int k = 0; k < 4; k++)
    (void)fputc(k <= p->waiting ? letter[bits >> (18 - 6 * k) & 63U] : '=', p->stream);
  p->waiting = 0;
}

/* Write a word of 32 bits, its least byte first, as browsers read it on all usual machines. */
static void write_word(page *p, uint32_t word)
{
  for (int k = 0; k < 4; k++) {
    p->rest[p->waiting++] = (unsigned char)(word >> 8 * k & 255U);
    if (p->waiting == 3) write_letters(p);
  }
}

void page_floats_begin(page *p)
{
  (void)fputs("{\"floats\":\"", p->stream);
}

void page_float(page *p, double number)
{
  const float rounded = (float)number;
  uint32_t word;
  memcpy(&word, &rounded, sizeof word);
  write_word(p, word);
}

void page_integers_begin(page *p)
{
  (void)fputs("{\"integers\":\"", p->stream);
}

void page_integer(page *p, int64_t number)
{
  write_word(p, (uint32_t)(int32_t)number);
}

void page_list_end(page *p)
{
  if (p->waiting > 0) write_letters(p);
  (void)fputs("\"}", p->stream);
}
