/* A parser by recursive descent, one function for each line of the grammar:
 *
 *     sum_of   = product { (+|-) product }
 *     product  = signed { (*|/) signed }
 *     signed   = { + | - } power
 *     power    = postfix [ ^ signed ]
 *     postfix  = atom { ' | [ sum_of {, sum_of} ] | . name }
 *     atom     = number | name | name ( sum_of {, sum_of} ) | sum ( range , sum_of )
 *              | if ( any_of , sum_of , sum_of ) | ( any_of ) | [ sum_of {, sum_of} ]
 *     range    = name [< name] [= sum_of .. sum_of]
 *     any_of   = all_of { or all_of }
 *     all_of   = denial { and denial }
 *     denial   = not denial | sum_of { (<|<=|>|>=|==|!=) sum_of }
 *
 * A number may stand wherever a condition may, and the other way round within parentheses:
 * elaboration tells them apart.
 *
 * Chains of + and *, however long, are loops; what nests is counted, so that neither this nor what
 * reads the tree can be driven deep. */
#include "scene/text/syntax.h"

#include "scene/text/lexer.h"
#include "text/utf8.h"

#include <dvi/number.h>
#include <math.h>
#include <string.h>

enum { LEVELS_MAX = 64 };

typedef dvi__expression node;

typedef struct parser {
  const dvi__source *source;
  dvi__arena *arena;
  dvi__complaint *complaint;
  size_t end;       /* of the part that is parsed */
  dvi__token token; /* the one that comes next */
  size_t last;      /* the end of the one before it */
  int depth;        /* 0: what does not stand in anything */
} parser;

/* A row of parts that grows. */
typedef struct row {
  node **part;
  size_t count;
} row;

static bool sum_of(parser *p, node **result);
static bool any_of(parser *p, node **result);

static bool no_memory(const parser *p)
{
  return dvi__complain_of_memory(p->complaint);
}

static bool next(parser *p)
{
  p->last = p->token.span.first + p->token.span.size;
  if (!dvi__token_read(p->source, p->last, p->end, p->complaint, &p->token)) return false;
  if (p->token.kind == DVI__TOKEN_END)
    p->token.span.first = p->last; /* behind the last word, before blanks and comments */
  return true;
}

static bool enter(parser *p)
{
  if (p->depth == LEVELS_MAX)
    return dvi__complain(p->complaint, DVI_BAD_SIZE, p->token.span,
                         "more than %d levels of nesting; name a part of it in definitions",
                         LEVELS_MAX);
  p->depth++;
  return true;
}

/* "found ')'" in words that fit into a sentence: at most 40 letters of what is there. */
#define FOUND_FORMAT "%s%.*s%s"
#define FOUND(p)                                                    \
  (p)->token.kind == DVI__TOKEN_END ? "the end" : "'",              \
      (int)((p)->token.span.size < 40 ? (p)->token.span.size : 40), \
      (p)->source->text + (p)->token.span.first, (p)->token.kind == DVI__TOKEN_END ? "" : "'"

/* Two operands stand beside each other. `left` is the one before. */
static bool refuse_neighbours(const parser *p, const node *left)
{
  const dvi__span l = left->span;
  const dvi__span r = p->token.span;
  const char *text = p->source->text;
  const bool open = p->token.kind == '(';
  if (l.size > 40 || r.size > 40)
    return dvi__complain(p->complaint, DVI_BAD_FILE, r,
                         "an operator is missing here; write * for a product");
  if (left->form == DVI__FORM_NAME && !open)
    return dvi__complain(
        p->complaint, DVI_BAD_FILE, r,
        "an operator is missing here; write %.*s*%.*s for a product, %.*s(%.*s) for a function",
        (int)l.size, text + l.first, (int)r.size, text + r.first, (int)l.size, text + l.first,
        (int)r.size, text + r.first);
  return dvi__complain(p->complaint, DVI_BAD_FILE, r,
                       "an operator is missing here; write %.*s*%.*s%s for a product", (int)l.size,
                       text + l.first, (int)r.size, text + r.first, open ? "..)" : "");
}

/* Whether the token is this word. */
static bool is_word(const parser *p, const char *word)
{
  return p->token.kind == DVI__TOKEN_NAME && p->token.span.size == strlen(word) &&
         strncmp(p->source->text + p->token.span.first, word, p->token.span.size) == 0;
}

/* Words of conditions are no operands. */
static bool joins_conditions(const parser *p)
{
  return is_word(p, "and") || is_word(p, "or") || is_word(p, "not");
}

static bool begins_operand(const parser *p)
{
  if (joins_conditions(p)) return false;
  return p->token.kind == DVI__TOKEN_NUMBER || p->token.kind == DVI__TOKEN_NAME ||
         p->token.kind == '(';
}

