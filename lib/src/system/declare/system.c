/* Creation of a system. Every term is checked and copied, and its patterns are joined to those of
 * the whole Lagrangian. */
#include "system/system.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/evaluate/dynamics.h"
#include "system/factor.h"
#include "system/gauge.h"
#include "system/mass.h"
#include "system/term/constraint.h"
#include "system/term/contact.h"
#include "system/term/declare.h"
#include "system/term/force.h"
#include "system/term/holonomic.h"
#include "system/term/nonholonomic.h"
#include "system/term/term.h"
#include "system/term/vector.h"

static char *copy_text(const char *text)
{
  return dvi__duplicate(text, strlen(text) + 1, 1);
}

static dvi_status refuse_memory_of_system(void)
{
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for its terms");
}

/* ---- potentials ---- */

static dvi_status check_range(const dvi_potential *given, const char *name)
{
  if (given->reach < 0)
    return dvi__fail(DVI_BAD_SIZE, "system: potential '%s' has reach %d; 0 or more is possible",
                     name, given->reach);
  if (given->reach == 0 || given->gradient_range != NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system: potential '%s' has reach %d but no gradient_range callback", name,
                   given->reach);
}

static dvi_status check_fastest(const dvi_potential *given, const char *name)
{
  if (!(given->fastest >= 0) || isinf(given->fastest))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: potential '%s' has %g as its fastest frequency; a finite number from "
                     "0 on is possible",
                     name, given->fastest);
  if (given->fastest == 0 || given->quadratic) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system: potential '%s' has a fastest frequency but is not quadratic", name);
}

