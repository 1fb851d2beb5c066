#include "field/implicit/methods.h"

#include <string.h>

#include "core/status.h"
#include "field/implicit/march.h"

/* ---- options of galerkin ---- */

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

static dvi_status read_options(const char *options, const dvi__rule **rule)
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

/* ---- create ---- */

static dvi_status check_share(const dvi_field *field, const char *method)
{
  if (field->mesh->share == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: %s is a march of shares (dvi_mesh_cut); a whole mesh has it by "
                     "dvi_field_system",
                     method);
  return DVI_OK;
}

static dvi_status check_wave(const dvi_field *field, const char *method)
{
  DVI_TRY(check_share(field, method));
  if (!field->is_wave)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: %s on shares is for waves, and this field is Maxwell's: take midpoint "
                     "or leapfrog",
                     method);
  return DVI_OK;
}

/* Every step is stable. Without one, a part of leapfrog's bound is taken. */
static dvi_status choose_step(const dvi_field *field, const dvi__march_plan *plan, double *dt)
{
  double bound;
  *dt = plan->step;
  return plan->step > 0 ? DVI_OK : dvi__choose_step(field, plan, dt, &bound);
}

static dvi_status create(const dvi_field *field, const dvi__march_plan *plan,
                         dvi__implicit_plan *chosen, dvi_march **march)
{
  DVI_TRY(choose_step(field, plan, &chosen->dt));
  return dvi__implicit_create(field, chosen, march);
}

dvi_status dvi__midpoint_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march)
{
  dvi__implicit_plan chosen = {.method = DVI__IMPLICIT_MIDPOINT, .rule = &dvi__midpoint_rule};
  DVI_TRY(check_share(field, "midpoint"));
  DVI_TRY(dvi__refuse_options("midpoint", plan));
  return create(field, plan, &chosen, march);
}

dvi_status dvi__imex_create(const dvi_field *field, const dvi__march_plan *plan, dvi_march **march)
{
  dvi__implicit_plan chosen = {.method = DVI__IMPLICIT_IMEX, .rule = &dvi__imex_rule};
  DVI_TRY(check_wave(field, "imex"));
  DVI_TRY(dvi__refuse_options("imex", plan));
  return create(field, plan, &chosen, march);
}

dvi_status dvi__galerkin_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march)
{
  dvi__implicit_plan chosen = {.method = DVI__IMPLICIT_GALERKIN};
  DVI_TRY(check_wave(field, "galerkin"));
  DVI_TRY(read_options(plan->options, &chosen.rule));
  return create(field, plan, &chosen, march);
}