/* Whether YAML ended the text at a comma, as it does in {..} and [..]. */
static bool ends_at_comma(const parser *p)
{
  size_t at = p->end;
  while (at < p->source->size && dvi__is_blank(p->source->text[at])) at++;
  return at < p->source->size && p->source->text[at] == ',';
}

/* One token of this kind; `open` is the bracket that it closes, or nowhere. */
static bool expect(parser *p, int kind, const char *spelling, dvi__span open)
{
  if (p->token.kind == kind) return next(p);
  if (p->token.kind == DVI__TOKEN_END && open.size == 1)
    return dvi__complain(p->complaint, DVI_BAD_FILE, open, "this '%c' is never closed%s",
                         p->source->text[open.first],
                         ends_at_comma(p) ? "; within {..} or [..] a text with commas needs quotes"
                                          : "");
  return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                       "found " FOUND_FORMAT " where %s is expected", FOUND(p), spelling);
}

/* A new node that ends with the last token. */
static bool make(const parser *p, dvi__form form, size_t first, const row *parts, node **result)
{
  *result = dvi__arena_take(p->arena, 1, sizeof **result);
  if (*result == NULL) return no_memory(p);
  **result = (node){.form = form, .span = {first, p->last - first}};
  if (parts == NULL) return true;
  (*result)->count = (int)parts->count;
  (*result)->part = parts->part;
  return true;
}

static bool add(const parser *p, row *parts, node *part)
{
  node **grown = dvi__arena_grow(p->arena, parts->part, parts->count, sizeof(node *));
  if (grown == NULL) return no_memory(p);
  grown[parts->count++] = part;
  parts->part = grown;
  return true;
}

/* A node of one part, or of two, which begins with the first of them. */
static bool make_of(const parser *p, dvi__form form, node *left, node *right, node **result)
{
  row parts = {0};
  if (!add(p, &parts, left) || (right != NULL && !add(p, &parts, right))) return false;
  return make(p, form, left->span.first, &parts, result);
}

/* sum_of {, sum_of} and the bracket that closes. */
static bool parts_up_to(parser *p, int kind, const char *spelling, dvi__span open, row *parts)
{
  for (;;) {
    node *part = NULL;
    if (!sum_of(p, &part) || !add(p, parts, part)) return false;
    if (p->token.kind != ',') return expect(p, kind, spelling, open);
    if (!next(p)) return false;
  }
}

/* The text of the token, ended by NUL. */
static const char *copy_of_token(const parser *p)
{
  const char *copy = dvi__arena_text(p->arena, p->source->text + p->token.span.first,
                                     p->token.span.size);
  if (copy == NULL) (void)no_memory(p);
  return copy;
}

static bool take_name(parser *p, const char **name)
{
  if (p->token.kind != DVI__TOKEN_NAME)
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                         "found " FOUND_FORMAT " where a name is expected", FOUND(p));
  *name = copy_of_token(p);
  return *name != NULL && next(p);
}

static bool number(parser *p, node **result)
{
  const dvi__span where = p->token.span;
  const char *digits = copy_of_token(p);
  if (digits == NULL) return false;
  double value = 0.0;
  (void)dvi_number_read(digits, &value);
  if (!isfinite(value))
    return dvi__complain(p->complaint, DVI_BAD_FILE, where,
                         "this number is too large; numbers end at 1.8e308");
  if (!next(p) || !make(p, DVI__FORM_NUMBER, where.first, NULL, result)) return false;
  (*result)->number = value;
  return true;
}

/* What stands behind "sum(": a range, and what is summed. */
static bool sum_over(parser *p, size_t first, dvi__span open, node **result)
{
  const char *name = NULL;
  const char *name2 = NULL;
  node *from = NULL;
  node *to = NULL;
  node *summand = NULL;
  if (!take_name(p, &name)) return false;
  if (p->token.kind == '<') {
    if (!next(p)) return false;
    const dvi__span second = p->token.span;
    if (!take_name(p, &name2)) return false;
    if (strcmp(name, name2) == 0)
      return dvi__complain(p->complaint, DVI_BAD_FILE, second,
                           "the two indices of a pair need two names");
  }
  if (p->token.kind == '=') {
    if (!next(p) || !sum_of(p, &from) || !expect(p, DVI__TOKEN_RANGE, "'..'", open) ||
        !sum_of(p, &to))
      return false;
  }
  const char *expected = from != NULL ? "','" : name2 != NULL ? "',' or '='" : "',', '=' or '<'";
  if (!expect(p, ',', expected, open) || !sum_of(p, &summand) || !expect(p, ')', "')'", open))
    return false;
  row parts = {0};
  if (!add(p, &parts, summand) || (from != NULL && (!add(p, &parts, from) || !add(p, &parts, to))))
    return false;
  if (!make(p, DVI__FORM_SUM, first, &parts, result)) return false;
  (*result)->name = name;
  (*result)->name2 = name2;
  return true;
}

