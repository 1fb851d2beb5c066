#include "load/elastic.h"

#include <dvi/march.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { NAME_SIZE = 32 };

const dvi_elastic *elastic_of(const problem *scene)
{
  return dvi_scene_elastic(scene->scene);
}

static int out_of_memory(void)
{
  complain("out of memory");
  return FAILED;
}

/* ---- facts ---- */

void elastic_tell(const problem *scene)
{
  const dvi_elastic *solid = elastic_of(scene);
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const int n = dvi_mesh_dimension(mesh);
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  const double *mass = dvi_elastic_masses(solid);
  double omega = 0.0, all = 0.0, least = HUGE_VAL, most = 0.0;
  int64_t unknowns;
  (void)dvi_elastic_unknowns(solid, &unknowns);
  for (int64_t v = 0; v < vertices; v++) {
    all += mass[v];
    least = fmin(least, mass[v]);
    most = fmax(most, mass[v]);
  }
  (void)printf("mesh: dimension %d, %lld vertices, %lld cells; parts", n, (long long)vertices,
               (long long)dvi_mesh_count(mesh, n));
  for (int i = 0; dvi_mesh_part_name(mesh, i) != NULL; i++)
    (void)printf("%s %s", i > 0 ? "," : "", dvi_mesh_part_name(mesh, i));
  (void)printf(
      "\nsolid: %lld unknown displacements, %lld given; mass %.9g, of nodes %.3g to %.3g\n",
      (long long)unknowns, (long long)(vertices * n - unknowns), all, least, most);
  if (dvi_elastic_fastest(solid, &omega) == DVI_OK && omega > 0.0)
    (void)printf("largest frequency at rest: %.6g; verlet is stable near rest below h = %.6g\n",
                 omega, 2.0 / omega);
}

/* Measure the evaluations of cells in a unit of time, in a few of the longest steps. */
static double measure_cost(const problem *scene, const char *method, double fraction)
{
  enum { STEPS = 4 };
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  dvi_march_facts facts;
  dvi_march *march = NULL;
  double rate = NAN;
  if (dvi_scene_march_create(scene->scene, &options, &march) != DVI_OK) return rate;
  dvi_march_facts_of(march, &facts);
  const double span = STEPS * facts.longest;
  if (dvi_march_advance(march, span) == DVI_OK) {
    dvi_march_facts_of(march, &facts);
    rate = (double)facts.updates / span;
  }
  dvi_march_destroy(&march);
  return rate;
}

/* Tell how many cells have each step of a march whose steps are powers of 2 of the shortest one. In
 * the slot 2^j all cells of steps up to 2^j have an event. */
static void tell_classes(dvi_march *march)
{
  dvi_march_facts before, after;
  dvi_march_facts_of(march, &before);
  const double shortest = before.step, longest = before.longest;
  int64_t shorter = 0;
  (void)printf("%12s  %10s  evaluations in a unit of time\n", "step", "cells");
  for (double slots = 1.0; slots * shortest <= longest * (1.0 + 1e-9); slots *= 2.0) {
    if (dvi_march_advance(march, (slots - 0.5) * shortest) != DVI_OK) return;
    dvi_march_facts_of(march, &before);
    if (dvi_march_advance(march, (slots + 0.25) * shortest) != DVI_OK) return;
    dvi_march_facts_of(march, &after);
    const int64_t cells = after.updates - before.updates - shorter;
    (void)printf("%12.6g  %10lld  %.4g\n", slots * shortest, (long long)cells,
                 (double)cells / (slots * shortest));
    shorter += cells;
  }
}

/* Tell the same of a method, unless its cells have one step, or any. */
static void tell_classes_of(const problem *scene, const char *method, double fraction)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  dvi_march_facts facts;
  dvi_march *march = NULL;
  if (strncmp(method, "avi", 3) != 0 || strstr(method, "classes=no") != NULL ||
      dvi_scene_march_create(scene->scene, &options, &march) != DVI_OK)
    return;
  dvi_march_facts_of(march, &facts);
  if (facts.longest > facts.step) tell_classes(march);
  dvi_march_destroy(&march);
}

void elastic_tell_cost(const problem *scene, const char *method, double fraction)
{
  const double own = measure_cost(scene, method, fraction),
               other = measure_cost(scene, "verlet", fraction);
  if (!isfinite(own) || !isfinite(other)) return;
  (void)printf("cost: %.4g evaluations of cells in a unit of time, verlet with the same fraction "
               "of its bound %.4g, %.1f times as many\n",
               own, other, other / own);
  tell_classes_of(scene, method, fraction);
}

