#include "scene/elaborate/hints.h"

#include <stdio.h>
#include <string.h>

/* A word that is common elsewhere, and its name here. */
typedef struct synonym {
  const char *elsewhere, *here;
} synonym;

static const char *synonym_find(int count, const synonym *list, const char *word)
{
  for (int k = 0; k < count; k++)
    if (strcmp(list[k].elsewhere, word) == 0) return list[k].here;
  return NULL;
}

static const synonym functions[] = {
    {"ln", "log(x)"},          {"e", "exp(x)"},          {"pow", "x^y"},
    {"arcsin", "asin(x)"},     {"arccos", "acos(x)"},    {"arctan", "atan(x)"},
    {"arctan2", "atan2(y,x)"}, {"diff", "x', the rate"}, {"der", "x', the rate"},
    {"fabs", "abs(x)"},        {"arsinh", "asinh(x)"},   {"arcosh", "acosh(x)"},
    {"artanh", "atanh(x)"},
};

/* Prefixes and suffixes of rates and momenta where there are no primes. */
static const struct {
  const char *before, *after, *open, *close;
} rates[] = {
    {"", "_dot", "", "'"}, {"", "dot", "", "'"}, {"v_", "", "", "'"},
    {"d", "", "", "'"},    {"v", "", "", "'"},   {"p_", "", "p(", ")"},
};

enum { NAME_SIZE = 48 };

/* Return the coordinate in a name of the form before..after, or 0. */
static int coordinate_in(const dvi__names *names, const char *name, const char *before,
                         const char *after, char *coordinate)
{
  const size_t length = strlen(name), head = strlen(before), tail = strlen(after);
  if (length <= head + tail || length - head - tail >= NAME_SIZE ||
      strncmp(name, before, head) != 0 || strcmp(name + length - tail, after) != 0)
    return 0;
  (void)snprintf(coordinate, NAME_SIZE, "%.*s", (int)(length - head - tail), name + head);
  const dvi__name *found = dvi__names_find(names, coordinate);
  return found != NULL && found->sort == DVI__COORDINATE;
}

const char *dvi__hint_of_name(const dvi__names *names, const char *name, char *hint, size_t size)
{
  char coordinate[NAME_SIZE];
  const char *here = synonym_find(sizeof functions / sizeof *functions, functions, name);
  if (size > 0) hint[0] = '\0';
  if (here != NULL) (void)snprintf(hint, size, "; write %s", here);
  for (size_t k = 0; k < sizeof rates / sizeof *rates && here == NULL; k++)
    if (coordinate_in(names, name, rates[k].before, rates[k].after, coordinate)) {
      (void)snprintf(hint, size, "; write %s%s%s", rates[k].open, coordinate, rates[k].close);
      break;
    }
  return hint;
}

const char *dvi__hint_of_section(const char *key)
{
  static const synonym sections[] = {
      {"params", "parameters"},
      {"constants", "parameters"},
      {"variables", "coordinates"},
      {"coords", "coordinates"},
      {"L", "lagrangian"},
      {"T", "kinetic"},
      {"V", "potentials"},
      {"H", "hamiltonian"},
      {"h", "step"},
      {"dt", "step"},
      {"t_end", "until"},
      {"t-end", "until"},
      {"end", "until"},
      {"tmax", "until"},
      {"start", "initial"},
      {"integrator", "method"},
      {"solver", "method"},
      {"output", "report"},
      {"name", "title"},
  };
  return synonym_find(sizeof sections / sizeof *sections, sections, key);
}
