/* Functions shared by the functions of the grammar. */
#include "scene/text/parser.h"

#include <string.h>

#include "text/utf8.h"

enum { LEVELS_MAX = 64 };

static bool parser_no_memory(const dvi__parser *p)
{
  return dvi__complain_of_memory(p->complaint);
}

bool dvi__parser_next(dvi__parser *p)
{
  p->last = p->token.span.first + p->token.span.size;
  if (!dvi__token_read(p->source, p->last, p->end, p->complaint, &p->token)) return false;
  if (p->token.kind == DVI__TOKEN_END)
    p->token.span.first = p->last; /* behind the last word, before blanks and comments */
  return true;
}

bool dvi__parser_enter(dvi__parser *p)
{
  if (p->depth == LEVELS_MAX)
    return dvi__complain(p->complaint, DVI_BAD_SIZE, p->token.span,
                         "more than %d levels of nesting; name a part of it in definitions",
                         LEVELS_MAX);
  p->depth++;
  return true;
}

bool dvi__parser_is_at(const dvi__parser *p, const char *word)
{
  return p->token.kind == DVI__TOKEN_NAME && p->token.span.size == strlen(word) &&
         strncmp(p->source->text + p->token.span.first, word, p->token.span.size) == 0;
}

/* Return true if YAML ended the text at a comma, as it does in {..} and [..]. */
static bool ends_at_comma(const dvi__parser *p)
{
  size_t at = p->end;
  while (at < p->source->size && dvi__is_blank(p->source->text[at])) at++;
  return at < p->source->size && p->source->text[at] == ',';
}

bool dvi__parser_expect(dvi__parser *p, int kind, const char *spelling, dvi__span open)
{
  if (p->token.kind == kind) return dvi__parser_next(p);
  if (p->token.kind == DVI__TOKEN_END && open.size == 1)
    return dvi__complain(p->complaint, DVI_BAD_FILE, open, "this '%c' is never closed%s",
                         p->source->text[open.first],
                         ends_at_comma(p) ? "; within {..} or [..] a text with commas needs quotes"
                                          : "");
  return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                       "found " DVI__FOUND_FORMAT " where %s is expected", DVI__FOUND(p), spelling);
}

bool dvi__parser_node(const dvi__parser *p, dvi__form form, size_t first, const dvi__row *parts,
                      dvi__expression **result)
{
  *result = dvi__arena_take(p->arena, 1, sizeof **result);
  if (*result == NULL) return parser_no_memory(p);
  **result = (dvi__expression){.form = form, .span = {first, p->last - first}};
  if (parts == NULL) return true;
  (*result)->count = (int)parts->count;
  (*result)->part = parts->part;
  return true;
}

bool dvi__row_add(const dvi__parser *p, dvi__row *parts, dvi__expression *part)
{
  dvi__expression **grown = dvi__arena_grow(p->arena, parts->part, parts->count,
                                            sizeof(dvi__expression *));
  if (grown == NULL) return parser_no_memory(p);
  grown[parts->count++] = part;
  parts->part = grown;
  return true;
}

bool dvi__parser_join(const dvi__parser *p, dvi__form form, dvi__expression *left,
                      dvi__expression *right, dvi__expression **result)
{
  dvi__row parts = {0};
  if (!dvi__row_add(p, &parts, left) || (right != NULL && !dvi__row_add(p, &parts, right)))
    return false;
  return dvi__parser_node(p, form, left->span.first, &parts, result);
}

const char *dvi__parser_copy(const dvi__parser *p)
{
  const char *copy = dvi__arena_text(p->arena, p->source->text + p->token.span.first,
                                     p->token.span.size);
  if (copy == NULL) (void)parser_no_memory(p);
  return copy;
}

const char *dvi__prefixed_name(const dvi__source *source, dvi__arena *arena, size_t place,
                               const char *name)
{
  const dvi__source_part *part = dvi__source_part_at(source, place);
  if (part == NULL || part->prefix[0] == '\0' || part->keeps(name)) return name;
  const size_t head = strlen(part->prefix), size = strlen(name);
  char *text = dvi__arena_take(arena, head + size + 1, 1);
  if (text == NULL) return NULL;
  memcpy(text, part->prefix, head);
  memcpy(text + head, name, size + 1);
  return text;
}

bool dvi__parser_name(dvi__parser *p, const char **name)
{
  if (p->token.kind != DVI__TOKEN_NAME)
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                         "found " DVI__FOUND_FORMAT " where a name is expected", DVI__FOUND(p));
  *name = dvi__parser_copy(p);
  return *name != NULL && dvi__parser_next(p);
}