/* ---- views ---- */

/* Copy vectors or matrices of n into those of three. */
static void widen(int n, int rank, int64_t count, const double *from, double *to)
{
  const int own = rank == 1 ? n : n * n, all = rank == 1 ? 3 : 9;
  memset(to, 0, (size_t)count * (size_t)all * sizeof *to);
  for (int64_t k = 0; k < count; k++)
    for (int i = 0; i < own; i++)
      to[k * all + (rank == 1 ? i : i / n * 3 + i % n)] = from[k * own + i];
}

/* The stresses of all cells. von Mises' is not known of every law. */
static dvi_status add_stresses(const dvi_elastic *solid, const double *u, double *work,
                               elastic_views *views, double *to)
{
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const int n = dvi_mesh_dimension(mesh);
  const int64_t cells = dvi_mesh_count(mesh, n);
  dvi_status status = dvi_elastic_stress(solid, 0, NULL, u, work);
  if (status != DVI_OK) return status;
  widen(n, 2, cells, work, to);
  views->view[views->count++] = (dvi_view){"stress", to, 9, n};
  status = dvi_elastic_von_mises(solid, 0, NULL, u, to + 9 * cells);
  if (status == DVI_UNSUPPORTED) return DVI_OK;
  views->view[views->count++] = (dvi_view){"von_mises", to + 9 * cells, 1, n};
  return status;
}

int elastic_views_make(const problem *scene, const double *u, const double *velocity,
                       elastic_views *views)
{
  const dvi_elastic *solid = elastic_of(scene);
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const int n = dvi_mesh_dimension(mesh);
  const int64_t vertices = dvi_mesh_count(mesh, 0), cells = dvi_mesh_count(mesh, n);
  *views = (elastic_views){.count = 2};
  views->value = calloc((size_t)(9 * vertices + 19 * cells), sizeof *views->value);
  if (views->value == NULL) return out_of_memory();
  double *const speed = views->value + 3 * vertices, *const work = speed + 3 * vertices,
                *const stress = work + 9 * cells;
  views->point = stress + 10 * cells;
  widen(n, 1, vertices, u, views->value);
  widen(n, 1, vertices, velocity, speed);
  views->view[0] = (dvi_view){"u", views->value, 3, 0};
  views->view[1] = (dvi_view){"velocity", speed, 3, 0};
  const double *X = dvi_mesh_points(mesh);
  for (int64_t k = 0; k < vertices * n; k++) views->point[k] = X[k] + u[k];
  const dvi_status status = add_stresses(solid, u, work, views, stress);
  return status == DVI_OK ? DONE : library_error(status);
}

void elastic_views_clear(elastic_views *views)
{
  free(views->value);
  views->value = NULL;
}

int elastic_views_of_state(const problem *scene, double t, const double *q, const double *p,
                           elastic_views *views)
{
  const dvi_elastic *solid = elastic_of(scene);
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const size_t numbers = (size_t)dvi_mesh_count(mesh, 0) * (size_t)dvi_mesh_dimension(mesh);
  double *u = calloc(2 * numbers, sizeof *u);
  *views = (elastic_views){.count = 0};
  if (u == NULL) return out_of_memory();
  double *rate = u + numbers;
  const dvi_status status = dvi_elastic_lift(solid, t, q, p, u, rate);
  const int code = status == DVI_OK ? elastic_views_make(scene, u, rate, views)
                                    : library_error(status);
  free(u);
  return code;
}

int elastic_write_modes(const problem *scene, const char *path, int count, const double *mode)
{
  const dvi_mesh *mesh = dvi_elastic_mesh(elastic_of(scene));
  const int n = dvi_mesh_dimension(mesh);
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  dvi_view *view = calloc((size_t)count, sizeof *view);
  char(*name)[NAME_SIZE] = calloc((size_t)count, sizeof *name);
  double *value = calloc((size_t)count * 3 * (size_t)vertices, sizeof *value);
  int code = view != NULL && name != NULL && value != NULL ? DONE : out_of_memory();
  for (int i = 0; i < count && code == DONE; i++) {
    (void)snprintf(name[i], NAME_SIZE, "mode_%d", i + 1);
    widen(n, 1, vertices, mode + i * vertices * n, value + i * 3 * vertices);
    view[i] = (dvi_view){name[i], value + i * 3 * vertices, 3, 0};
  }
  if (code == DONE) {
    const dvi_status status = dvi_mesh_write(mesh, path, count, view);
    code = status == DVI_OK ? DONE : library_error(status);
  }
  free(view);
  free(name);
  free(value);
  return code;
}
