/* Words of expressions, and remedies for characters that mean something elsewhere, in other
 * languages or on paper. */
#include "scene/text/lexer.h"
#include "text/utf8.h"

#include <string.h>

static bool is_digit(char c)
{
  return c >= '0' && c <= '9';
}

static bool is_letter(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/* A part of the source from which characters are read. Behind its end there are NULs. */
typedef struct text {
  const char *at;
  size_t end;
} text;

static char letter_at(const text *t, size_t offset)
{
  return offset < t->end ? t->at[offset] : '\0';
}

static size_t skip_digits(const text *t, size_t k)
{
  while (is_digit(letter_at(t, k))) k++;
  return k;
}

/* Return the end of the number that begins at k. It stops before the two points of 1..N, and an e
 * without digits begins a name. */
static size_t number_end(const text *t, size_t k)
{
  k = skip_digits(t, k);
  if (letter_at(t, k) == '.' && letter_at(t, k + 1) != '.') k = skip_digits(t, k + 1);
  if (letter_at(t, k) != 'e' && letter_at(t, k) != 'E') return k;
  const size_t digits = k + (letter_at(t, k + 1) == '+' || letter_at(t, k + 1) == '-' ? 2 : 1);
  return is_digit(letter_at(t, digits)) ? skip_digits(t, digits) : k;
}

static size_t name_end(const text *t, size_t k)
{
  while (is_letter(letter_at(t, k)) || is_digit(letter_at(t, k))) k++;
  return k;
}

/* Return true at a comment. It begins behind a blank, as in YAML, to which x#y is one text. */
static bool begins_comment(const text *t, size_t k)
{
  return t->at[k] == '#' && (k == 0 || dvi__is_blank(t->at[k - 1]));
}

static size_t skip_blanks(const text *t, size_t k)
{
  while (k < t->end && (dvi__is_blank(t->at[k]) || begins_comment(t, k))) {
    if (t->at[k] == '#')
      while (k < t->end && t->at[k] != '\n' && t->at[k] != '\r') k++;
    else
      k++;
  }
  return k;
}

/* Return the remedy for a character of paper, or NULL if nothing comes close. */
static const char *remedy_for(unsigned code)
{
  static const char *const greek[] = {
      "alpha", "beta",   "gamma",   "delta", "epsilon", "zeta",    "eta",  "theta", "iota",
      "kappa", "lambda", "mu",      "nu",    "xi",      "omicron", "pi",   "rho",   "sigma",
      "sigma", "tau",    "upsilon", "phi",   "chi",     "psi",     "omega"};
  static const struct {
    unsigned code;
    const char *spelling;
  } mark[] = {{0x2212, "-"},          {0x2013, "-"},     {0xB7, "*"},
              {0x22C5, "*"},          {0xD7, "*"},       {0xF7, "/"},
              {0xB2, "^2"},           {0xB3, "^3"},      {0x2019, "'"},
              {0x2032, "'"},          {0xB4, "'"},       {0x221A, "sqrt(..)"},
              {0x2211, "sum(i, ..)"}, {0x3D1, "theta"},  {0x3D5, "phi"},
              {0x3F5, "epsilon"},     {0xA0, "a blank"}, {0x2264, "<="},
              {0x2265, ">="},         {0x2260, "!="},    {0x2227, "and"},
              {0x2228, "or"},         {0xAC, "not"},     {0x2026, ".."}};
  if (code >= 0x3B1 && code < 0x3B1 + sizeof greek / sizeof *greek) return greek[code - 0x3B1];
  for (size_t k = 0; k < sizeof mark / sizeof *mark; k++)
    if (mark[k].code == code) return mark[k].spelling;
  return NULL;
}

static bool refuse_letter(const text *t, size_t k, dvi__complaint *complaint)
{
  unsigned code = 0;
  const size_t width = dvi__utf8(t->at + k, t->end - k, &code);
  const dvi__span where = {k, width == 0 ? 1 : width};
  const char *write = width == 0 ? NULL : remedy_for(code);
  if (write != NULL)
    return dvi__complain(complaint, DVI_BAD_FILE, where,
                         "'%.*s' has no meaning in expressions; write %s", (int)where.size,
                         t->at + k, write);
  return dvi__complain(complaint, DVI_BAD_FILE, where,
                       "'%.*s' has no meaning in expressions; names are made of the letters a-z "
                       "and A-Z, digits and _",
                       (int)where.size, t->at + k);
}

static bool refuse_character(const text *t, size_t k, dvi__complaint *complaint)
{
  static const struct {
    char mark;
    const char *remedy;
  } known[] = {
      {'|', "; write abs(x) of a number, norm(a) of a vector"},
      {':', "; a range is a..b"},
      {';', "; elements of a list are separated by commas, rows are lists: [[a, b], [c, d]]"},
      {'"', "; quotes stand around the whole expression, and the rate of x is x'"},
      {'%', "; a remainder is x - n*floor(x/n)"},
      {'{', "; write parentheses"},
      {'}', "; write parentheses"},
      {'\\', "; write sin(x), without a backslash"},
      {'#', "; a blank stands before a comment"},
      {'&', "; write and"},
      {'?', "; write if(x < 0, a, b)"},
      {'!', "; write not"}};
  const char c = t->at[k];
  if ((unsigned char)c >= 0x80) return refuse_letter(t, k, complaint);
  const char *remedy = "";
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (known[i].mark == c) remedy = known[i].remedy;
  return dvi__complain(complaint, DVI_BAD_FILE, (dvi__span){k, 1},
                       "'%c' has no meaning in expressions%s", c, remedy);
}

/* Return the kind of a mark of two characters, or 0 if this is none. */
static int mark_of_two(char first, char second)
{
  static const struct {
    char spelling[3];
    int kind;
  } mark[] = {{"..", DVI__TOKEN_RANGE},
              {"<=", DVI__TOKEN_AT_MOST},
              {">=", DVI__TOKEN_AT_LEAST},
              {"==", DVI__TOKEN_EQUALS},
              {"!=", DVI__TOKEN_DIFFERS}};
  for (size_t k = 0; k < sizeof mark / sizeof *mark; k++)
    if (mark[k].spelling[0] == first && mark[k].spelling[1] == second) return mark[k].kind;
  return 0;
}

bool dvi__token_read(const dvi__source *source, size_t offset, size_t end,
                     dvi__complaint *complaint, dvi__token *token)
{
  const text t = {source->text, end};
  const size_t first = skip_blanks(&t, offset);
  const char c = letter_at(&t, first);
  size_t last = first + 1;
  int kind = (unsigned char)c;
  if (first >= end) {
    kind = DVI__TOKEN_END;
    last = first;
  } else if (is_digit(c) || (c == '.' && is_digit(letter_at(&t, first + 1)))) {
    kind = DVI__TOKEN_NUMBER;
    last = number_end(&t, first);
  } else if (is_letter(c)) {
    kind = DVI__TOKEN_NAME;
    last = name_end(&t, first);
  } else if (mark_of_two(c, letter_at(&t, last)) != 0) {
    kind = mark_of_two(c, letter_at(&t, last));
    last = first + 2;
  } else if (c == '*' && letter_at(&t, last) == '*') {
    return dvi__complain(complaint, DVI_BAD_FILE, (dvi__span){first, 2},
                         "powers are written x^2, not x**2");
  } else if (c == '\0' || strchr("+-*/^()[],.'<>=", c) == NULL) {
    return refuse_character(&t, first, complaint);
  }
  *token = (dvi__token){kind, {first, last - first}};
  return true;
}