static dvi_status copy_potential(dvi_system *s, const dvi_potential *given,
                                 dvi__potential_term *term)
{
  const char *name = given->name != NULL ? given->name : "potential";
  if (given->value == NULL && given->value_batch == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: potential '%s' has no value callback", name);
  DVI_TRY(dvi__check_shapes(
      name, given->value && given->value_batch, given->gradient && given->gradient_batch,
      given->hessian && given->hessian_batch, given->rate && given->rate_batch));
  DVI_TRY(dvi__check_rate(s, name, given->rate || given->rate_batch));
  DVI_TRY(check_range(given, name));
  DVI_TRY(check_fastest(given, name));
  term->callbacks = *given;
  term->name = copy_text(name);
  if (term->name == NULL) return refuse_memory_of_system();
  term->callbacks.name = term->name;
  const int left_out = given->qq.start == NULL && given->qq.row == NULL;
  return left_out ? DVI_OK : dvi__pattern_copy_symmetric(&given->qq, s->n, name, &term->qq);
}

/* Noise functions are read as potentials. Their place in dvi_noise is the user's. */
static dvi_status copy_noise(dvi_system *s, const dvi_noise *noise)
{
  if (noise == NULL) return DVI_OK;
  s->terms |= DVI__NOISE;
  s->noise = *noise;
  s->noise.functions = NULL;
  s->noise.function_count = 0;
  if (noise->function_count == 0) return DVI_OK;
  s->noise_functions = DVI_NEW(dvi__potential_term, noise->function_count);
  if (s->noise_functions == NULL) return refuse_memory_of_system();
  for (int k = 0; k < noise->function_count; k++) {
    const dvi_potential *given = &noise->functions[k];
    if (given->gradient == NULL && given->gradient_batch == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "system: noise function '%s' has no gradient callback",
                       given->name != NULL ? given->name : "potential");
    s->noise.function_count = k + 1;
    DVI_TRY(copy_potential(s, given, &s->noise_functions[k]));
  }
  return DVI_OK;
}

static dvi_status copy_potentials(dvi_system *s, const dvi_system_terms *terms)
{
  if (terms->potential_count > 0) s->terms |= DVI__POTENTIAL;
  s->potentials = DVI_NEW(dvi__potential_term, terms->potential_count);
  if (s->potentials == NULL) return refuse_memory_of_system();
  for (int k = 0; k < terms->potential_count; k++) {
    s->potential_count = k + 1;
    DVI_TRY(copy_potential(s, &terms->potentials[k], &s->potentials[k]));
    if (terms->potentials[k].fast) s->terms |= DVI__FAST;
  }
  return DVI_OK;
}

/* ---- the whole ---- */

static dvi_status copy_invariants(dvi_system *s, const dvi_system_terms *terms)
{
  s->symmetries = dvi__duplicate(terms->symmetries, (size_t)terms->symmetry_count,
                                 sizeof(dvi_symmetry));
  s->invariants = dvi__duplicate(terms->invariants, (size_t)terms->invariant_count,
                                 sizeof(dvi_invariant));
  s->invariant_names = DVI_NEW(char *,
                               1 + (size_t)terms->symmetry_count + (size_t)terms->invariant_count);
  if (s->symmetries == NULL || s->invariants == NULL || s->invariant_names == NULL)
    return refuse_memory_of_system();
  s->symmetry_count = terms->symmetry_count;
  s->invariant_count = terms->invariant_count;
  for (int i = 0; i < dvi_system_invariant_count(s); i++) {
    const char *name = i == 0                   ? "energy"
                       : i <= s->symmetry_count ? s->symmetries[i - 1].name
                                                : s->invariants[i - 1 - s->symmetry_count].name;
    s->invariant_names[i] = copy_text(name != NULL ? name : "unnamed");
    if (s->invariant_names[i] == NULL) return refuse_memory_of_system();
  }
  for (int i = 0; i < s->symmetry_count; i++) s->symmetries[i].name = s->invariant_names[1 + i];
  for (int i = 0; i < s->invariant_count; i++)
    s->invariants[i].name = s->invariant_names[1 + s->symmetry_count + i];
  return DVI_OK;
}

static dvi_status check_watched(const dvi_system_terms *terms)
{
  for (int i = 0; i < terms->symmetry_count; i++)
    if (terms->symmetries[i].generator == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "system: symmetry %d has no generator", i);
  for (int i = 0; i < terms->invariant_count; i++)
    if (terms->invariants[i].value == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "system: invariant %d has no value callback", i);
  return DVI_OK;
}

static dvi_status check_list(const char *what, int count, const void *list)
{
  if (count < 0)
    return dvi__fail(DVI_BAD_SIZE, "system: %d %s; 0 or more are possible", count, what);
  if (count > 0 && list == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: %d %s declared, but their list is NULL", count,
                     what);
  if (count == 0 && list != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: a list of %s is given, but their count is 0", what);
  return DVI_OK;
}

static dvi_status check_hamiltonian(const dvi_system_terms *terms)
{
  if (terms->hamiltonian == NULL && terms->constraint != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: constraints without a Hamiltonian; declare it, too");
  if (terms->hamiltonian != NULL && terms->potential_count > 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: %d potentials beside a Hamiltonian; add them to it",
                     terms->potential_count);
  return DVI_OK;
}

static dvi_status check_contacts(const dvi_system_terms *terms)
{
  const char *beside = terms->factors != NULL       ? "factors"
                       : terms->one_form != NULL    ? "a one-form"
                       : terms->hamiltonian != NULL ? "a Hamiltonian"
                                                    : NULL;
  DVI_TRY(check_list("contacts", terms->contact_count, terms->contacts));
  if (terms->contact_count > 0 && (terms->holonomic_count > 0 || terms->nonholonomic_count > 0))
    return dvi__fail(DVI_UNSUPPORTED,
                     "system: contacts beside %sholonomic constraints; write the constraints as "
                     "springs, or choose coordinates without them",
                     terms->holonomic_count > 0 ? "" : "non");
  if (terms->contact_count == 0 || beside == NULL) return DVI_OK;
  return dvi__fail(
      DVI_UNSUPPORTED,
      "system: contacts go with a mass of coordinates, or with a general Lagrangian, not with %s",
      beside);
}

static dvi_status check_forces_and_joints(const dvi_system_terms *terms)
{
  DVI_TRY(check_list("forces", terms->force_count, terms->forces));
  DVI_TRY(check_list("holonomic constraints", terms->holonomic_count, terms->holonomics));
  DVI_TRY(check_contacts(terms));
  DVI_TRY(check_list("nonholonomic constraints", terms->nonholonomic_count, terms->nonholonomics));
  const int none = terms->force_count == 0 && terms->holonomic_count == 0 &&
                   terms->nonholonomic_count == 0,
            rolls_on_groups = terms->factors != NULL && terms->nonholonomic_count > 0;
  if (none || (terms->one_form == NULL && terms->hamiltonian == NULL && !rolls_on_groups))
    return DVI_OK;
  return dvi__fail(
      DVI_UNSUPPORTED,
      "system: %s go with a mass of coordinates, or with a general Lagrangian, not with %s",
      rolls_on_groups || (terms->force_count == 0 && terms->holonomic_count == 0)
          ? "nonholonomic constraints"
      : terms->force_count > 0 ? "forces"
                               : "holonomic constraints",
      rolls_on_groups           ? "factors"
      : terms->one_form != NULL ? "a one-form"
                                : "a Hamiltonian");
}

static dvi_status check_vector_potential(const dvi_system_terms *terms)
{
  const char *beside = terms->factors != NULL       ? "factors"
                       : terms->lagrangian != NULL  ? "a general Lagrangian; add it to this one"
                       : terms->one_form != NULL    ? "a one-form; add it to this one"
                       : terms->hamiltonian != NULL ? "a Hamiltonian"
                       : terms->holonomic_count > 0 ? "holonomic constraints; declare a general "
                                                      "Lagrangian with both the mass and it"
                       : terms->nonholonomic_count > 0
                           ? "nonholonomic constraints; declare a general Lagrangian with both the "
                             "mass and it"
                           : NULL;
  if (terms->vector_potential == NULL || beside == NULL) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "system: a vector potential goes with a constant mass of coordinates, not with "
                   "%s",
                   beside);
}

/* Uniform friction scales all momenta, which leaves Legendre's map of a vector potential, and what
 * holds at the ends of steps with constraints and hits, out of account. */
static dvi_status check_damping(const dvi_system_terms *terms)
{
  const char *beside = terms->one_form != NULL           ? "a one-form"
                       : terms->hamiltonian != NULL      ? "a Hamiltonian"
                       : terms->vector_potential != NULL ? "a vector potential"
                       : terms->holonomic_count > 0      ? "holonomic constraints"
                       : terms->nonholonomic_count > 0   ? "nonholonomic constraints"
                       : terms->contact_count > 0        ? "contacts"
                                                         : NULL;
  if (!(terms->damping >= 0) || isinf(terms->damping))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: the damping is %g; a finite rate, 0 or more, is needed",
                     terms->damping);
  if (terms->damping == 0 || beside == NULL) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "system: damping does not stand beside %s; declare%s", beside,
                   terms->one_form != NULL || terms->hamiltonian != NULL
                       ? " a Lagrangian with a mass"
                       : " friction as a force");
}