/* What stands behind "if(": a condition, and two alternatives. */
static bool choice(parser *p, size_t first, dvi__span open, node **result)
{
  row parts = {0};
  for (int k = 0; k < 3; k++) {
    node *part = NULL;
    if (!(k == 0 ? any_of(p, &part) : sum_of(p, &part)) || !add(p, &parts, part)) return false;
    if (p->token.kind == '=')
      return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span, "equality is written ==");
    if (!expect(p, k < 2 ? ',' : ')', k < 2 ? "','" : "')'", open)) return false;
  }
  return make(p, DVI__FORM_IF, first, &parts, result);
}

/* A name, or a call. */
static bool named(parser *p, node **result)
{
  const size_t first = p->token.span.first;
  const char *name = NULL;
  if (!take_name(p, &name)) return false;
  const dvi__span open = p->token.span;
  if (p->token.kind != '(') {
    if (!make(p, DVI__FORM_NAME, first, NULL, result)) return false;
    (*result)->name = name;
    return true;
  }
  if (!next(p)) return false;
  if (strcmp(name, "sum") == 0) return sum_over(p, first, open, result);
  if (strcmp(name, "if") == 0) return choice(p, first, open, result);
  row parts = {0};
  if (!parts_up_to(p, ')', "',' or ')'", open, &parts) ||
      !make(p, DVI__FORM_CALL, first, &parts, result))
    return false;
  (*result)->name = name;
  return true;
}

static bool parenthesis(parser *p, node **result)
{
  const dvi__span open = p->token.span;
  if (!next(p) || !any_of(p, result) || !expect(p, ')', "')' or an operator", open)) return false;
  (*result)->span = (dvi__span){open.first, p->last - open.first};
  return true;
}

static bool list(parser *p, node **result)
{
  const dvi__span open = p->token.span;
  row parts = {0};
  if (!next(p) || !parts_up_to(p, ']', "',' or ']'", open, &parts)) return false;
  return make(p, DVI__FORM_LIST, open.first, &parts, result);
}

static bool atom(parser *p, node **result)
{
  switch (joins_conditions(p) ? DVI__TOKEN_END : p->token.kind) {
  case DVI__TOKEN_NUMBER: return number(p, result);
  case DVI__TOKEN_NAME: return named(p, result);
  case '(': return parenthesis(p, result);
  case '[': return list(p, result);
  default:
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                         "found " FOUND_FORMAT " where a number, a name or a bracket is expected",
                         FOUND(p));
  }
}

static bool rate(parser *p, node **result)
{
  if ((*result)->form == DVI__FORM_RATE)
    return dvi__complain(
        p->complaint, DVI_BAD_FILE, p->token.span,
        "there are no second rates x'': expressions have positions and velocities");
  return next(p) && make_of(p, DVI__FORM_RATE, *result, NULL, result);
}

static bool indexed(parser *p, node **result)
{
  const dvi__span open = p->token.span;
  const size_t first = (*result)->span.first;
  row parts = {0};
  if (!next(p) || !add(p, &parts, *result) || !parts_up_to(p, ']', "',' or ']'", open, &parts))
    return false;
  return make(p, DVI__FORM_INDEX, first, &parts, result);
}

static bool member(parser *p, node **result)
{
  const char *name = NULL;
  if (!next(p) || !take_name(p, &name) || !make_of(p, DVI__FORM_MEMBER, *result, NULL, result))
    return false;
  (*result)->name = name;
  return true;
}

static bool postfix(parser *p, node **result)
{
  const int depth = p->depth;
  bool fine = atom(p, result);
  while (fine && (p->token.kind == '\'' || p->token.kind == '[' || p->token.kind == '.')) {
    fine = p->token.kind == '\''  ? rate(p, result)
           : p->token.kind == '[' ? indexed(p, result)
                                  : member(p, result);
    fine = fine && enter(p);
  }
  p->depth = depth;
  return fine && (!begins_operand(p) || refuse_neighbours(p, *result));
}

