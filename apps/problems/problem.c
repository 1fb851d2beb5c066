/* The table of problems, which finds a problem, reads its settings, and creates it. */
#include <dvi/number.h>
#include <dvi/taylor.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "entry.h"

/* Memory for the names of all parameters of a problem. */
enum { NAMES_SIZE = 1024 };

#define PROBLEM_ENTRY(name) &problem_entry_##name,
static const problem_entry *const table[] = {
#include "problems.def"
};
#undef PROBLEM_ENTRY

static const problem_parameter no_parameters[1];

/* The destination of a refusal. */
typedef struct refusal {
  char *message;
  size_t size;
} refusal;

int problem_count(void)
{
  return (int)(sizeof table / sizeof *table);
}

static const problem_entry *entry_at(int i)
{
  return i >= 0 && i < problem_count() ? table[i] : NULL;
}

static const problem_parameter *parameters_of(const problem_entry *entry)
{
  return entry->parameters ? entry->parameters : no_parameters;
}

const char *problem_name(int i)
{
  const problem_entry *entry = entry_at(i);
  return entry ? entry->name : NULL;
}

const char *problem_summary(int i)
{
  const problem_entry *entry = entry_at(i);
  return entry ? entry->summary : NULL;
}

const problem_parameter *problem_parameters(int i)
{
  const problem_entry *entry = entry_at(i);
  return entry ? parameters_of(entry) : NULL;
}

