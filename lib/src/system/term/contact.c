#include "system/term/contact.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/term/declare.h"

/* ---- declaration ---- */

static dvi_status check_law(const dvi_contact *given, const char *name)
{
  if (!(given->restitution >= 0 && given->restitution <= 1))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: contact '%s' has the restitution %g; 0 to 1 is possible", name,
                     given->restitution);
  if (!(given->friction >= 0) || isinf(given->friction))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: contact '%s' has the friction %g; a number of 0 or more is needed",
                     name, given->friction);
  if (given->hold != 0 && given->hold != 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: contact '%s' has hold = %d; 0 or 1 is possible",
                     name, given->hold);
  if (given->friction > 0 && given->tangent == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: contact '%s' has friction, but no tangent callback, which tells in "
                     "which directions it acts",
                     name);
  if ((given->tangent != NULL) != (given->tangent_count != 0) || given->tangent_count < 0 ||
      given->tangent_count > 2)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: contact '%s' has %d tangents; 1 or 2 are possible with a tangent "
                     "callback, 0 without",
                     name, given->tangent_count);
  return DVI_OK;
}

static dvi_status copy_contact(dvi_system *s, const dvi_contact *given, dvi__contact_term *term)
{
  const char *name = given->name != NULL ? given->name : "contact";
  if (given->gap == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: contact '%s' has no %s callback", name,
                     given->gap == NULL ? "gap" : "gradient");
  DVI_TRY(check_law(given, name));
  DVI_TRY(dvi__check_rate(s, name, given->rate != NULL));
  if (given->friction > 0) s->terms |= DVI__RUBBING;
  term->callbacks = *given;
  term->gap.name = dvi__duplicate(name, strlen(name) + 1, 1);
  if (term->gap.name == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its contacts");
  term->callbacks.name = term->gap.name;
  term->gap.callbacks = (dvi_holonomic){.name = term->gap.name,
                                        .count = 1,
                                        .value = given->gap,
                                        .gradient = given->gradient,
                                        .rate = given->rate,
                                        .user = given->user};
  DVI_TRY(dvi__pattern_copy_rectangular(&given->gradients, s->n, 1, name, &term->gap.gradients));
  if (given->tangent_count == 0) return DVI_OK;
  return dvi__pattern_copy_rectangular(&given->tangents, s->n, given->tangent_count, name,
                                       &term->tangents);
}

dvi_status dvi__contacts_copy(dvi_system *s, const dvi_system_terms *terms)
{
  if (terms->contact_count == 0) return DVI_OK;
  s->terms |= DVI__CONTACT;
  s->contacts = DVI_NEW(dvi__contact_term, terms->contact_count);
  if (s->contacts == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its contacts");
  for (int k = 0; k < terms->contact_count; k++) {
    s->contact_count = k + 1;
    DVI_TRY(copy_contact(s, &terms->contacts[k], &s->contacts[k]));
  }
  return DVI_OK;
}

void dvi__contact_clear(dvi__contact_term *term)
{
  dvi__holonomic_clear(&term->gap);
  dvi__pattern_clear(&term->tangents);
}

/* ---- evaluation ---- */

dvi_status dvi__contact_tangent(const dvi__contact_term *term, double t, const double *q, double *T)
{
  const dvi_contact *c = &term->callbacks;
  return dvi__verdict(c->tangent(t, q, T, c->user), dvi__pattern_entries(&term->tangents), 1, T,
                      term->gap.name, "tangent", "");
}

dvi_status dvi__contact_touch(const dvi__contact_term *term, double t, const double *q,
                              const double *v, double *G, dvi__touch *touch)
{
  const dvi__pattern *pattern = &term->gap.gradients;
  double rate;
  DVI_TRY(dvi__holonomic_value(&term->gap, t, q, &touch->gap));
  DVI_TRY(dvi__holonomic_gradient(&term->gap, t, q, G));
  DVI_TRY(dvi__holonomic_rate(&term->gap, t, q, &rate));
  *touch = (dvi__touch){.gap = touch->gap, .rate = rate, .speed = fabs(rate)};
  for (int e = 0; e < pattern->start[1]; e++) {
    const int i = pattern->row[e];
    touch->size += fabs(G[e] * q[i]);
    touch->rate += G[e] * v[i];
    touch->speed += fabs(G[e] * v[i]);
  }
  return DVI_OK;
}

int dvi__contact_is_inside(const dvi__touch *touch)
{
  return touch->gap < -1024 * DBL_EPSILON * touch->size;
}
