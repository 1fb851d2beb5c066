/* A parser by recursive descent, one function for each line of the grammar.
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
 * A number may stand in place of a condition, and a condition within parentheses in place of a
 * number. Elaboration tells them apart.
 *
 * Chains of + and *, however long, are loops. Levels of nesting are counted, so that neither this
 * file nor the readers of the tree can be driven deep. */
#include "scene/text/syntax.h"

#include <dvi/number.h>
#include <math.h>
#include <string.h>

#include "scene/text/parser.h"

typedef dvi__expression node;

static bool parse_sum_of(dvi__parser *p, node **result);
static bool parse_any_of(dvi__parser *p, node **result);

/* Refuse two operands beside each other. `left` is the one before. */
static bool refuse_neighbours(const dvi__parser *p, const node *left)
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

/* Return true at a word of conditions, which is no operand. */
static bool joins_conditions(const dvi__parser *p)
{
  return dvi__parser_is_at(p, "and") || dvi__parser_is_at(p, "or") || dvi__parser_is_at(p, "not");
}

static bool begins_operand(const dvi__parser *p)
{
  if (joins_conditions(p)) return false;
  return p->token.kind == DVI__TOKEN_NUMBER || p->token.kind == DVI__TOKEN_NAME ||
         p->token.kind == '(';
}

/* Read sum_of {, sum_of} and the bracket that closes. */
static bool parse_parts(dvi__parser *p, int kind, const char *spelling, dvi__span open,
                        dvi__row *parts)
{
  for (;;) {
    node *part = NULL;
    if (!parse_sum_of(p, &part) || !dvi__row_add(p, parts, part)) return false;
    if (p->token.kind != ',') return dvi__parser_expect(p, kind, spelling, open);
    if (!dvi__parser_next(p)) return false;
  }
}

static bool parse_number_atom(dvi__parser *p, node **result)
{
  const dvi__span where = p->token.span;
  const char *digits = dvi__parser_copy(p);
  if (digits == NULL) return false;
  double value = 0.0;
  (void)dvi_number_read(digits, &value);
  if (!isfinite(value))
    return dvi__complain(p->complaint, DVI_BAD_FILE, where,
                         "this number is too large; numbers end at 1.8e308");
  if (!dvi__parser_next(p) || !dvi__parser_node(p, DVI__FORM_NUMBER, where.first, NULL, result))
    return false;
  (*result)->number = value;
  return true;
}

/* Read a name that the scene gives, with the prefix of its file. */
static bool parse_own_name(dvi__parser *p, const char **name)
{
  const size_t first = p->token.span.first;
  if (!dvi__parser_name(p, name)) return false;
  *name = dvi__prefixed_name(p->source, p->arena, first, *name);
  return *name != NULL || dvi__complain_of_memory(p->complaint);
}

/* Read what stands behind "sum(", a range and the terms. */
static bool parse_sum_over(dvi__parser *p, size_t first, dvi__span open, node **result)
{
  const char *name = NULL;
  const char *name2 = NULL;
  node *from = NULL;
  node *to = NULL;
  node *summand = NULL;
  if (!parse_own_name(p, &name)) return false;
  if (p->token.kind == '<') {
    if (!dvi__parser_next(p)) return false;
    const dvi__span second = p->token.span;
    if (!parse_own_name(p, &name2)) return false;
    if (strcmp(name, name2) == 0)
      return dvi__complain(p->complaint, DVI_BAD_FILE, second,
                           "the two indices of a pair need two names");
  }
  if (p->token.kind == '=') {
    if (!dvi__parser_next(p) || !parse_sum_of(p, &from) ||
        !dvi__parser_expect(p, DVI__TOKEN_RANGE, "'..'", open) || !parse_sum_of(p, &to))
      return false;
  }
  const char *expected = from != NULL ? "','" : name2 != NULL ? "',' or '='" : "',', '=' or '<'";
  if (!dvi__parser_expect(p, ',', expected, open) || !parse_sum_of(p, &summand) ||
      !dvi__parser_expect(p, ')', "')'", open))
    return false;
  dvi__row parts = {0};
  if (!dvi__row_add(p, &parts, summand) ||
      (from != NULL && (!dvi__row_add(p, &parts, from) || !dvi__row_add(p, &parts, to))))
    return false;
  if (!dvi__parser_node(p, DVI__FORM_SUM, first, &parts, result)) return false;
  (*result)->name = name;
  (*result)->name2 = name2;
  return true;
}

/* Read what stands behind "if(", a condition and two alternatives. */
static bool parse_if(dvi__parser *p, size_t first, dvi__span open, node **result)
{
  dvi__row parts = {0};
  for (int k = 0; k < 3; k++) {
    node *part = NULL;
    if (!(k == 0 ? parse_any_of(p, &part) : parse_sum_of(p, &part)) ||
        !dvi__row_add(p, &parts, part))
      return false;
    if (p->token.kind == '=')
      return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span, "equality is written ==");
    if (!dvi__parser_expect(p, k < 2 ? ',' : ')', k < 2 ? "','" : "')'", open)) return false;
  }
  return dvi__parser_node(p, DVI__FORM_IF, first, &parts, result);
}

