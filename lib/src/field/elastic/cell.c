/* What a cell stores and pulls. With the gradients g_a of its barycentric coordinates
 *
 *     H = grad u = sum_a u_a (x) g_a,    f_a = -V P(F) g_a,    F = I + H
 *
 * (Lew, Marsden, Ortiz and West 2003, sec. 4). Since the g_a have the sum 0, those of the first
 * node are left out, so that translations give exact zeros. */
#include "field/elastic/cell.h"

#include "core/status.h"
#include "num/eigen.h"

/* ---- forces ---- */

/* Give -V P g_a with the gradients of the nodes but the first one. n is a constant where this is
 * called. */
static inline void pull(int n, double volume, const double *g, const double *P, double *f)
{
  for (int i = 0; i < n; i++) {
    double first = 0;
    for (int a = 1; a <= n; a++) {
      double sum = 0;
      for (int j = 0; j < n; j++) sum += P[i * n + j] * g[(a - 1) * n + j];
      f[a * n + i] = -volume * sum;
      first += volume * sum;
    }
    f[i] = first;
  }
}

/* The force with n as a constant. */
static inline int find_force(int n, const dvi__solid_material *m, double volume, const double *g,
                             const double *u, double *f)
{
  double H[DVI__SOLID_ENTRIES], P[DVI__SOLID_ENTRIES];
  dvi__displacement_gradient(n, g, u, H);
  const int returned = dvi__law_stress(n, m, H, P);
  if (returned == 0) pull(n, volume, g, P, f);
  return returned;
}

int dvi__solid_force_of(int n, const dvi__solid_material *m, double volume, const double *g,
                        const double *u, double *f)
{
  return n == 3 ? find_force(3, m, volume, g, u, f) : find_force(2, m, volume, g, u, f);
}

int dvi__solid_force(const dvi_elastic *e, int64_t cell, const double *u, double *f)
{
  return dvi__solid_force_of(e->n, e->materials + e->material[cell], e->volume[cell],
                             dvi__solid_gradients(e, cell), u, f);
}

/* ---- forces of several cells ---- */

/* Give the forces of cells of one material whose energy is given, by one call of it. Returns 0 if
 * the call failed, or its numbers are not finite. */
static int find_given(const dvi_elastic *e, int64_t first, int count, const double *u, double *f)
{
  const int n = e->n, entries = n * n, numbers = (n + 1) * n;
  const dvi__solid_material *m = e->materials + e->material[first];
  double F[DVI__SOLID_ENTRIES * DVI__SOLID_BATCH] = {0}, P[DVI__SOLID_ENTRIES * DVI__SOLID_BATCH];
  for (int c = 0; c < count; c++) {
    double H[DVI__SOLID_ENTRIES] = {0};
    dvi__solid_strain(e, first + c, u + c * numbers, H);
    for (int k = 0; k < entries; k++) F[k * count + c] = H[k] + (k % (n + 1) == 0);
  }
  if (m->energy(count, F, NULL, P, NULL, m->user) != 0) return 0;
  for (int c = 0; c < count; c++) {
    double own[DVI__SOLID_ENTRIES] = {0};
    for (int k = 0; k < entries; k++) {
      own[k] = P[k * count + c];
      if (!isfinite(own[k])) return 0;
    }
    pull(n, e->volume[first + c], dvi__solid_gradients(e, first + c), own, f + c * numbers);
  }
  return 1;
}

/* Return how many cells from the first on have its material. */
static int count_alike(const dvi_elastic *e, int64_t first, int most)
{
  int count = 1;
  while (count < most && e->material[first + count] == e->material[first]) count++;
  return count;
}

/* Where a call for several cells fails, single ones tell which. */
int dvi__solid_forces(const dvi_elastic *e, int64_t first, int count, const double *u, double *f,
                      int *failed)
{
  const int numbers = (e->n + 1) * e->n;
  for (int c = 0, alike; c < count; c += alike) {
    const int is_given = e->materials[e->material[first + c]].law == DVI_ELASTIC_ENERGY;
    alike = is_given ? count_alike(e, first + c, count - c) : 1;
    if (is_given && find_given(e, first + c, alike, u + c * numbers, f + c * numbers)) continue;
    for (int k = c; k < c + alike; k++) {
      const int returned = dvi__solid_force(e, first + k, u + k * numbers, f + k * numbers);
      *failed = k;
      if (returned != 0) return returned;
    }
  }
  return 0;
}

static inline void find_rest_force(int n, const dvi_elastic *e, int64_t cell, const double *u,
                                   double *f)
{
  double H[DVI__SOLID_ENTRIES], P[DVI__SOLID_ENTRIES];
  const double *g = dvi__solid_gradients(e, cell), *moduli = e->materials[e->material[cell]].rest;
  dvi__displacement_gradient(n, g, u, H);
  for (int i = 0; i < n * n; i++) {
    P[i] = 0;
    for (int k = 0; k < n * n; k++) P[i] += moduli[i * n * n + k] * H[k];
  }
  pull(n, e->volume[cell], g, P, f);
}

void dvi__solid_rest_force(const dvi_elastic *e, int64_t cell, const double *u, double *f)
{
  if (e->n == 3)
    find_rest_force(3, e, cell, u, f);
  else
    find_rest_force(2, e, cell, u, f);
}

/* ---- energies and stiffnesses ---- */

void dvi__solid_strain(const dvi_elastic *e, int64_t cell, const double *u, double *H)
{
  dvi__displacement_gradient(e->n, dvi__solid_gradients(e, cell), u, H);
}

