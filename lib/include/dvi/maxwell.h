/** Electromagnetic fields on meshes, in units with c = 1 in a vacuum.
 *
 *  The potential A, in the gauge without a scalar potential, is a k-form of the mesh: a 1-form in
 *  two dimensions (E in the plane, B across it) and in three, or a 0-form in one dimension and in
 *  two with E across the plane. The Lagrangian is
 *
 *      L = A'.M_k A'/2 - (d A).M_{k+1} (d A)/2 + J.A
 *
 *  with the permittivity in M_k and the inverse permeability in M_{k+1}. E = -A' and B = dA, so
 *  that B' = -dE and (M_k E)' = d^T M_{k+1} B - J are Maxwell's equations, which keep the charge
 *  d^T M_k E. Absorbing walls and conductors add the current S E with a positive matrix S (Stern
 *  2009, sec. 3; Bossavit and Kettunen 1999). */
#ifndef DVI_MAXWELL_H
#define DVI_MAXWELL_H
#include <dvi/field.h>

/** Kinds of walls. */
typedef enum dvi_wall_kind {
  DVI_PMC,      /**< perfect magnetic conductor: no tangential H. Where nothing is said */
  DVI_PEC,      /**< perfect electric conductor: no tangential E */
  DVI_ABSORBING /**< takes up waves that meet it at a right angle (Mur 1981, first order) */
} dvi_wall_kind;

/** A wall on a part of the mesh. PEC is allowed on any part, the others on the boundary. */
typedef struct dvi_wall {
  const char *part; /**< a part of the mesh. Copied. "boundary" and "all" are parts, too */
  dvi_wall_kind kind;
} dvi_wall;

/** A current that is given: a density in space times a function of time. */
typedef struct dvi_current {
  /** the density j(x) as a k-form. NULL for a dipole */
  dvi_form_function *density;
  void *density_user;
  double at[DVI_MESH_DIMENSION_MAX];    /**< place of a dipole, without a density */
  double along[DVI_MESH_DIMENSION_MAX]; /**< its direction and strength. Of 0-forms along[0] */
  /** The factor at a time. Required. Return 0, or another number for a failure */
  int (*signal)(double t, double *value, void *user);
  /** Its integral from one time to another. Default: by the factor in the middle */
  int (*impulse)(double from, double to, double *value, void *user);
  void *user; /**< of signal and impulse */
} dvi_current;

/** A number that is watched. */
typedef struct dvi_field_probe {
  const char *name; /**< copied. Not that of another one */
  /** "E" or "B" at a place, "flux" for the power through a part, "energy" for that in a part */
  const char *of;
  double at[DVI_MESH_DIMENSION_MAX]; /**< the place */
  /** which component is wanted: its products with those of dvi_form_evaluate are summed up */
  double along[DVI_MESH_DIMENSION_MAX + 2];
  /** a part of facets of the boundary, or of cells, through whose boundary the power flows out */
  const char *part;
} dvi_field_probe;

/** What an electromagnetic field consists of. Zero means the default. */
typedef struct dvi_maxwell_terms {
  size_t size; /**< sizeof(dvi_maxwell_terms) */
  /** the mesh and its materials: factor[k] is the permittivity, factor[k+1] the inverse
   *  permeability. The field shares it. Its matrices are positive */
  const dvi_star *star;
  int scalar;           /**< not 0 for E as a 0-form. Always so in one dimension */
  const dvi_wall *wall; /**< [walls] PEC is stronger than absorbing, and that than PMC */
  int walls;
  const double *conductivity; /**< [cells] of the mesh, 0 or more. Copied. Default: 0 */
  const dvi_current *current; /**< [currents] Copied */
  int currents;
  const dvi_field_probe *probe; /**< [probes] Copied */
  int probes;
} dvi_maxwell_terms;

#ifdef __cplusplus
extern "C" {
#endif

/** Create an electromagnetic field on a mesh.
 *
 *  dvi_field_unknowns gives the k-cells that no PEC holds, dvi_field_matrix their matrices.
 *  dvi_field_modes finds the modes whose E has no charge, so that the static fields, which are
 *  gradients, are left out and counted.
 *
 *  @retval DVI_BAD_ARGUMENT     a part is missing, every cell is held, a conductivity is negative,
 *                               a dipole or a probe lies outside of the mesh, or an argument is not
 *                               as described
 *  @retval DVI_SINGULAR         an entry of M_k is not positive, one of M_{k+1} or of a diagonal S
 *                               is negative, or a factor of a star that is not diagonal is.
 *                               dvi_last_error() names the place and what helps
 *  @retval DVI_CALLBACK_FAILED  a density failed
 *  @retval DVI_NOT_FINITE       a density is not finite. dvi_last_error() names the place
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_maxwell_create(const dvi_maxwell_terms *terms, dvi_field **field);

/** Return the name of probe i of a field, counted from 0, or NULL beyond the last one. Owned by the
 *  field. */
const char *dvi_field_probe_name(const dvi_field *field, int i);

/** Evaluate probe i for a state of the field's mechanical system, q = A and p = -M_k E [unknowns].
 *
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or there is no such probe
 *  @retval (others)          as dvi_star_solve, if M_k is not diagonal */
dvi_status dvi_field_probe_at(const dvi_field *field, int i, const double *q, const double *p,
                              double *value);

/** Find a potential A [k-cells] with dA = B, which vanishes where the form is held.
 *
 *  @param      B  [(k+1)-cells]
 *  @param[out] A  [k-cells] of all of them the one that has no charge
 *  @retval DVI_BAD_ARGUMENT  no A has such a B: it has a divergence, passes through an electric
 *                            wall, or winds around a hole of the mesh
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_field_vector_potential(const dvi_field *field, const double *B, double *A);

#ifdef __cplusplus
}
#endif
#endif