/* Read a name, or a call. */
static bool parse_name(dvi__parser *p, node **result)
{
  const size_t first = p->token.span.first;
  const char *name = NULL;
  if (!dvi__parser_name(p, &name)) return false;
  const dvi__span open = p->token.span;
  if (p->token.kind != '(') {
    if (!dvi__parser_node(p, DVI__FORM_NAME, first, NULL, result)) return false;
    (*result)->name = dvi__prefixed_name(p->source, p->arena, first, name);
    return (*result)->name != NULL || dvi__complain_of_memory(p->complaint);
  }
  if (!dvi__parser_next(p)) return false;
  if (strcmp(name, "sum") == 0) return parse_sum_over(p, first, open, result);
  if (strcmp(name, "if") == 0) return parse_if(p, first, open, result);
  dvi__row parts = {0};
  if (!parse_parts(p, ')', "',' or ')'", open, &parts) ||
      !dvi__parser_node(p, DVI__FORM_CALL, first, &parts, result))
    return false;
  (*result)->name = name;
  return true;
}

static bool parse_parenthesis(dvi__parser *p, node **result)
{
  const dvi__span open = p->token.span;
  if (!dvi__parser_next(p) || !parse_any_of(p, result) ||
      !dvi__parser_expect(p, ')', "')' or an operator", open))
    return false;
  (*result)->span = (dvi__span){open.first, p->last - open.first};
  return true;
}

static bool parse_list_atom(dvi__parser *p, node **result)
{
  const dvi__span open = p->token.span;
  dvi__row parts = {0};
  if (!dvi__parser_next(p) || !parse_parts(p, ']', "',' or ']'", open, &parts)) return false;
  return dvi__parser_node(p, DVI__FORM_LIST, open.first, &parts, result);
}

static bool parse_atom(dvi__parser *p, node **result)
{
  switch (joins_conditions(p) ? DVI__TOKEN_END : p->token.kind) {
  case DVI__TOKEN_NUMBER: return parse_number_atom(p, result);
  case DVI__TOKEN_NAME: return parse_name(p, result);
  case '(': return parse_parenthesis(p, result);
  case '[': return parse_list_atom(p, result);
  default:
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                         "found " DVI__FOUND_FORMAT
                         " where a number, a name or a bracket is expected",
                         DVI__FOUND(p));
  }
}

static bool parse_rate(dvi__parser *p, node **result)
{
  if ((*result)->form == DVI__FORM_RATE)
    return dvi__complain(
        p->complaint, DVI_BAD_FILE, p->token.span,
        "there are no second rates x'': expressions have positions and velocities");
  return dvi__parser_next(p) && dvi__parser_join(p, DVI__FORM_RATE, *result, NULL, result);
}

static bool parse_index(dvi__parser *p, node **result)
{
  const dvi__span open = p->token.span;
  const size_t first = (*result)->span.first;
  dvi__row parts = {0};
  if (!dvi__parser_next(p) || !dvi__row_add(p, &parts, *result) ||
      !parse_parts(p, ']', "',' or ']'", open, &parts))
    return false;
  return dvi__parser_node(p, DVI__FORM_INDEX, first, &parts, result);
}

static bool parse_member(dvi__parser *p, node **result)
{
  const char *name = NULL;
  if (!dvi__parser_next(p) || !dvi__parser_name(p, &name) ||
      !dvi__parser_join(p, DVI__FORM_MEMBER, *result, NULL, result))
    return false;
  (*result)->name = name;
  return true;
}

static bool parse_postfix(dvi__parser *p, node **result)
{
  const int depth = p->depth;
  bool fine = parse_atom(p, result);
  while (fine && (p->token.kind == '\'' || p->token.kind == '[' || p->token.kind == '.')) {
    fine = p->token.kind == '\''  ? parse_rate(p, result)
           : p->token.kind == '[' ? parse_index(p, result)
                                  : parse_member(p, result);
    fine = fine && dvi__parser_enter(p);
  }
  p->depth = depth;
  return fine && (!begins_operand(p) || refuse_neighbours(p, *result));
}

/* Read signs, which are levels, too. */
static bool parse_signed(dvi__parser *p, node **result)
{
  node *left = NULL;
  node *right = NULL;
  const int kind = p->token.kind;
  const size_t first = p->token.span.first;
  if (!dvi__parser_enter(p)) return false;
  if (kind == '+' || kind == '-') {
    if (!dvi__parser_next(p) || !parse_signed(p, &left)) return false;
    *result = left;
    if (kind == '-' && !dvi__parser_join(p, DVI__FORM_NEGATIVE, left, NULL, result)) return false;
    (*result)->span = (dvi__span){first, p->last - first};
  } else {
    if (!parse_postfix(p, &left)) return false;
    *result = left;
    if (p->token.kind == '^' && !(dvi__parser_next(p) && parse_signed(p, &right) &&
                                  dvi__parser_join(p, DVI__FORM_POWER, left, right, result)))
      return false;
  }
  p->depth--;
  return true;
}

