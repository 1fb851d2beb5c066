/* Marches by the names of their methods. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/avi/march.h"
#include "field/implicit/methods.h"
#include "field/mesh/share.h"
#include "field/step/bound.h"
#include "field/step/leapfrog.h"
#include "field/tents/tents.h"

/* A method, and whether its name fits a mesh. */
typedef struct method {
  const char *name;
  int needs_boxes;
  dvi_status (*create)(const dvi_field *field, const dvi__march_plan *plan, dvi_march **march);
  /* NULL if its steps are equal and have a bound */
  dvi_status (*stability)(const dvi_field *field, const dvi__march_plan *plan, double span,
                          dvi_stability *report);
} method;

static const method methods[] = {
    {"leapfrog", 0, dvi__leapfrog_create, NULL},
    {"bossavit-kettunen", 0, dvi__leapfrog_create, NULL},
    {"yee", 1, dvi__leapfrog_create, NULL},
    {"avi", 0, dvi__avi_march_create, dvi__avi_march_stability},
    {"tents", 0, dvi__tents_march, dvi__tents_march_stability},
    /* Whole meshes have the rest by the integrators of systems. */
    {"midpoint", 0, dvi__midpoint_create, NULL},
    {"imex", 0, dvi__imex_create, NULL},
    {"galerkin", 0, dvi__galerkin_create, NULL},
};

enum { ALL = sizeof methods / sizeof *methods, METHODS = 5 };

const char *dvi_march_method_name(int i)
{
  return i >= 0 && i < METHODS ? methods[i].name : NULL;
}

/* ---- checks ---- */

static dvi_status check_field(const dvi_field *field, const method *found)
{
  if (field->potential.density != NULL && found < methods + METHODS)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: the field has a potential, which %s does not take; %s", found->name,
                     field->mesh->share != NULL ? "midpoint does"
                                                : "verlet and the other methods of "
                                                  "dvi_field_system do");
  return DVI_OK;
}

/* Find a method by its name, and set *rest to what follows a colon. */
static dvi_status find(const char *text, const method **found, const char **rest)
{
  const size_t length = strcspn(text, ":");
  *rest = text[length] == ':' ? text + length + 1 : "";
  for (int i = 0; i < ALL; i++) {
    *found = methods + i;
    if (strlen(methods[i].name) == length && strncmp(methods[i].name, text, length) == 0)
      return DVI_OK;
  }
  return dvi__fail(
      DVI_BAD_OPTION,
      "march: there is no method \"%.*s\"; there are leapfrog (also called yee and "
      "bossavit-kettunen), avi, tents, and on shares midpoint, and for waves imex and galerkin",
      (int)length, text);
}

/* ---- create ---- */

/* Find the method that is asked for, and the plan of its steps. */
static dvi_status prepare(const dvi_field *field, const dvi_march_options *options,
                          const char *usual, const method **found, dvi__march_plan *plan)
{
  DVI_TRY(dvi__plan_march(options, plan));
  DVI_TRY(find(options->method != NULL ? options->method : usual, found, &plan->options));
  DVI_TRY(check_field(field, *found));
  if ((*found)->needs_boxes && dvi_mesh_kind(field->mesh) != DVI_BOXES)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: %s is for meshes of boxes; on simplices the same method is called "
                     "bossavit-kettunen",
                     (*found)->name);
  return (*found)->stability != NULL ? dvi__refuse_share(field->mesh, "march: avi or tents")
                                     : DVI_OK;
}

dvi_status dvi_march_create(const dvi_field *field, const dvi_march_options *options,
                            dvi_march **march)
{
  const dvi_march_options defaults = {.size = sizeof defaults};
  const method *found;
  dvi__march_plan plan;
  if (field == NULL || march == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: a field and a place for the march are needed");
  *march = NULL;
  DVI_TRY(prepare(field, options != NULL ? options : &defaults, "leapfrog", &found, &plan));
  return found->create(field, &plan, march);
}

dvi_status dvi_field_stability(const dvi_field *field, const dvi_march_options *options,
                               double span, dvi_stability *report)
{
  const dvi_march_options defaults = {.size = sizeof defaults};
  const method *found;
  dvi__march_plan plan;
  if (field == NULL || report == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "stability: a field and a place for the report are needed");
  if (!(span >= 0) || isinf(span))
    return dvi__fail(DVI_BAD_ARGUMENT, "stability: the span is %g; 0 or more are possible", span);
  DVI_TRY(prepare(field, options != NULL ? options : &defaults, "avi", &found, &plan));
  if (found->stability != NULL) return found->stability(field, &plan, span, report);
  return dvi__fail(DVI_UNSUPPORTED,
                   "stability: %s has equal steps, which are stable below their bound; ask for avi "
                   "or tents",
                   found->name);
}