int problem_find(const char *name)
{
  for (int i = 0; name && i < problem_count(); i++)
    if (strcmp(table[i]->name, name) == 0) return i;
  return -1;
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static dvi_status
refuse_problem(const refusal *r, dvi_status status, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  if (r->message && r->size > 0) vsnprintf(r->message, r->size, format, arguments);
  va_end(arguments);
  return status;
}

/* Refuse a parameter's name, and list those that there are. */
static dvi_status refuse_parameter_name(const refusal *r, const problem_entry *entry,
                                        const char *setting, size_t length)
{
  char names[NAMES_SIZE] = "none";
  size_t used = 0;
  for (const problem_parameter *p = parameters_of(entry); p->name && used < sizeof names; p++)
    used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", p->name);
  return refuse_problem(r, DVI_BAD_OPTION, "%s has no parameter '%.*s'; it has: %s", entry->name,
                        (int)length, setting, names);
}

void problem_spell(const problem_parameter *parameter, double x, char *text, size_t size)
{
  char number[DVI_NUMBER_SIZE];
  dvi_number_write(x, number);
  (void)snprintf(text, size, "%s", parameter->choice ? parameter->choice[(int)x] : number);
}

/* Refuse a number outside of a parameter's range, and name the limit. */
static dvi_status refuse_parameter_value(const refusal *r, const problem_entry *entry,
                                         const char *setting, const problem_parameter *parameter,
                                         double x)
{
  char limit[32];
  problem_spell(parameter, x < parameter->least ? parameter->least : parameter->most, limit,
                sizeof limit);
  return refuse_problem(r, DVI_BAD_OPTION, "%s: %s is %s %s, the %s that is taken; %s is %s",
                        entry->name, setting, x < parameter->least ? "below" : "above", limit,
                        x < parameter->least ? "least" : "most", parameter->name, parameter->help);
}

static dvi_status problem_read_choice(const refusal *r, const problem_entry *entry,
                                      const char *setting, const problem_parameter *parameter,
                                      const char *name, double *value)
{
  for (int k = 0; parameter->choice[k]; k++)
    if (strcmp(parameter->choice[k], name) == 0) {
      *value = k;
      return DVI_OK;
    }
  return refuse_problem(r, DVI_BAD_OPTION, "%s: %s is no choice; %s is %s", entry->name, setting,
                        parameter->name, parameter->help);
}

/* Read one "name=value". `given` marks the parameters that were read before. */
static dvi_status problem_read_setting(const refusal *r, const problem_entry *entry,
                                       const char *setting, double *value, int *given)
{
  const char *equals = setting ? strchr(setting, '=') : NULL;
  if (!equals)
    return refuse_problem(r, DVI_BAD_OPTION, "%s: the setting '%s' is not of the form name=value",
                          entry->name, setting ? setting : "");
  const size_t length = (size_t)(equals - setting);
  const problem_parameter *parameters = parameters_of(entry);
  int i = 0;
  while (parameters[i].name &&
         (strncmp(parameters[i].name, setting, length) != 0 || parameters[i].name[length]))
    i++;
  if (!parameters[i].name) return refuse_parameter_name(r, entry, setting, length);
  if (given[i])
    return refuse_problem(r, DVI_BAD_OPTION, "%s: %s is set twice", entry->name,
                          parameters[i].name);
  given[i] = 1;

  if (parameters[i].choice)
    return problem_read_choice(r, entry, setting, &parameters[i], equals + 1, value + i);
  double x = 0;
  const char *end = dvi_number_read(equals + 1, &x);
  const int number = end != equals + 1 && *end == '\0' && isfinite(x);
  if (!number || (parameters[i].whole && floor(x) != x))
    return refuse_problem(r, DVI_BAD_OPTION, "%s: %s is no %s; %s is %s", entry->name, setting,
                          parameters[i].whole ? "whole number" : "finite number",
                          parameters[i].name, parameters[i].help);
  if (x < parameters[i].least || x > parameters[i].most)
    return refuse_parameter_value(r, entry, setting, &parameters[i], x);
  value[i] = x;
  return DVI_OK;
}

static int all_default(const problem_entry *entry, const double *value)
{
  for (int i = 0; parameters_of(entry)[i].name; i++)
    if (value[i] < parameters_of(entry)[i].value || value[i] > parameters_of(entry)[i].value)
      return 0;
  return 1;
}

static dvi_status make_entry(const refusal *r, const problem_entry *entry, const double *value,
                             problem *made)
{
  made->name = entry->name;
  made->summary = entry->summary;
  made->parameter = parameters_of(entry);
  made->h = entry->h;
  made->t_end = entry->t_end;
  made->order_h = entry->order_h;
  made->order_t_end = entry->order_t_end;
  made->exact = entry->exact;
  if (all_default(entry, value)) {
    made->digits_q = entry->digits_q;
    made->digits_p = entry->digits_p;
    made->far_t_end = entry->far_t_end;
    made->far_q = entry->far_q;
    made->far_error = entry->far_error;
  }
  dvi_status status = entry->make(value, made);
  if (status == DVI_OK && (made->terms->one_form || made->terms->hamiltonian))
    status = dvi_system_velocity(made->system, 0.0, made->q, made->p, made->v);
  if (status == DVI_OK && !made->terms->hamiltonian)
    status = dvi_system_momentum(made->system, 0.0, made->q, made->v, made->p);
  if (status == DVI_OK) return DVI_OK;
  const char *reason = status == DVI_NO_MEMORY ? dvi_status_meaning(status) : dvi_last_error();
  /* each parameter is in its range, but not all together, as in the triangle inequality of
   * inertias */
  if (status == DVI_BAD_ARGUMENT)
    return refuse_problem(r, DVI_BAD_OPTION, "%s with these parameters: %s", entry->name, reason);
  return refuse_problem(r, status, "%s: %s", entry->name, reason);
}

dvi_status problem_create(const char *name, int setting_count, const char *const *settings,
                          problem **out, char *message, size_t size)
{
  const refusal r = {message, size};
  if (!out) return refuse_problem(&r, DVI_BAD_ARGUMENT, "there is no place for the problem");
  *out = NULL;
  const problem_entry *entry = entry_at(problem_find(name));
  if (!entry)
    return refuse_problem(&r, DVI_BAD_OPTION, "there is no problem '%s'; see dvi list problems",
                          name ? name : "");

  double value[PROBLEM_PARAMETERS_MAX] = {0.0};
  int given[PROBLEM_PARAMETERS_MAX] = {0};
  for (int i = 0; parameters_of(entry)[i].name; i++) value[i] = parameters_of(entry)[i].value;
  for (int i = 0; i < setting_count; i++) {
    const dvi_status status = problem_read_setting(&r, entry, settings[i], value, given);
    if (status != DVI_OK) return status;
  }

  problem *made = calloc(1, sizeof *made);
  if (!made)
    return refuse_problem(&r, DVI_NO_MEMORY, "%s: %s", entry->name,
                          dvi_status_meaning(DVI_NO_MEMORY));
  const dvi_status status = make_entry(&r, entry, value, made);
  if (status == DVI_OK)
    *out = made;
  else
    problem_destroy(&made);
  return status;
}

/* A block of memory. It starts with the address of the next one, and the union aligns the memory
 * after it for every type. */
typedef union block {
  union block *next;
  max_align_t alignment;
} block;

void problem_destroy(problem **made)
{
  if (!made || !*made) return;
  if ((*made)->close)
    (*made)->close(*made);
  else
    dvi_system_destroy(&(*made)->system);
  for (block *b = (*made)->blocks; b;) {
    block *next = b->next;
    free(b);
    b = next;
  }
  free(*made);
  *made = NULL;
}

void *problem_allocate(problem *made, size_t count, size_t size)
{
  if (size > 0 && count > (SIZE_MAX - sizeof(block)) / size) return NULL;
  block *b = calloc(1, sizeof *b + count * size);
  if (!b) return NULL;
  b->next = made->blocks;
  made->blocks = b;
  return b + 1;
}

char **problem_names(problem *made, int count)
{
  char *text = problem_allocate(made, (size_t)count, PROBLEM_LABEL_SIZE);
  char **name = problem_allocate(made, (size_t)count, sizeof *name);
  for (int i = 0; text && name && i < count; i++) name[i] = text + (size_t)i * PROBLEM_LABEL_SIZE;
  return text ? name : NULL;
}

dvi_status problem_room_of(problem *made, int nq, int nv, size_t parameters_size)
{
  double *numbers = problem_allocate(made, (size_t)nq + 2 * (size_t)nv, sizeof *numbers);
  made->coordinate = problem_names(made, nq);
  made->momentum = problem_names(made, nv);
  made->parameters = problem_allocate(made, 1, parameters_size);
  if (!numbers || !made->coordinate || !made->momentum || !made->parameters) return DVI_NO_MEMORY;
  made->nq = nq;
  made->nv = nv;
  made->q = numbers;
  made->v = numbers + nq;
  made->p = numbers + nq + nv;
  return DVI_OK;
}

dvi_status problem_room(problem *made, int n, size_t parameters_size)
{
  return problem_room_of(made, n, n, parameters_size);
}

void problem_label(problem *made, int i, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(made->coordinate[i], PROBLEM_LABEL_SIZE, format, arguments);
  va_end(arguments);
  (void)snprintf(made->momentum[i], PROBLEM_LABEL_SIZE, "p_%.*s", PROBLEM_LABEL_SIZE - 3,
                 made->coordinate[i]);
}

void problem_oscillation(double square, double t, double *cosine, double *sine)
{
  const double w = sqrt(square), phase = w * t;
  const double w_rest = fma(-w, w, square) / (2.0 * w);
  const double rest = fma(w, t, -phase) + w_rest * t;
  const double c = cos(phase), s = sin(phase);
  const double c_rest = cos(rest), s_rest = sin(rest);
  *cosine = c * c_rest - s * s_rest;
  *sine = s * c_rest + c * s_rest;
}

void problem_spring_taylor(double k, int degree, const double *q, double *V, double *V_q,
                           double *V_qq)
{
  const double one[DVI_TAYLOR_MAX + 1] = {1.0};
  double square[DVI_TAYLOR_MAX + 1];
  dvi_taylor_multiply(degree, q, q, square);
  dvi_taylor_put(degree, 1, square, 0.5 * k, 0, V);
  dvi_taylor_put(degree, 1, q, k, 0, V_q);
  dvi_taylor_put(degree, 1, one, k, 0, V_qq);
}