static bool parse_product(dvi__parser *p, node **result)
{
  if (!parse_signed(p, result)) return false;
  while (p->token.kind == '*' || p->token.kind == '/') {
    const dvi__form form = p->token.kind == '*' ? DVI__FORM_MULTIPLY : DVI__FORM_DIVIDE;
    node *right = NULL;
    if (!dvi__parser_next(p) || !parse_signed(p, &right) ||
        !dvi__parser_join(p, form, *result, right, result))
      return false;
  }
  return true;
}

static bool parse_sum_of(dvi__parser *p, node **result)
{
  if (!parse_product(p, result)) return false;
  while (p->token.kind == '+' || p->token.kind == '-') {
    const dvi__form form = p->token.kind == '+' ? DVI__FORM_ADD : DVI__FORM_SUBTRACT;
    node *right = NULL;
    if (!dvi__parser_next(p) || !parse_product(p, &right) ||
        !dvi__parser_join(p, form, *result, right, result))
      return false;
  }
  return true;
}

/* ---- conditions ---- */

static const char *comparison_word(const dvi__parser *p)
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

/* Make the parts of a dvi__row one node of a form. A single part stays as it is. */
static bool make_chain_node(const dvi__parser *p, dvi__form form, const dvi__row *parts,
                            node **result)
{
  *result = parts->part[0];
  return parts->count == 1 || dvi__parser_node(p, form, parts->part[0]->span.first, parts, result);
}

/* Read a < b < c as a < b and b < c. */
static bool parse_comparison(dvi__parser *p, node **result)
{
  dvi__row parts = {0};
  node *left = NULL, *right = NULL, *made = NULL;
  if (!parse_sum_of(p, &left)) return false;
  *result = left;
  for (const char *name; (name = comparison_word(p)) != NULL; left = right) {
    if (!dvi__parser_next(p) || !parse_sum_of(p, &right) ||
        !dvi__parser_join(p, DVI__FORM_COMPARE, left, right, &made) ||
        !dvi__row_add(p, &parts, made))
      return false;
    made->name = name;
  }
  return parts.count == 0 || make_chain_node(p, DVI__FORM_AND, &parts, result);
}

static bool parse_denial(dvi__parser *p, node **result)
{
  const size_t first = p->token.span.first;
  node *part = NULL;
  dvi__row parts = {0};
  if (!dvi__parser_is_at(p, "not")) return parse_comparison(p, result);
  if (!dvi__parser_enter(p) || !dvi__parser_next(p) || !parse_denial(p, &part) ||
      !dvi__row_add(p, &parts, part))
    return false;
  p->depth--;
  return dvi__parser_node(p, DVI__FORM_NOT, first, &parts, result);
}

/* Read conditions joined by a word. */
static bool parse_joined(dvi__parser *p, const char *word, dvi__form form,
                         bool (*one)(dvi__parser *, node **), node **result)
{
  dvi__row parts = {0};
  for (;;) {
    node *part = NULL;
    if (!one(p, &part) || !dvi__row_add(p, &parts, part)) return false;
    if (!dvi__parser_is_at(p, word)) return make_chain_node(p, form, &parts, result);
    if (!dvi__parser_next(p)) return false;
  }
}

static bool parse_all_of(dvi__parser *p, node **result)
{
  return parse_joined(p, "and", DVI__FORM_AND, parse_denial, result);
}

static bool parse_any_of(dvi__parser *p, node **result)
{
  return parse_joined(p, "or", DVI__FORM_OR, parse_all_of, result);
}

static bool parse_whole(dvi__parser *p, node **result)
{
  const bool empty = p->token.kind == DVI__TOKEN_END;
  if (empty)
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span,
                         "an expression is missing here");
  if (!parse_any_of(p, result)) return false;
  if (p->token.kind == ')' || p->token.kind == ']')
    return dvi__complain(p->complaint, DVI_BAD_FILE, p->token.span, "this '%c' closes nothing",
                         p->source->text[p->token.span.first]);
  return dvi__parser_expect(p, DVI__TOKEN_END, "an operator or the end", DVI__NOWHERE);
}

bool dvi__expression_parse(const dvi__source *source, dvi__span span, dvi__arena *arena,
                           dvi__complaint *complaint, const dvi__expression **expression)
{
  *expression = NULL;
  dvi__parser p = {.source = source,
                   .arena = arena,
                   .complaint = complaint,
                   .end = span.first + span.size,
                   .depth = -1,
                   .token = {.span = {span.first, 0}}};
  if (!dvi__parser_next(&p)) return false;
  node *result = NULL;
  const bool fine = parse_whole(&p, &result);
  *expression = fine ? result : NULL;
  return fine;
}
