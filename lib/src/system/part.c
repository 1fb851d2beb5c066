#include "system/part.h"

#include "core/memory.h"
#include "core/status.h"

static dvi_mass mass_of_system(const dvi_system *whole)
{
  if (whole->mass_values != NULL)
    return (dvi_mass){.values = whole->mass_values, .pattern = {whole->vv.start, whole->vv.row}};
  if (whole->mass_scalar != 0) return (dvi_mass){.scalar = whole->mass_scalar};
  return (dvi_mass){.diagonal = whole->mass_diagonal};
}

/* Return the user's potential with the library's own pattern. The user's pattern may be gone, and
 * another thread may just complete a missing pattern. */
static dvi_potential declared_potential(const dvi__potential_term *term)
{
  dvi_potential potential = term->callbacks;
  if (potential.qq.start != NULL) potential.qq = (dvi_pattern){term->qq.start, term->qq.row};
  return potential;
}

/* mass_of is the whole if the part has its mass, else NULL. */
static dvi_status make_part(const dvi_system *whole, int fast, const dvi_system *mass_of,
                            dvi_system **part)
{
  dvi_potential *potentials = DVI_NEW(dvi_potential, whole->potential_count);
  dvi_system_terms terms = {.dimension = whole->n,
                            .mass = mass_of != NULL ? mass_of_system(mass_of)
                                                    : (dvi_mass){.scalar = 1},
                            .autonomous = whole->autonomous};
  *part = NULL;
  if (potentials == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for its parts");
  for (int k = 0; k < whole->potential_count; k++)
    if ((whole->potentials[k].callbacks.fast != 0) == fast)
      potentials[terms.potential_count++] = declared_potential(&whole->potentials[k]);
  if (terms.potential_count > 0) terms.potentials = potentials;
  const dvi_status status = dvi__system_create_part(&terms, mass_of, part);
  dvi__release(potentials);
  return status;
}

static dvi_force declared_force(const dvi__force_term *term)
{
  dvi_force force = term->callbacks;
  if (force.by_q.start != NULL) force.by_q = (dvi_pattern){term->by_q.start, term->by_q.row};
  if (force.by_v.start != NULL) force.by_v = (dvi_pattern){term->by_v.start, term->by_v.row};
  return force;
}

static dvi_holonomic declared_holonomic(const dvi__holonomic_term *term)
{
  dvi_holonomic rows = term->callbacks;
  rows.name = term->name;
  rows.row_names = (const char *const *)term->row_names;
  if (rows.gradients.start != NULL)
    rows.gradients = (dvi_pattern){term->gradients.start, term->gradients.row};
  if (rows.qq.start != NULL) rows.qq = (dvi_pattern){term->qq.start, term->qq.row};
  return rows;
}

dvi_status dvi__system_without_noise(const dvi_system *whole, int more, const dvi_force *shaking,
                                     dvi_system **part)
{
  const int potentials = whole->potential_count, forces = whole->force_count + more,
            holonomics = whole->holonomic_count;
  dvi_potential *potential = DVI_NEW(dvi_potential, potentials);
  dvi_force *force = DVI_NEW(dvi_force, forces);
  dvi_holonomic *holonomic = DVI_NEW(dvi_holonomic, holonomics);
  dvi_status status = DVI_NO_MEMORY;
  *part = NULL;
  if (potential != NULL && force != NULL && holonomic != NULL) {
    for (int k = 0; k < potentials; k++) potential[k] = declared_potential(&whole->potentials[k]);
    for (int k = 0; k < whole->force_count; k++) force[k] = declared_force(&whole->forces[k]);
    for (int k = 0; k < more; k++) force[whole->force_count + k] = shaking[k];
    for (int k = 0; k < holonomics; k++) holonomic[k] = declared_holonomic(&whole->holonomics[k]);
    status = dvi__system_create_part(
        &(dvi_system_terms){.dimension = whole->n,
                            .mass = mass_of_system(whole),
                            .autonomous = whole->autonomous,
                            .potentials = potentials > 0 ? potential : NULL,
                            .potential_count = potentials,
                            .forces = forces > 0 ? force : NULL,
                            .force_count = forces,
                            .holonomics = holonomics > 0 ? holonomic : NULL,
                            .holonomic_count = holonomics,
                            .symmetries = whole->symmetry_count > 0 ? whole->symmetries : NULL,
                            .symmetry_count = whole->symmetry_count},
        whole, part);
  } else {
    (void)dvi__fail(status, "system: no memory for its parts");
  }
  dvi__release(potential);
  dvi__release(force);
  dvi__release(holonomic);
  return status;
}

dvi_status dvi__system_slow_part(const dvi_system *whole, dvi_system **part)
{
  return make_part(whole, 0, NULL, part);
}

dvi_status dvi__system_fast_part(const dvi_system *whole, dvi_system **part)
{
  return make_part(whole, 1, whole, part);
}

const char *dvi__system_fast_not_quadratic(const dvi_system *whole)
{
  for (int k = 0; k < whole->potential_count; k++)
    if (whole->potentials[k].callbacks.fast && !whole->potentials[k].callbacks.quadratic)
      return whole->potentials[k].name;
  return NULL;
}

int dvi__system_fast_is_quadratic(const dvi_system *whole)
{
  return dvi__system_fast_not_quadratic(whole) == NULL;
}
