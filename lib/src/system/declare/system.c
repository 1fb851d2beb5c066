/* Making a system: every term is checked, copied, and its patterns joined to those of the whole Lagrangian. */
#include "system/system.h"

#include <pthread.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/evaluate/dirac.h"
#include "system/factor.h"
#include "system/gauge.h"
#include "system/mass.h"
#include "system/term/term.h"

static char *copy_text(const char *text)
{
  return dvi__duplicate(text, strlen(text) + 1, 1);
}

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for its terms");
}

/* ---- general Lagrangian ---- */

static dvi_status make_groups(const dvi__pattern *pattern, dvi__groups *groups)
{
  dvi__release(groups->of_column);
  groups->of_column = DVI_NEW(int, pattern->columns);
  if (groups->of_column == NULL) return no_memory();
  return dvi__pattern_groups(pattern, groups->of_column, &groups->count);
}

dvi_status dvi__general_group(dvi__lagrangian_term *term)
{
  dvi__pattern v_columns;
  DVI_TRY(make_groups(&term->qq, &term->q_groups));
  DVI_TRY(dvi__pattern_union(&term->qv, &term->vv, &v_columns));
  const dvi_status status = make_groups(&v_columns, &term->v_groups);
  dvi__pattern_clear(&v_columns);
  return status;
}

/* Only one of two shapes would ever be called. */
static dvi_status check_shapes(const char *owner, int values, int gradients, int hessians, int rates)
{
  if (!values && !gradients && !hessians && !rates) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "system: %s has its %s callback in two shapes, one-point and batch; declare one", owner,
                   values      ? "value"
                   : gradients ? "gradient"
                   : hessians  ? "Hessian"
                               : "rate");
}

/* It would never be asked for. */
static dvi_status check_rate(const dvi_system *s, const char *owner, int given)
{
  if (!given || !s->autonomous) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "system: %s has a rate, but the system is declared autonomous; leave out one of them", owner);
}

/* A function of q and v, or of q and p; `part` names its Hessian's blocks. */
static dvi_status copy_general(dvi_system *s, const dvi_lagrangian *given, const char *name, const char *const part[3])
{
  dvi__lagrangian_term *term = s->lagrangian = DVI_NEW(dvi__lagrangian_term, 1);
  if (term == NULL) return no_memory();
  term->name = name;
  term->callbacks = *given;
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, s->n, part[0], &term->qq));
  DVI_TRY(dvi__pattern_copy(&given->qv, s->n, part[1], &term->qv));
  DVI_TRY(dvi__pattern_copy_symmetric(&given->vv, s->n, part[2], &term->vv));
  DVI_TRY(dvi__pattern_union(&term->qv, &term->qv, &s->qv));
  DVI_TRY(dvi__pattern_union(&term->vv, &term->vv, &s->vv));
  const int differenced = given->hessian == NULL && given->hessian_batch == NULL;
  return differenced ? dvi__general_group(term) : DVI_OK;
}