int dvi__solid_stored(const dvi_elastic *e, int64_t cell, const double *u, double *energy)
{
  double H[DVI__SOLID_ENTRIES], W;
  dvi__solid_strain(e, cell, u, H);
  const int returned = dvi__law_energy(e->n, e->materials + e->material[cell], H, &W);
  if (returned == 0) *energy = e->volume[cell] * W;
  return returned;
}

/* K_ai,bk = V sum_jl g_aj A_ijkl g_bl, with n as a constant. */
static inline void find_stiffness(int n, double volume, const double *g, const double *A, double *K)
{
  const int numbers = (n + 1) * n;
  double Ag[DVI__SOLID_ENTRIES];
  for (int b = 0; b <= n; b++)
    for (int k = 0; k < n; k++) {
      for (int ij = 0; ij < n * n; ij++) {
        Ag[ij] = 0;
        for (int l = 0; l < n; l++) Ag[ij] += A[(ij * n + k) * n + l] * g[b * n + l];
      }
      for (int a = 0; a <= n; a++)
        for (int i = 0; i < n; i++) {
          double sum = 0;
          for (int j = 0; j < n; j++) sum += g[a * n + j] * Ag[i * n + j];
          K[(a * n + i) * numbers + b * n + k] = volume * sum;
        }
    }
}

int dvi__solid_stiffness(const dvi_elastic *e, int64_t cell, const double *u, double *K)
{
  double A[DVI__SOLID_ENTRIES * DVI__SOLID_ENTRIES];
  const int n = e->n;
  const dvi__solid_material *material = e->materials + e->material[cell];
  const double *g = e->gradient + cell * (n + 1) * n, *moduli = material->rest;
  if (u != NULL && material->law != DVI_ELASTIC_LINEAR) {
    double H[DVI__SOLID_ENTRIES];
    dvi__displacement_gradient(n, g + n, u, H);
    const int returned = dvi__law_hessian(n, material, H, A);
    if (returned != 0) return returned;
    moduli = A;
  }
  if (n == 3)
    find_stiffness(3, e->volume[cell], g, moduli, K);
  else
    find_stiffness(2, e->volume[cell], g, moduli, K);
  return 0;
}

dvi_status dvi__solid_largest(const dvi_elastic *e, int64_t cell, double *lambda)
{
  double K[DVI__SOLID_NUMBERS * DVI__SOLID_NUMBERS], eigenvalue[DVI__SOLID_NUMBERS],
      work[8 * DVI__SOLID_NUMBERS];
  const int n = e->n, numbers = (n + 1) * n, *vertex = e->vertex + cell * (n + 1);
  const double mass = e->materials[e->material[cell]].rho * e->volume[cell] / (n + 1);
  int free_count = 0, place[DVI__SOLID_NUMBERS];
  *lambda = 0;
  (void)dvi__solid_stiffness(e, cell, NULL, K);
  for (int k = 0; k < numbers; k++)
    if (e->unknown[(int64_t)vertex[k / n] * n + k % n] >= 0) place[free_count++] = k;
  for (int r = 0; r < free_count; r++)
    for (int s = 0; s < free_count; s++)
      K[r * free_count + s] = K[place[r] * numbers + place[s]] / mass;
  if (free_count == 0) return DVI_OK;
  if (!dvi__symmetric_eigenvalues(free_count, K, eigenvalue, work))
    return dvi__fail(DVI_NOT_CONVERGED, "elastic: the frequencies of cell %lld do not converge",
                     (long long)cell);
  *lambda = fmax(eigenvalue[free_count - 1], 0);
  return DVI_OK;
}

/* ---- loads ---- */

int dvi__solid_add_load(const dvi_elastic *e, int64_t cell, double t, double *f)
{
  const int n = e->n;
  if (e->load_start == NULL) return 0;
  for (int64_t k = e->load_start[cell]; k < e->load_start[cell + 1]; k++) {
    const dvi__solid_load *of = e->load_of + k;
    const dvi_elastic_load *load = e->loads + of->load;
    double force[DVI_ELASTIC_DIMENSION_MAX];
    const int failed = load->force(t, of->at, of->is_facet ? of->normal : NULL, force, load->user);
    if (failed != 0) return failed;
    for (int a = 0; a <= n; a++)
      for (int i = 0; i < n && (of->nodes >> a & 1) != 0; i++)
        f[a * n + i] += of->weight * force[i];
  }
  return 0;
}

/* ---- sentences ---- */

/* Of laws that are not given. */
static const char *name_of_law(dvi_elastic_law law)
{
  static const char *const name[] = {"linear law", "law of St. Venant and Kirchhoff",
                                     "neo-Hookean law", "law of Mooney and Rivlin"};
  return name[law];
}

dvi_status dvi__solid_refuse(const dvi_elastic *e, int64_t cell, int returned)
{
  const dvi__cell_name name = dvi__name_cell(e->mesh, e->n, cell);
  const dvi_elastic_law law = e->materials[e->material[cell]].law;
  const int is_given = law == DVI_ELASTIC_ENERGY, is_loaded = e->load_start != NULL;
  if (returned < 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "elastic: %s returned %d at %s%s",
                     !is_given   ? "a load"
                     : is_loaded ? "the stored energy or a load"
                                 : "the stored energy",
                     returned, name.text,
                     !is_given   ? ", or is not finite there"
                     : is_loaded ? ", or a load is not finite there"
                                 : "");
  if (is_given)
    return dvi__fail(DVI_SINGULAR,
                     "elastic: the stored energy of %s, or a derivative of it, is not defined or "
                     "not finite where it is deformed to: take smaller steps, smaller loads or "
                     "larger cells there",
                     name.text);
  return dvi__fail(DVI_SINGULAR,
                   "elastic: %s is inverted, or deformed to where the %s of its material is not "
                   "defined: take smaller steps, smaller loads or larger cells there",
                   name.text, name_of_law(law));
}