static dvi_status check_noise(const dvi_system_terms *terms)
{
  const dvi_noise *noise = terms->noise;
  if (noise == NULL) return DVI_OK;
  const char *beside = terms->factors != NULL            ? "factors"
                       : terms->lagrangian != NULL       ? "a general Lagrangian"
                       : terms->one_form != NULL         ? "a one-form"
                       : terms->hamiltonian != NULL      ? "a Hamiltonian"
                       : terms->nonholonomic_count > 0   ? "nonholonomic constraints"
                       : terms->contact_count > 0        ? "contacts"
                       : terms->vector_potential != NULL ? "a vector potential"
                       : terms->damping > 0 ? "damping; the bath has a friction of its own"
                                            : NULL;
  if (beside != NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "system: noise goes with a constant mass of coordinates, not with %s", beside);
  if (!(noise->temperature >= 0) || !isfinite(noise->temperature))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: the temperature of the noise is %g; 0 or more is possible",
                     noise->temperature);
  if (!(noise->friction >= 0) || !isfinite(noise->friction))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: the friction of the noise is %g; 0 or more is possible",
                     noise->friction);
  return check_list("noise functions", noise->function_count, noise->functions);
}

static const dvi__dynamics *const kinds[] = {
#define DYNAMICS(name) &dvi__dynamics_##name,
#include "system/declare/dynamics.def"
#undef DYNAMICS
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* Find the one kind of dynamics that the terms declare. */
static dvi_status check_kind(const dvi_system_terms *terms)
{
  const dvi__dynamics *declared = NULL;
  for (int k = 0; k < KINDS; k++) {
    if (!kinds[k]->is_declared(terms)) continue;
    if (declared != NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "system: both a %s and a %s are declared; one is possible",
                       declared->name, kinds[k]->name);
    declared = kinds[k];
  }
  if (declared == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: neither a mass (other than 0) nor a general "
                                       "Lagrangian nor another kind of dynamics is declared");
  return DVI_OK;
}

static dvi_status check_declared_terms(const dvi_system_terms *terms)
{
  const dvi_mass *mass = &terms->mass;
  const int has_pattern = mass->pattern.start != NULL || mass->pattern.row != NULL;
  DVI_TRY(check_list("factors", terms->factor_count, terms->factors));
  if (terms->factors == NULL && terms->dimension < 1)
    return dvi__fail(DVI_BAD_SIZE, "system: dimension %d; at least 1 is needed", terms->dimension);
  if (terms->factors == NULL && terms->dimension > DVI__DIMENSION_MOST)
    return dvi__fail(DVI_BAD_SIZE, "system: dimension %d; at most %d is possible", terms->dimension,
                     DVI__DIMENSION_MOST);
  if (terms->factors != NULL &&
      (terms->lagrangian != NULL || terms->one_form != NULL || terms->hamiltonian != NULL))
    return dvi__fail(DVI_UNSUPPORTED, "system: factors go with a constant mass, not with %s",
                     terms->lagrangian != NULL ? "a general Lagrangian"
                     : terms->one_form != NULL ? "a one-form"
                                               : "a Hamiltonian");
  DVI_TRY(check_list("potentials", terms->potential_count, terms->potentials));
  DVI_TRY(check_list("symmetries", terms->symmetry_count, terms->symmetries));
  DVI_TRY(check_list("invariants", terms->invariant_count, terms->invariants));
  DVI_TRY(check_kind(terms));
  DVI_TRY(check_hamiltonian(terms));
  DVI_TRY(check_forces_and_joints(terms));
  DVI_TRY(check_vector_potential(terms));
  DVI_TRY(check_damping(terms));
  DVI_TRY(check_noise(terms));
  if (terms->gauge != NULL && terms->one_form == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system: a gauge without a one-form; it changes nothing else");
  if (has_pattern && mass->values == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the mass has a pattern but no values");
  return check_watched(terms);
}

static dvi_status declare_dynamics(dvi_system *s, const dvi_system_terms *terms)
{
  for (int k = 0; k < KINDS; k++)
    if (kinds[k]->is_declared(terms)) s->dynamics = kinds[k];
  return s->dynamics->declare(terms, s);
}

static dvi_status system_fill(dvi_system *s, const dvi_system_terms *terms)
{
  DVI_TRY(dvi__factors_lay_out(terms, s));
  s->autonomous = terms->autonomous != 0;
  DVI_TRY(declare_dynamics(s, terms));
  DVI_TRY(copy_potentials(s, terms));
  DVI_TRY(dvi__forces_copy(s, terms));
  DVI_TRY(dvi__vector_copy(s, terms));
  DVI_TRY(dvi__holonomics_copy(s, terms));
  DVI_TRY(dvi__nonholonomics_copy(s, terms));
  DVI_TRY(dvi__rows_join(s));
  DVI_TRY(dvi__contacts_copy(s, terms));
  DVI_TRY(copy_invariants(s, terms));
  s->damping = terms->damping;
  if (s->damping > 0) s->terms |= DVI__DAMPING;
  DVI_TRY(copy_noise(s, terms->noise));
  dvi__system_declared(s, &s->declared);
  return DVI_OK;
}

dvi_status dvi_system_create(const dvi_system_terms *terms, dvi_system **system)
{
  if (system == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: no place for the result");
  *system = NULL;
  if (terms == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "system: no terms");
  return dvi__system_create_part(terms, NULL, system);
}

dvi_status dvi__system_create_part(const dvi_system_terms *terms, const dvi_system *mass_of,
                                   dvi_system **system)
{
  *system = NULL;
  DVI_TRY(check_declared_terms(terms));
  dvi_system *made = DVI_NEW(dvi_system, 1);
  if (made == NULL) return refuse_memory_of_system();
  made->mass_of = mass_of;
  const dvi_status status = system_fill(made, terms);
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
  for (int k = 0; k < s->noise.function_count; k++) clear_potential(&s->noise_functions[k]);
  for (int k = 0; k < s->force_count; k++) dvi__force_clear(&s->forces[k]);
  dvi__vector_clear(&s->vector);
  for (int k = 0; k < s->holonomic_count; k++) dvi__holonomic_clear(&s->holonomics[k]);
  for (int k = 0; k < s->nonholonomic_count; k++) dvi__nonholonomic_clear(&s->nonholonomics[k]);
  for (int k = 0; k < s->contact_count; k++) dvi__contact_clear(&s->contacts[k]);
  for (int i = 0; s->invariant_names != NULL && i < dvi_system_invariant_count(s); i++)
    dvi__release(s->invariant_names[i]);
  if (s->lagrangian != NULL) dvi__general_clear(s->lagrangian);
  dvi__release(s->lagrangian);
  dvi__constraint_clear(&s->constraint);
  dvi__linear_destroy(&s->mass_factor);
  dvi__pattern_clear(&s->qq);
  dvi__pattern_clear(&s->qv);
  dvi__pattern_clear(&s->vv);
  dvi__pattern_clear(&s->by_q);
  dvi__pattern_clear(&s->by_v);
  dvi__pattern_clear(&s->rows_q);
  dvi__pattern_clear(&s->rows_qq);
  dvi__release(s->slots);
  dvi__release(s->mass_diagonal);
  dvi__release(s->mass_values);
  dvi__release(s->potentials);
  dvi__release(s->noise_functions);
  dvi__release(s->forces);
  dvi__release(s->holonomics);
  dvi__release(s->nonholonomics);
  dvi__release(s->contacts);
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

int dvi_system_contact_count(const dvi_system *system)
{
  return system != NULL ? system->contact_count : 0;
}

const char *dvi_system_contact_name(const dvi_system *system, int k)
{
  return k >= 0 && k < dvi_system_contact_count(system) ? system->contacts[k].gap.name : NULL;
}

int dvi_system_invariant_count(const dvi_system *system)
{
  return system != NULL ? 1 + system->symmetry_count + system->invariant_count : 0;
}

const char *dvi_system_invariant_name(const dvi_system *system, int i)
{
  return i >= 0 && i < dvi_system_invariant_count(system) ? system->invariant_names[i] : NULL;
}