static dvi_status copy_lagrangian(dvi_system *s, const dvi_lagrangian *given)
{
  static const char *const part[] = {"Lagrangian: d2L/dq2", "Lagrangian: d2L/dqdv", "Lagrangian: d2L/dv2"};
  if (given->value == NULL && given->value_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the Lagrangian has no value callback");
  DVI_TRY(check_shapes("the Lagrangian", given->value && given->value_batch, given->gradient && given->gradient_batch,
                       given->hessian && given->hessian_batch, given->rate && given->rate_batch));
  DVI_TRY(check_rate(s, "the Lagrangian", given->rate || given->rate_batch));
  s->terms |= DVI__LAGRANGIAN;
  return copy_general(s, given, "Lagrangian", part);
}

/* H stands where a general Lagrangian stands, and p where its v does. */
static dvi_status copy_hamiltonian(dvi_system *s, const dvi_hamiltonian *given, const dvi_constraint *constraint)
{
  static const char *const part[] = {"Hamiltonian: d2H/dq2", "Hamiltonian: d2H/dqdp", "Hamiltonian: d2H/dp2"};
  const dvi_lagrangian function = {.value = given->value,
                                   .gradient = given->gradient,
                                   .hessian = given->hessian,
                                   .qq = given->qq,
                                   .qv = given->qp,
                                   .vv = given->pp,
                                   .user = given->user};
  if (given->value == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the Hamiltonian has no %s callback", given->value == NULL ? "value" : "gradient");
  s->terms |= constraint != NULL ? DVI__HAMILTONIAN : DVI__CANONICAL;
  DVI_TRY(copy_general(s, &function, "Hamiltonian", part));
  return constraint != NULL ? dvi__constraint_copy(constraint, s->n, &s->constraint) : DVI_OK;
}

static dvi_status join_two_form(dvi__lagrangian_term *term)
{
  dvi__pattern vq;
  DVI_TRY(dvi__pattern_transpose(&term->qv, &vq));
  const dvi_status status = dvi__pattern_union(&term->qv, &vq, &term->omega);
  dvi__pattern_clear(&vq);
  return status;
}

/* alpha(q).v is a Lagrangian whose L_qv holds the gradients of alpha, and whose L_vv has no entries. */
static dvi_status copy_one_form(dvi_system *s, const dvi_one_form *given, const dvi_gauge *gauge)
{
  if (given->value == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the one-form has no %s callback", given->value == NULL ? "value" : "gradient");
  if (s->n % 2 != 0)
    return dvi__fail(DVI_BAD_SIZE, "system: dimension %d with a one-form; its two-form is singular unless the dimension is even",
                     s->n);
  s->terms |= DVI__ONE_FORM;
  dvi__lagrangian_term *term = s->lagrangian = DVI_NEW(dvi__lagrangian_term, 1);
  if (term == NULL) return no_memory();
  term->name = "one-form";
  term->one_form = *given;
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, s->n, "one-form: d2(alpha.v)/dq2", &term->qq));
  DVI_TRY(dvi__pattern_copy(&given->gradients, s->n, "one-form: gradients", &term->qv));
  DVI_TRY(dvi__pattern_empty(s->n, &term->vv));
  if (gauge != NULL) DVI_TRY(dvi__gauge_join(gauge, term));
  DVI_TRY(join_two_form(term));
  DVI_TRY(dvi__pattern_union(&term->qv, &term->qv, &s->qv));
  DVI_TRY(dvi__pattern_empty(s->n, &s->vv));
  return dvi__general_has_hessian(term) ? DVI_OK : dvi__general_group(term);
}

/* ---- potentials ---- */

static dvi_status check_range(const dvi_potential *given, const char *name)
{
  if (given->reach < 0)
    return dvi__fail(DVI_BAD_SIZE, "system: potential '%s' has reach %d; 0 or more is possible", name, given->reach);
  if (given->reach == 0 || given->gradient_range != NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "system: potential '%s' has reach %d but no gradient_range callback", name, given->reach);
}

static dvi_status copy_potential(dvi_system *s, const dvi_potential *given, dvi__potential_term *term)
{
  const char *name = given->name != NULL ? given->name : "potential";
  if (given->value == NULL && given->value_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: potential '%s' has no value callback", name);
  DVI_TRY(check_shapes(name, given->value && given->value_batch, given->gradient && given->gradient_batch,
                       given->hessian && given->hessian_batch, given->rate && given->rate_batch));
  DVI_TRY(check_rate(s, name, given->rate || given->rate_batch));
  DVI_TRY(check_range(given, name));
  if (given->fast) s->terms |= DVI__FAST;
  term->callbacks = *given;
  term->name = copy_text(name);
  if (term->name == NULL) return no_memory();
  term->callbacks.name = term->name;
  const int left_out = given->qq.start == NULL && given->qq.row == NULL;
  return left_out ? DVI_OK : dvi__pattern_copy_symmetric(&given->qq, s->n, name, &term->qq);
}

static dvi_status copy_potentials(dvi_system *s, const dvi_system_terms *terms)
{
  if (terms->potential_count > 0) s->terms |= DVI__POTENTIAL;
  s->potentials = DVI_NEW(dvi__potential_term, terms->potential_count);
  if (s->potentials == NULL) return no_memory();
  for (int k = 0; k < terms->potential_count; k++) {
    s->potential_count = k + 1;
    DVI_TRY(copy_potential(s, &terms->potentials[k], &s->potentials[k]));
  }
  return DVI_OK;
}

/* ---- the whole ---- */

static dvi_status widen(dvi__pattern *whole, const dvi__pattern *part)
{
  dvi__pattern sum;
  DVI_TRY(dvi__pattern_union(whole, part, &sum));
  dvi__pattern_clear(whole);
  *whole = sum;
  return DVI_OK;
}

static dvi_status embed(const dvi__pattern *part, const dvi__pattern *whole, int **where)
{
  dvi__release(*where);
  *where = DVI_NEW(int, dvi__pattern_entries(part));
  if (*where == NULL) return no_memory();
  dvi__pattern_embed(part, whole, *where);
  return DVI_OK;
}

static dvi_status complete_potential(const dvi_system *s, dvi__potential_term *term)
{
  const int differenced = term->callbacks.hessian == NULL && term->callbacks.hessian_batch == NULL;
  const dvi_status status = term->qq.start == NULL ? dvi__pattern_copy(&(dvi_pattern){0}, s->n, term->name, &term->qq) : DVI_OK;
  if (status != DVI_OK) return dvi__fail_in(status, "the Hessian of '%s'", term->name);
  return differenced ? make_groups(&term->qq, &term->groups) : DVI_OK;
}

static dvi_status join_patterns(dvi_system *s, dvi__pattern *qq)
{
  for (int k = 0; k < s->potential_count; k++) DVI_TRY(complete_potential(s, &s->potentials[k]));
  DVI_TRY(dvi__pattern_empty(s->n, qq));
  if (s->lagrangian != NULL) DVI_TRY(widen(qq, &s->lagrangian->qq));
  for (int k = 0; k < s->potential_count; k++) DVI_TRY(widen(qq, &s->potentials[k].qq));
  if (s->lagrangian != NULL) DVI_TRY(embed(&s->lagrangian->qq, qq, &s->lagrangian->in_qq));
  for (int k = 0; k < s->potential_count; k++) DVI_TRY(embed(&s->potentials[k].qq, qq, &s->potentials[k].in_qq));
  return DVI_OK;
}

/* Nothing that a user of the system sees changes, so the system is const to him; the lock is for users on other threads. What a failure leaves
 * is made anew by the next call, or freed with the system. */
dvi_status dvi__system_prepare_hessian(const dvi_system *system)
{
  static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
  dvi_system *s = (dvi_system *)(uintptr_t)system;
  dvi_status status = DVI_OK;
  (void)pthread_mutex_lock(&lock);
  if (s->qq.start == NULL) {
    dvi__pattern qq = {0};
    status = join_patterns(s, &qq);
    if (status == DVI_OK)
      s->qq = qq;
    else
      dvi__pattern_clear(&qq);
  }
  (void)pthread_mutex_unlock(&lock);
  return status;
}

static dvi_status copy_invariants(dvi_system *s, const dvi_system_terms *terms)
{
  s->symmetries = dvi__duplicate(terms->symmetries, (size_t)terms->symmetry_count, sizeof(dvi_symmetry));
  s->invariants = dvi__duplicate(terms->invariants, (size_t)terms->invariant_count, sizeof(dvi_invariant));
  s->invariant_names = DVI_NEW(char *, 1 + (size_t)terms->symmetry_count + (size_t)terms->invariant_count);
  if (s->symmetries == NULL || s->invariants == NULL || s->invariant_names == NULL) return no_memory();
  s->symmetry_count = terms->symmetry_count;
  s->invariant_count = terms->invariant_count;
  for (int i = 0; i < dvi_system_invariant_count(s); i++) {
    const char *name = i == 0                   ? "energy"
                       : i <= s->symmetry_count ? s->symmetries[i - 1].name
                                                : s->invariants[i - 1 - s->symmetry_count].name;
    s->invariant_names[i] = copy_text(name != NULL ? name : "unnamed");
    if (s->invariant_names[i] == NULL) return no_memory();
  }
  for (int i = 0; i < s->symmetry_count; i++) s->symmetries[i].name = s->invariant_names[1 + i];
  for (int i = 0; i < s->invariant_count; i++) s->invariants[i].name = s->invariant_names[1 + s->symmetry_count + i];
  return DVI_OK;
}

static dvi_status check_watched(const dvi_system_terms *terms)
{
  for (int i = 0; i < terms->symmetry_count; i++)
    if (terms->symmetries[i].generator == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: symmetry %d has no generator", i);
  for (int i = 0; i < terms->invariant_count; i++)
    if (terms->invariants[i].value == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: invariant %d has no value callback", i);
  return DVI_OK;
}

static dvi_status check_list(const char *what, int count, const void *list)
{
  if (count < 0) return dvi__fail(DVI_BAD_SIZE, "system: %d %s; 0 or more are possible", count, what);
  if (count > 0 && list == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: %d %s declared, but their list is NULL", count, what);
  if (count == 0 && list != NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: a list of %s is given, but their count is 0", what);
  return DVI_OK;
}

static dvi_status check_hamiltonian(const dvi_system_terms *terms)
{
  if (terms->hamiltonian == NULL && terms->constraint != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: constraints without a Hamiltonian; declare it, too");
  if (terms->hamiltonian != NULL && terms->potential_count > 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: %d potentials beside a Hamiltonian; add them to it", terms->potential_count);
  return DVI_OK;
}

static dvi_status check_terms(const dvi_system_terms *terms)
{
  const dvi_mass *mass = &terms->mass;
  const int has_pattern = mass->pattern.start != NULL || mass->pattern.row != NULL;
  const int has_mass = mass->scalar != 0 || mass->diagonal != NULL || mass->values != NULL;
  DVI_TRY(check_list("factors", terms->factor_count, terms->factors));
  if (terms->factors == NULL && terms->dimension < 1)
    return dvi__fail(DVI_BAD_SIZE, "system: dimension %d; at least 1 is needed", terms->dimension);
  if (terms->factors == NULL && terms->dimension > DVI__DIMENSION_MOST)
    return dvi__fail(DVI_BAD_SIZE, "system: dimension %d; at most %d is possible", terms->dimension, DVI__DIMENSION_MOST);
  if (terms->factors != NULL && (terms->lagrangian != NULL || terms->one_form != NULL || terms->hamiltonian != NULL))
    return dvi__fail(DVI_UNSUPPORTED, "system: factors go with a constant mass, not with %s",
                     terms->lagrangian != NULL ? "a general Lagrangian"
                     : terms->one_form != NULL ? "a one-form"
                                               : "a Hamiltonian");
  DVI_TRY(check_list("potentials", terms->potential_count, terms->potentials));
  DVI_TRY(check_list("symmetries", terms->symmetry_count, terms->symmetries));
  DVI_TRY(check_list("invariants", terms->invariant_count, terms->invariants));
  const int kinds = has_mass + (terms->lagrangian != NULL) + (terms->one_form != NULL) + (terms->hamiltonian != NULL);
  if (kinds > 1)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "system: more than one of a mass, a general Lagrangian, a one-form and a Hamiltonian are declared; one of them is "
        "possible");
  if (kinds == 0 && terms->factors == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: neither a mass (other than 0) nor a general Lagrangian nor a one-form nor a Hamiltonian is declared");
  DVI_TRY(check_hamiltonian(terms));
  if (terms->gauge != NULL && terms->one_form == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: a gauge without a one-form; it changes nothing else");
  if (has_pattern && mass->values == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: the mass has a pattern but no values");
  return check_watched(terms);
}

static dvi_status fill(dvi_system *s, const dvi_system_terms *terms)
{
  DVI_TRY(dvi__factors_lay_out(terms, s));
  s->autonomous = terms->autonomous != 0;
  if (s->cells != NULL)
    DVI_TRY(dvi__mass_copy(terms, s));
  else if (terms->lagrangian != NULL)
    DVI_TRY(copy_lagrangian(s, terms->lagrangian));
  else if (terms->hamiltonian != NULL)
    DVI_TRY(copy_hamiltonian(s, terms->hamiltonian, terms->constraint));
  else
    DVI_TRY(terms->one_form != NULL ? copy_one_form(s, terms->one_form, terms->gauge) : dvi__mass_copy(terms, s));
  DVI_TRY(copy_potentials(s, terms));
  DVI_TRY(copy_invariants(s, terms));
  dvi__system_declared(s, &s->declared);
  return DVI_OK;
}

dvi_status dvi_system_create(const dvi_system_terms *terms, dvi_system **system)
{
  if (system == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: no place for the result");
  *system = NULL;
  if (terms == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: no terms");
  DVI_TRY(check_terms(terms));
  dvi_system *made = DVI_NEW(dvi_system, 1);
  if (made == NULL) return no_memory();
  const dvi_status status = fill(made, terms);
  if (status != DVI_OK) dvi_system_destroy(&made);
  *system = made;
  return status;
}

void dvi__general_clear(dvi__lagrangian_term *term)
{
  dvi__pattern_clear(&term->qq);
  dvi__pattern_clear(&term->qv);
  dvi__pattern_clear(&term->vv);
  dvi__pattern_clear(&term->omega);
  dvi__gauge_clear(&term->gauge);
  dvi__release(term->in_qq);
  dvi__release(term->q_groups.of_column);
  dvi__release(term->v_groups.of_column);
}

static void clear_potential(dvi__potential_term *term)
{
  dvi__pattern_clear(&term->qq);
  dvi__release(term->name);
  dvi__release(term->in_qq);
  dvi__release(term->groups.of_column);
}

void dvi_system_destroy(dvi_system **system)
{
  if (system == NULL || *system == NULL) return;
  dvi_system *s = *system;
  for (int k = 0; k < s->potential_count; k++) clear_potential(&s->potentials[k]);
  for (int i = 0; s->invariant_names != NULL && i < dvi_system_invariant_count(s); i++) dvi__release(s->invariant_names[i]);
  if (s->lagrangian != NULL) dvi__general_clear(s->lagrangian);
  dvi__release(s->lagrangian);
  dvi__constraint_clear(&s->constraint);
  dvi__pattern_clear(&s->qq);
  dvi__pattern_clear(&s->qv);
  dvi__pattern_clear(&s->vv);
  dvi__release(s->cells);
  dvi__release(s->mass_diagonal);
  dvi__release(s->mass_values);
  dvi__release(s->potentials);
  dvi__release(s->symmetries);
  dvi__release(s->invariants);
  dvi__release(s->invariant_names);
  dvi__release(s);
  *system = NULL;
}

int dvi_system_nq(const dvi_system *system)
{
  return system != NULL ? system->n : 0;
}

int dvi_system_nv(const dvi_system *system)
{
  return system != NULL ? system->nv : 0;
}

int dvi_system_autonomous(const dvi_system *system)
{
  return system != NULL && system->autonomous;
}

int dvi_system_invariant_count(const dvi_system *system)
{
  return system != NULL ? 1 + system->symmetry_count + system->invariant_count : 0;
}

const char *dvi_system_invariant_name(const dvi_system *system, int i)
{
  return i >= 0 && i < dvi_system_invariant_count(system) ? system->invariant_names[i] : NULL;
}
