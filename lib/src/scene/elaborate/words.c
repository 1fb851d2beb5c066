#include "scene/elaborate/words.h"

#include <string.h>

static const dvi__function_word functions[] = {
    {"floor", DVI__OP_FLOOR, 1}, {"ceil", DVI__OP_FLOOR, 1},  {"sign", DVI__OP_SIGN, 1},
    {"sqrt", DVI__OP_SQRT, 1},   {"exp", DVI__OP_EXP, 1},     {"log", DVI__OP_LOG, 1},
    {"sin", DVI__OP_SIN, 1},     {"cos", DVI__OP_COS, 1},     {"tan", DVI__OP_TAN, 1},
    {"asin", DVI__OP_ASIN, 1},   {"acos", DVI__OP_ACOS, 1},   {"atan", DVI__OP_ATAN, 1},
    {"sinh", DVI__OP_SINH, 1},   {"cosh", DVI__OP_COSH, 1},   {"tanh", DVI__OP_TANH, 1},
    {"asinh", DVI__OP_ASINH, 1}, {"acosh", DVI__OP_ACOSH, 1}, {"atanh", DVI__OP_ATANH, 1},
    {"abs", DVI__OP_ABS, 1},     {"atan2", DVI__OP_ATAN2, 2}, {"hypot", DVI__OP_HYPOT, 2},
};

static const char *const others[] = {"t",         "pi",  "p",    "dot",   "cross", "norm",
                                     "transpose", "sum", "turn", "omega", "rate",  "min",
                                     "max",       "if",  "and",  "or",    "not"};

/* Words that may be names, too, of a frequency, say, or of a bound. */
static const char *const free_words[] = {"turn", "omega", "rate",  "min",
                                         "max",  "sign",  "floor", "ceil"};

enum {
  FUNCTIONS = sizeof functions / sizeof *functions,
  OTHERS = sizeof others / sizeof *others,
  FREE = sizeof free_words / sizeof *free_words
};

const dvi__function_word *dvi__function_word_of(const char *name)
{
  for (int i = 0; i < FUNCTIONS; i++)
    if (strcmp(functions[i].name, name) == 0) return &functions[i];
  return NULL;
}

int dvi__word_count(void)
{
  return FUNCTIONS + OTHERS;
}

const char *dvi__word(int i)
{
  return i < FUNCTIONS ? functions[i].name : others[i - FUNCTIONS];
}

bool dvi__is_word(const char *text)
{
  for (int i = 0; i < FREE; i++)
    if (strcmp(free_words[i], text) == 0) return false;
  for (int i = 0; i < FUNCTIONS + OTHERS; i++)
    if (strcmp(dvi__word(i), text) == 0) return true;
  return false;
}