/* Signs are levels too. */
static bool with_sign(parser *p, node **result)
{
  node *left = NULL;
  node *right = NULL;
  const int kind = p->token.kind;
  const size_t first = p->token.span.first;
  if (!enter(p)) return false;
  if (kind == '+' || kind == '-') {
    if (!next(p) || !with_sign(p, &left)) return false;
    *result = left;
    if (kind == '-' && !make_of(p, DVI__FORM_NEGATIVE, left, NULL, result)) return false;
    (*result)->span = (dvi__span){first, p->last - first};
  } else {
    if (!postfix(p, &left)) return false;
    *result = left;
    if (p->token.kind == '^' &&
        !(next(p) && with_sign(p, &right) && make_of(p, DVI__FORM_POWER, left, right, result)))
      return false;
  }
  p->depth--;
  return true;
}

static bool product(parser *p, node **result)
{
  if (!with_sign(p, result)) return false;
  while (p->token.kind == '*' || p->token.kind == '/') {
    const dvi__form form = p->token.kind == '*' ? DVI__FORM_MULTIPLY : DVI__FORM_DIVIDE;
    node *right = NULL;
    if (!next(p) || !with_sign(p, &right) || !make_of(p, form, *result, right, result))
      return false;
  }
  return true;
}

static bool sum_of(parser *p, node **result)
{
  if (!product(p, result)) return false;
  while (p->token.kind == '+' || p->token.kind == '-') {
    const dvi__form form = p->token.kind == '+' ? DVI__FORM_ADD : DVI__FORM_SUBTRACT;
    node *right = NULL;
    if (!next(p) || !product(p, &right) || !make_of(p, form, *result, right, result)) return false;
  }
  return true;
}

/* ---- conditions ---- */

static const char *comparison(const parser *p)
{
  switch (p->token.kind) {
  case '<': return "<";
  case '>': return ">";
  case DVI__TOKEN_AT_MOST: return "<=";
  case DVI__TOKEN_AT_LEAST: return ">=";
  case DVI__TOKEN_EQUALS: return "==";
  case DVI__TOKEN_DIFFERS: return "!=";
  default: return NULL;
  }
}

/* The parts of a row as one node of a form, or the only part itself. */
static bool make_row(const parser *p, dvi__form form, const row *parts, node **result)
{
  *result = parts->part[0];
  return parts->count == 1 || make(p, form, parts->part[0]->span.first, parts, result);
}

/* a < b < c is a < b and b < c. */
static bool compared(parser *p, node **result)
{
  row parts = {0};
  node *left = NULL, *right = NULL, *made = NULL;
  if (!sum_of(p, &left)) return false;
  *result = left;
  for (const char *name; (name = comparison(p)) != NULL; left = right) {
    if (!next(p) || !sum_of(p, &right) || !make_of(p, DVI__FORM_COMPARE, left, right, &made) ||
        !add(p, &parts, made))
      return false;
    made->name = name;
  }
  return parts.count == 0 || make_row(p, DVI__FORM_AND, &parts, result);
}

static bool denial(parser *p, node **result)
{
  const size_t first = p->token.span.first;
  node *part = NULL;
  row parts = {0};
  if (!is_word(p, "not")) return compared(p, result);
  if (!enter(p) || !next(p) || !denial(p, &part) || !add(p, &parts, part)) return false;
  p->depth--;
  return make(p, DVI__FORM_NOT, first, &parts, result);
}

/* Conditions joined by a word. */
static bool joined(parser *p, const char *word, dvi__form form, bool (*one)(parser *, node **),
                   node **result)
{
  row parts = {0};
  for (;;) {
    node *part = NULL;
    if (!one(p, &part) || !add(p, &parts, part)) return false;
    if (!is_word(p, word)) return make_row(p, form, &parts, result);
    if (!next(p)) return false;
  }
}

static bool all_of(parser *p, node **result)
{
  return joined(p, "and", DVI__FORM_AND, denial, result);
}

static bool any_of(parser *p, node **result)
{
  return joined(p, "or", DVI__FORM_OR, all_of, result);
}

static bool whole(parser *p, node **result)
{
  const bool empty = p->token.kind == DVI__TOKEN_END;
  if (empty)
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                         "an expression is missing here");
  if (!any_of(p, result)) return false;
  if (p->token.kind == ')' || p->token.kind == ']')
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span, "this '%c' closes nothing",
                         p->source->text[p->token.span.first]);
  return expect(p, DVI__TOKEN_END, "an operator or the end", DVI__NOWHERE);
}

bool dvi__expression_parse(const dvi__source *source, dvi__span span, dvi__arena *arena,
                           dvi__complaint *complaint, const dvi__expression **expression)
{
  *expression = NULL;
  parser p = {.source = source,
              .arena = arena,
              .complaint = complaint,
              .end = span.first + span.size,
              .depth = -1,
              .token = {.span = {span.first, 0}}};
  if (!next(&p)) return false;
  node *result = NULL;
  const bool fine = whole(&p, &result);
  *expression = fine ? result : NULL;
  return fine;
}
