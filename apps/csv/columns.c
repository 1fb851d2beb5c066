#include "csv/columns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/balance.h"
#include "csv/choice.h"
#include "csv/velocity.h"

/* ---- columns of a run ---- */

static void columns_add(run_columns *c, const char *name, column_kind kind, int index)
{
  c->all[c->there++] = (shown_column){.name = name, .kind = kind, .index = index};
}

static void columns_add_all(run_columns *c, int count, char *const *name, column_kind kind)
{
  for (int i = 0; i < count; i++) columns_add(c, name[i], kind, i);
}

static void columns_list(run_columns *c, const dvi_integrator *integrator)
{
  const problem *scene = c->scene;
  columns_add_all(c, scene->nq, scene->coordinate, COLUMN_COORDINATE);
  if (scene->velocity != NULL) columns_add_all(c, scene->nv, scene->velocity, COLUMN_VELOCITY);
  columns_add_all(c, scene->nv, scene->momentum, COLUMN_MOMENTUM);
  for (int i = 0; i < dvi_system_invariant_count(scene->system); i++) {
    const char *name = dvi_system_invariant_name(scene->system, i);
    columns_add(c, name, COLUMN_INVARIANT, i);
    if (!has_balances(scene) || i > scene->terms->symmetry_count) continue;
    (void)snprintf(c->balance_name[i], BALANCE_NAME_SIZE, "%s_balance", name);
    columns_add(c, c->balance_name[i], COLUMN_BALANCE, i);
  }
  if (dvi_integrator_chooses_steps(integrator)) columns_add(c, "h", COLUMN_STEP, 0);
  if (scene->velocity != NULL) columns_add(c, "distance", COLUMN_DISTANCE, 0);
  if (scene->terms->one_form != NULL || scene->terms->constraint != NULL ||
      scene->terms->holonomic_count > 0 || scene->terms->nonholonomic_count > 0)
    columns_add(c, "constraint", COLUMN_CONSTRAINT, 0);
  if (scene->terms->contact_count > 0) columns_add(c, "gap", COLUMN_GAP, 0);
  if (scene->terms->noise != NULL) columns_add(c, "temperature", COLUMN_TEMPERATURE, 0);
  if (!isnan(dvi_integrator_jump(integrator, NULL))) columns_add(c, "jump", COLUMN_JUMP, 0);
  reaction_names(scene, c->reaction_name);
  for (int i = 0; i < reaction_count(scene); i++)
    columns_add(c, c->reaction_name[i], COLUMN_REACTION, i);
  for (int k = 0; k < scene->terms->contact_count; k++) {
    if (!dvi_integrator_may_hold(integrator, k)) continue;
    force_name(scene, k, c->force_name[k]);
    columns_add(c, c->force_name[k], COLUMN_FORCE, k);
  }
}

/* Refuse a method's own column with the name of one of the problem's. */
static int refuse_same_column(const run_columns *c, const char *method)
{
  for (int k = 0; k < c->there; k++) {
    const bool own = c->all[k].kind == COLUMN_STEP || c->all[k].kind == COLUMN_JUMP;
    for (int i = 0; i < k && own; i++)
      if (strcmp(c->all[i].name, c->all[k].name) == 0)
        return usage_error(
            "run: %s by %s has two columns '%s', one of them the method's; rename the other",
            c->scene->name, method, c->all[k].name);
  }
  return DONE;
}

/* ---- shown columns ---- */

static void columns_show(run_columns *c, int k)
{
  c->column[c->count++] = c->all[k];
  c->shows[c->all[k].kind] = true;
}

/* List the names of all columns. */
static const char *column_name_at(int k, const void *list)
{
  const run_columns *c = list;
  return k < c->there ? c->all[k].name : NULL;
}

/* Show the columns "A,B,..", or those that the problem wants. */
static int columns_show_named(run_columns *c, const char *method, const char *asked)
{
  column_choice choice = {.scene = c->scene->name,
                          .method = method,
                          .name_at = column_name_at,
                          .list = c,
                          .place = c->place};
  int code = asked != NULL ? choice_add_all(&choice, asked) : DONE;
  for (int i = 0; i < c->scene->column_count && asked == NULL && code == DONE; i++)
    code = choice_add(&choice, c->scene->column[i]);
  for (int i = 0; i < choice.count; i++) columns_show(c, c->place[i]);
  return code;
}

static bool columns_allocate(run_columns *c)
{
  const size_t nq = (size_t)c->scene->nq, nv = (size_t)c->scene->nv;
  const size_t invariants = (size_t)dvi_system_invariant_count(c->scene->system),
               rows = (size_t)reaction_count(c->scene),
               contacts = (size_t)c->scene->terms->contact_count,
               most = nq + 2 * nv + 2 * invariants + rows + contacts + COLUMN_KINDS;
  c->all = calloc(most, sizeof *c->all);
  c->column = calloc(most, sizeof *c->column);
  c->place = calloc(most, sizeof *c->place);
  c->invariant = calloc(invariants, sizeof *c->invariant);
  c->balance = calloc(invariants, sizeof *c->balance);
  c->balance_name = calloc(invariants, sizeof *c->balance_name);
  c->velocity = calloc(nv, sizeof *c->velocity);
  c->room = calloc(nq + nv, sizeof *c->room);
  c->reaction = calloc(rows + 1, sizeof *c->reaction);
  c->reaction_name = calloc(rows + 1, sizeof *c->reaction_name);
  c->force = calloc(contacts + 1, sizeof *c->force);
  c->force_name = calloc(contacts + 1, sizeof *c->force_name);
  return c->force != NULL && c->force_name != NULL && c->reaction != NULL &&
         c->reaction_name != NULL && c->all != NULL && c->column != NULL && c->place != NULL &&
         c->invariant != NULL && c->balance != NULL && c->balance_name != NULL &&
         c->velocity != NULL && c->room != NULL;
}

