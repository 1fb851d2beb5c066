/* Hashes of a system's declaration, by which files and other systems recognise it. */
#include <string.h>

#include "core/hash.h"
#include "system/system.h"

static uint64_t hash_pattern(uint64_t hash, const dvi__pattern *pattern)
{
  if (pattern->start == NULL) return dvi__hash(hash, 1, "");
  hash = dvi__hash(hash, ((size_t)pattern->columns + 1) * sizeof(int), pattern->start);
  return dvi__hash(hash, (size_t)dvi__pattern_entries(pattern) * sizeof(int), pattern->row);
}

static uint64_t hash_text(uint64_t hash, const char *text)
{
  return dvi__hash(hash, strlen(text) + 1, text);
}

static uint64_t hash_terms(const dvi_system *s)
{
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof s->n, &s->n);
  hash = dvi__hash(hash, sizeof s->terms, &s->terms);
  for (int c = 0; c < s->slot_count; c++)
    hash = dvi__hash(hash, sizeof s->slots[c].kind, &s->slots[c].kind);
  return hash;
}

static uint64_t hash_masses(const dvi_system *s)
{
  uint64_t hash = DVI__HASH_START;
  if (s->mass_diagonal != NULL)
    hash = dvi__hash(hash, (size_t)s->n * sizeof(double), s->mass_diagonal);
  if (s->mass_values != NULL)
    hash = dvi__hash(hash, (size_t)dvi__pattern_entries(&s->vv) * sizeof(double), s->mass_values);
  return hash;
}

static uint64_t hash_damping(const dvi_system *s)
{
  return dvi__hash(DVI__HASH_START, sizeof s->damping, &s->damping);
}

static uint64_t hash_patterns(const dvi_system *s)
{
  uint64_t hash = hash_pattern(hash_pattern(DVI__HASH_START, &s->qv), &s->vv);
  if (s->lagrangian != NULL) hash = hash_pattern(hash, &s->lagrangian->qq);
  if (s->constraint != NULL) hash = hash_pattern(hash, &s->constraint->gradients);
  for (int k = 0; k < s->potential_count; k++) hash = hash_pattern(hash, &s->potentials[k].qq);
  if (s->vector != NULL) hash = hash_pattern(hash, &s->vector->qq);
  return hash;
}

static uint64_t hash_potentials(const dvi_system *s)
{
  uint64_t hash = DVI__HASH_START;
  for (int k = 0; k < s->potential_count; k++) {
    const dvi__potential_term *term = &s->potentials[k];
    const int speed[] = {term->callbacks.fast != 0, term->callbacks.quadratic != 0};
    hash = dvi__hash(hash_text(hash, term->name), sizeof speed, speed);
    if (term->callbacks.without_hessian) hash = hash_text(hash, "without a Hessian");
  }
  return hash;
}

/* Forces of the same patterns may stand for one another. */
static uint64_t hash_forces(const dvi_system *s)
{
  uint64_t hash = DVI__HASH_START;
  for (int k = 0; k < s->force_count; k++) {
    const dvi__force_term *term = &s->forces[k];
    const int is_differenced = term->callbacks.jacobian == NULL &&
                               term->callbacks.jacobian_batch == NULL;
    const int kind[] = {term->callbacks.without_velocity != 0, is_differenced};
    hash = dvi__hash(hash_text(hash, term->name), sizeof kind, kind);
    hash = hash_pattern(hash_pattern(hash, &term->by_q), &term->by_v);
  }
  return hash;
}

static uint64_t hash_holonomics(const dvi_system *s)
{
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof s->row_count, &s->row_count);
  for (int k = 0; k < s->holonomic_count; k++) {
    const dvi__holonomic_term *term = &s->holonomics[k];
    const int kind[] = {term->callbacks.count, term->callbacks.hessian != NULL,
                        term->callbacks.rate != NULL};
    hash = dvi__hash(hash_text(hash, term->name), sizeof kind, kind);
  }
  return hash_pattern(hash_pattern(hash, &s->rows_q), &s->rows_qq);
}

/* The joined patterns are those of hash_holonomics. */
static uint64_t hash_nonholonomics(const dvi_system *s)
{
  uint64_t hash = DVI__HASH_START;
  for (int k = 0; k < s->nonholonomic_count; k++) {
    const dvi__nonholonomic_term *term = &s->nonholonomics[k];
    const int kind[] = {term->callbacks.count, term->callbacks.affine != NULL,
                        term->callbacks.derivative != NULL};
    hash = dvi__hash(hash_text(hash, term->name), sizeof kind, kind);
    hash = hash_pattern(hash, &term->by_q);
  }
  return hash;
}

static uint64_t hash_contacts(const dvi_system *s)
{
  uint64_t hash = DVI__HASH_START;
  for (int k = 0; k < s->contact_count; k++) {
    const dvi__contact_term *term = &s->contacts[k];
    const double law[] = {term->callbacks.restitution, term->callbacks.friction};
    const int kind[] = {term->callbacks.rate != NULL, term->callbacks.tangent_count,
                        term->callbacks.hold};
    hash = dvi__hash(hash_text(hash, term->gap.name), sizeof law, law);
    hash = hash_pattern(dvi__hash(hash, sizeof kind, kind), &term->gap.gradients);
    hash = hash_pattern(hash, &term->tangents);
  }
  return hash;
}

static uint64_t hash_noise(const dvi_system *s)
{
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof s->noise.temperature, &s->noise.temperature);
  hash = dvi__hash(hash, sizeof s->noise.friction, &s->noise.friction);
  hash = dvi__hash(hash, sizeof s->noise.seed, &s->noise.seed);
  hash = dvi__hash(hash, sizeof s->noise.stream, &s->noise.stream);
  for (int k = 0; k < s->noise.function_count; k++)
    hash = hash_text(hash, s->noise_functions[k].name);
  return hash;
}

static uint64_t hash_invariants(const dvi_system *s)
{
  uint64_t hash = DVI__HASH_START;
  for (int i = 0; i < dvi_system_invariant_count(s); i++)
    hash = hash_text(hash, s->invariant_names[i]);
  return hash;
}

void dvi__system_declared(const dvi_system *system, dvi__declared *declared)
{
  *declared = (dvi__declared){{hash_terms(system), hash_masses(system), hash_patterns(system),
                               hash_potentials(system), hash_invariants(system),
                               hash_forces(system), hash_holonomics(system),
                               hash_nonholonomics(system), hash_contacts(system),
                               hash_damping(system), hash_noise(system)}};
}

const char *dvi__declared_difference(const dvi__declared *one, const dvi__declared *other)
{
  static const char *const name[DVI__DECLARED_PARTS] = {"terms",
                                                        "masses or inertias",
                                                        "patterns of derivatives",
                                                        "names or speeds of potentials",
                                                        "names of invariants",
                                                        "forces",
                                                        "holonomic constraints",
                                                        "nonholonomic constraints",
                                                        "contacts",
                                                        "damping",
                                                        "noise"};
  for (int part = 0; part < DVI__DECLARED_PARTS; part++)
    if (one->hash[part] != other->hash[part]) return name[part];
  return NULL;
}
