/* The options of galerkin on shares. */
#include "field/implicit/options.h"

#include <string.h>

#include "core/status.h"

enum { DEGREE, NODES, RULE, KEYS };
enum { GAUSS = 1, MIDPOINT };

static const struct {
  const char *word;
  int key, value;
} words[] = {
    {"degree=1", DEGREE, 1},
    {"degree=2", DEGREE, 2},
    {"nodes=1", NODES, 1},
    {"nodes=2", NODES, 2},
    {"quadrature=gauss", RULE, GAUSS},
    {"quadrature=midpoint", RULE, MIDPOINT},
};

/* Take one option, which must not have been given before. Returns whether it is one. */
static int take(const char *text, size_t length, int *value)
{
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    if (strlen(words[i].word) != length || strncmp(words[i].word, text, length) != 0) continue;
    if (value[words[i].key] != 0) return 0;
    value[words[i].key] = words[i].value;
    return 1;
  }
  return 0;
}

static dvi_status refuse(const char *text, size_t length)
{
  return dvi__fail(
      DVI_UNSUPPORTED,
      "march: galerkin on shares has degree=1 or degree=2 with quadrature=gauss and as "
      "many nodes, or degree=1 with quadrature=midpoint, and not \"%.*s\"",
      (int)length, text);
}

dvi_status dvi__galerkin_rule(const char *options, const dvi__rule **rule)
{
  int value[KEYS] = {0};
  for (const char *text = options; *options != '\0'; text++) {
    const size_t length = strcspn(text, ",");
    if (!take(text, length, value)) return refuse(text, length);
    text += length;
    if (*text == '\0') break;
  }
  const int degree = value[DEGREE] != 0 ? value[DEGREE] : 2,
            nodes = value[NODES] != 0 ? value[NODES] : degree;
  if (nodes != degree || (value[RULE] == MIDPOINT && degree != 1))
    return refuse(options, strlen(options));
  *rule = degree == 1 ? &dvi__midpoint_rule : &dvi__gauss_rule;
  return DVI_OK;
}