int columns_choose(run_columns *c, const problem *scene, const dvi_integrator *integrator,
                   const char *asked)
{
  *c = (run_columns){.scene = scene};
  if (!columns_allocate(c)) return library_error(DVI_NO_MEMORY);
  columns_list(c, integrator);
  const int code = refuse_same_column(c, dvi_integrator_method(integrator));
  if (code != DONE) return code;
  if (asked != NULL || scene->column != NULL)
    return columns_show_named(c, dvi_integrator_method(integrator), asked);
  for (int k = 0; k < c->there; k++)
    if (c->all[k].kind != COLUMN_REACTION && c->all[k].kind != COLUMN_FORCE) columns_show(c, k);
  return DONE;
}

void columns_clear(run_columns *c)
{
  free(c->all);
  free(c->column);
  free(c->place);
  free(c->invariant);
  free(c->balance);
  free(c->balance_name);
  free(c->velocity);
  free(c->room);
  free(c->reaction);
  free(c->reaction_name);
  free(c->force);
  free(c->force_name);
  *c = (run_columns){.count = 0};
}

/* ---- rows ---- */

static dvi_status columns_evaluate(run_columns *c, dvi_integrator *integrator)
{
  const double t = dvi_integrator_time(integrator), *q = dvi_integrator_q(integrator),
               *p = dvi_integrator_p(integrator);
  dvi_status status = DVI_OK;
  for (int k = 0; k < c->count && status == DVI_OK; k++) {
    const int i = c->column[k].index;
    if (c->column[k].kind == COLUMN_INVARIANT)
      status = dvi_integrator_invariant(integrator, i, &c->invariant[i]);
    if (c->column[k].kind == COLUMN_BALANCE)
      status = dvi_integrator_balance(integrator, i, &c->balance[i]);
    if (c->column[k].kind == COLUMN_FORCE)
      status = dvi_integrator_contact_force(integrator, i, &c->force[i]);
  }
  if (status == DVI_OK && c->shows[COLUMN_VELOCITY])
    status = velocity_near(c->scene, t, q, p, c->room, c->velocity);
  if (status == DVI_OK && c->shows[COLUMN_CONSTRAINT])
    status = dvi_integrator_constraint(integrator, &c->constraint);
  if (status == DVI_OK && c->shows[COLUMN_REACTION])
    status = dvi_integrator_reactions(integrator, c->reaction);
  if (status == DVI_OK && c->shows[COLUMN_GAP])
    status = dvi_integrator_gap(integrator, &c->gap, NULL);
  if (status == DVI_OK && c->shows[COLUMN_TEMPERATURE])
    status = dvi_integrator_temperature(integrator, &c->temperature);
  return status;
}

bool columns_measure(run_columns *c, dvi_integrator *integrator)
{
  const dvi_status status = columns_evaluate(c, integrator);
  if (status == DVI_OK) return true;
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  char before[64];
  (void)snprintf(before, sizeof before,
                 "run: no row at t = %.17g: ", dvi_integrator_time(integrator));
  complain_of(status, before, counters.steps > 0 ? "; try a smaller --h" : "");
  return false;
}

double columns_number(const run_columns *c, const dvi_integrator *integrator, int k)
{
  const shown_column *column = &c->column[k];
  switch (column->kind) {
  case COLUMN_COORDINATE: return dvi_integrator_q(integrator)[column->index];
  case COLUMN_VELOCITY: return c->velocity[column->index];
  case COLUMN_MOMENTUM: return dvi_integrator_p(integrator)[column->index];
  case COLUMN_INVARIANT: return c->invariant[column->index];
  case COLUMN_BALANCE: return c->balance[column->index];
  case COLUMN_STEP: return dvi_integrator_last_step(integrator);
  case COLUMN_DISTANCE: return dvi_system_distance(c->scene->system, dvi_integrator_q(integrator));
  case COLUMN_CONSTRAINT: return c->constraint;
  case COLUMN_REACTION: return c->reaction[column->index];
  case COLUMN_FORCE: return c->force[column->index];
  case COLUMN_GAP: return c->gap;
  case COLUMN_TEMPERATURE: return c->temperature;
  default: return dvi_integrator_jump(integrator, NULL);
  }
}

void columns_row(const run_columns *c, const dvi_integrator *integrator, double *row)
{
  row[0] = dvi_integrator_time(integrator);
  for (int k = 0; k < c->count; k++) row[k + 1] = columns_number(c, integrator, k);
}
