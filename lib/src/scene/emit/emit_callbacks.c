/* A term as C. It has functions by emit.h, callbacks around them, and the object that points to
 * them. */
#include <stdio.h>
#include <string.h>

#include "scene/emit/emit_scene.h"
#include "text/heap.h"

enum { ENTRIES_MAX = 65536 }; /* entries of the gradients of constraints, which wait on the stack */

void dvi__emit_text(dvi__emitter *out, const char *text)
{
  dvi__emit(out, "\"");
  for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++)
    dvi__emit(out, *c < ' ' || *c > '~' || strchr("\"\\?", *c) != NULL ? "\\%03o" : "%c", *c);
  dvi__emit(out, "\"");
}

/* ---- callbacks ---- */

/* Write the positions of the entries of d phi/dq, then those of d phi/dp, when they are gradients,
 * column by column. */
static dvi_status emit_order(dvi__emitter *out, const dvi__scene_term *term, int *list)
{
  const int count = term->count, *q_start = term->qw.start, *p_start = term->vw.start;
  int *from = dvi__heap_take((size_t)q_start[count] + (size_t)p_start[count] + 1, sizeof *from),
      at = 0;
  if (from == NULL) return DVI_NO_MEMORY;
  for (int a = 0; a < count; a++) {
    for (int e = q_start[a]; e < q_start[a + 1]; e++) from[at++] = e;
    for (int e = p_start[a]; e < p_start[a + 1]; e++) from[at++] = q_start[count] + e;
  }
  *list = dvi__emit_ints_of(out, term, at, from);
  dvi__heap_free(from);
  return DVI_OK;
}

/* Write the call for gradients of constraints, d phi/dq and d phi/dp together. */
static void emit_joined_call(dvi__emitter *out, const dvi__scene_term *term, const char *function,
                             const char *arguments, int list)
{
  const int of_q = term->qw.start[term->count], all = of_q + term->vw.start[term->count];
  dvi__emit(out, "  double z[%d];\n  %s(%s, z, z + %d);\n", all + 1, function, arguments, of_q);
  dvi__emit(out, "  for (int e = 0; e < %d; e++) phi_z[e] = z[dvi_list_%d[e]];\n", all, list);
}

/* Write a call for each row of constraints, with its unit vector. */
static void emit_calls_by_row(dvi__emitter *out, const dvi__scene_term *term, const char *function,
                              const char *arguments)
{
  dvi__emit(out, "  double w[%d] = {0};\n  for (int a = 0; a < %d; a++) {\n    w[a] = 1;\n",
            term->count, term->count);
  dvi__emit(out, "    %s(%s);\n    w[a] = 0;\n  }\n", function, arguments);
}

static dvi_status emit_callback_function(dvi__emitter *out, const dvi__scene_term *term,
                                         const dvi__callback *c, const char *name, int *list)
{
  const int lanes = strstr(c->name, "batch") != NULL;
  switch (c->asks) {
  case 'v': return dvi__emit_value(out, term->function, name);
  case 't':
  case 'g': return dvi__emit_gradient(out, term->function, c->wanted, lanes, name);
  case 's': return dvi__emit_second(out, term->function, c->wanted, lanes, name);
  default: break;
  }
  if (term->qw.start[term->count] > ENTRIES_MAX - term->vw.start[term->count]) return DVI_BAD_SIZE;
  const dvi_status status = dvi__emit_second(out, term->function, c->wanted, lanes, name);
  return status != DVI_OK ? status : emit_order(out, term, list);
}

/* Write the function of a callback, and the callback that calls it. */
static dvi_status emit_callback(dvi__emitter *out, const dvi__emitted_term *term,
                                const dvi__callback *c)
{
  char function[64];
  int list = 0;
  (void)snprintf(function, sizeof function, "%s_%s_of", term->name, c->name);
  const dvi_status status = emit_callback_function(out, term->term, c, function, &list);
  if (status != DVI_OK) return status;
  dvi__emit(out, "static int %s_%s(%s, void *user)\n{\n", term->name, c->name, c->parameters);
  dvi__emit(out, "  (void)user;\n");
  if (c->asks == 'c')
    emit_joined_call(out, term->term, function, c->arguments, list);
  else if (c->asks == 't')
    emit_calls_by_row(out, term->term, function, c->arguments);
  else
    dvi__emit(out, "  %s(%s);\n", function, c->arguments);
  dvi__emit(out, "  return 0;\n}\n\n");
  return DVI_OK;
}

dvi_status dvi__emit_callbacks(dvi__emitter *out, const dvi__emitted_term *term)
{
  dvi_status status = DVI_OK;
  for (int k = 0; k < term->callback_count && status == DVI_OK; k++)
    status = emit_callback(out, term, &term->callback[k]);
  return status;
}

/* ---- objects ---- */

void dvi__emit_pattern_arrays(dvi__emitter *out, int columns, const dvi_pattern *pattern,
                              int number[2])
{
  number[0] = number[1] = -1;
  if (pattern->start == NULL) return;
  number[0] = dvi__emit_ints(out, columns + 1, pattern->start);
  if (pattern->start[columns] > 0)
    number[1] = dvi__emit_ints(out, pattern->start[columns], pattern->row);
}

static void emit_pattern(dvi__emitter *out, const char *field, const int number[2])
{
  if (number[0] < 0) return;
  dvi__emit(out, ",\n    .%s = {dvi_list_%d, ", field, number[0]);
  if (number[1] < 0)
    dvi__emit(out, "NULL}");
  else
    dvi__emit(out, "dvi_list_%d}", number[1]);
}

/* Return the columns of a pattern. The gradients of constraints are columns for them. All other
 * patterns have one for a coordinate. */
static int columns_of(const dvi__emitted_term *term, int k)
{
  if (k == 1 && term->velocity_columns > 0) return term->velocity_columns;
  return k < 3 ? term->columns : term->term->count;
}

void dvi__emit_fields(dvi__emitter *out, const dvi__emitted_term *term)
{
  if (term->shown != NULL) {
    dvi__emit(out, ".name = ");
    dvi__emit_text(out, term->shown);
    dvi__emit(out, ", ");
  }
  for (int k = 0; k < term->callback_count; k++)
    dvi__emit(out, "%s.%s = %s_%s", k > 0 ? ",\n    " : "", term->callback[k].name, term->name,
              term->callback[k].name);
}

dvi_status dvi__emit_term(dvi__emitter *out, const dvi__emitted_term *term)
{
  int number[4][2], patterns = 0;
  const dvi_status status = dvi__emit_callbacks(out, term);
  for (; patterns < 4 && term->pattern[patterns] != NULL; patterns++)
    dvi__emit_pattern_arrays(out, columns_of(term, patterns), term->pattern[patterns],
                             number[patterns]);
  dvi__emit(out, "static const %s %s = {\n    ", term->type, term->name);
  dvi__emit_fields(out, term);
  for (int k = 0; k < patterns; k++) emit_pattern(out, term->pattern_name[k], number[k]);
  if (patterns == 4) dvi__emit(out, ",\n    .count = %d", term->term->count);
  if (term->fast) dvi__emit(out, ",\n    .fast = 1");
  if (term->quadratic) dvi__emit(out, ",\n    .quadratic = 1");
  if (term->without_velocity) dvi__emit(out, ",\n    .without_velocity = 1");
  dvi__emit(out, ",\n};\n\n");
  return status;
}
