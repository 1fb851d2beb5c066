/* The memory that a process takes at most for its share of a mesh, beyond that of MPI and PETSc.
 *   memory write FILE CELLS           make the Kuhn mesh of a cube with CELLS^3 cubes
 *   mpirun -np N memory read FILE     read shares of it (dvi_mesh_read_divided)
 *   mpirun -np N memory divide CELLS  cut them out of the whole mesh (dvi_mesh_divide)
 *   mpirun -np N memory save FILE     save, load and draw the state of a wave on shares */
#define _POSIX_C_SOURCE 200809L
#include <dvi/petsc.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

static dvi_mesh *make_mesh(const char *cells)
{
  const int count = (int)strtol(cells, NULL, 10);
  const dvi_generator_options options = {.size = sizeof options, .cells = {count, count, count}};
  dvi_mesh *mesh = NULL;
  (void)dvi_mesh_generate("kuhn", &options, &mesh);
  return mesh;
}

/* Return a line of /proc/self/status in bytes, such as "VmHWM:". */
static double read_memory(const char *name)
{
  char line[128];
  double kilobytes = 0;
  FILE *stream = fopen("/proc/self/status", "r");
  while (stream != NULL && fgets(line, sizeof line, stream) != NULL)
    if (strncmp(line, name, strlen(name)) == 0) kilobytes = strtod(line + strlen(name), NULL);
  if (stream != NULL) (void)fclose(stream);
  return 1024 * kilobytes;
}

/* Get the share as the command says. */
static dvi_status get_share(char **argument, dvi_mesh **share, dvi_division **division)
{
  if (strcmp(argument[1], "divide") != 0)
    return dvi_mesh_read_divided(argument[2], NULL, share, division);
  dvi_mesh *mesh = make_mesh(argument[2]);
  const dvi_status status = dvi_mesh_divide(mesh, NULL, share, division);
  dvi_mesh_destroy(&mesh);
  return status;
}

static void print_largest(const double *base)
{
  double most[3] = {read_memory("VmHWM:") - base[0], read_memory("VmRSS:") - base[0], base[0]};
  int rank, ranks;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  (void)MPI_Allreduce(MPI_IN_PLACE, most, 3, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  if (rank == 0)
    (void)printf("%d processes: %.0f MB at most while the share is made, %.0f MB afterwards, "
                 "beside %.0f MB of MPI and PETSc; %.1f s\n",
                 ranks, most[0] / 1e6, most[1] / 1e6, most[2] / 1e6, MPI_Wtime() - base[1]);
}

/* ---- states ---- */

/* A wave on a share. */
typedef struct wave {
  const dvi_mesh *share;
  dvi_division *division;
  dvi_field *field;
  dvi_march *march;
  double *u; /* [vertices] */
} wave;

static dvi_status save_whole(const wave *w)
{
  return dvi_march_save(w->march, "memory.state");
}

static dvi_status load_whole(const wave *w)
{
  return dvi_march_load(w->march, "memory.state");
}

static dvi_status save_parts(const wave *w)
{
  return dvi_march_write_divided(w->march, w->division, "memory-state.h5");
}

static dvi_status load_parts(const wave *w)
{
  return dvi_march_read_divided(w->march, w->division, "memory-state.h5");
}

static dvi_status draw(const wave *w)
{
  const dvi_view view = {"u", w->u, 1, 0};
  return dvi_mesh_write(w->share, "memory.vtu", 1, &view);
}

/* Print the most that the first process and any process take beside what they have. */
static void measure_act(const char *name, dvi_status (*act)(const wave *w), const wave *w)
{
  (void)malloc_trim(0); /* what was released before would hide what is taken now */
  FILE *stream = fopen("/proc/self/clear_refs", "w");
  if (stream != NULL) (void)fputs("5", stream); /* begins VmHWM anew */
  if (stream != NULL) (void)fclose(stream);
  const double base = read_memory("VmRSS:"), began = MPI_Wtime();
  const dvi_status status = act(w);
  double most[2] = {read_memory("VmHWM:") - base, base};
  int rank;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const double own = most[0];
  (void)MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  if (status != DVI_OK && rank == 0) (void)fprintf(stderr, "%s\n", dvi_last_error());
  if (rank == 0)
    (void)printf("%-14s  the first %6.1f MB, any %6.1f MB, beside %.0f MB; %.1f s\n", name,
                 own / 1e6, most[0] / 1e6, most[1] / 1e6, MPI_Wtime() - began);
}

static dvi_status start_wave(wave *w)
{
  dvi_star *star = NULL;
  const int64_t vertices = dvi_mesh_count(w->share, 0);
  dvi_status status = dvi_star_create(w->share, NULL, &star);
  const dvi_wave_terms terms = {.size = sizeof terms, .star = star};
  w->u = malloc((size_t)vertices * sizeof *w->u);
  for (int64_t v = 0; w->u != NULL && v < vertices; v++)
    w->u[v] = (double)(dvi_mesh_share_numbers(w->share, 0)[v] % 7);
  const dvi_march_options options = {.size = sizeof options, .step = 1e-6};
  const dvi_march_state state = {.size = sizeof state, .A = w->u};
  if (status == DVI_OK) status = dvi_wave_create(&terms, &w->field);
  if (status == DVI_OK) status = dvi_march_create(w->field, &options, &w->march);
  if (status == DVI_OK) status = dvi_march_start(w->march, &state);
  dvi_star_destroy(&star);
  return status;
}

static void measure_states(const dvi_mesh *share, dvi_division *division)
{
  wave w = {.share = share, .division = division};
  const dvi_status status = start_wave(&w);
  if (status != DVI_OK) (void)fprintf(stderr, "%s\n", dvi_last_error());
  if (status == DVI_OK) {
    measure_act("save .state", save_whole, &w);
    measure_act("load .state", load_whole, &w);
    measure_act("save .h5", save_parts, &w);
    measure_act("load .h5", load_parts, &w);
    measure_act("draw .vtu", draw, &w);
  }
  dvi_march_destroy(&w.march);
  dvi_field_destroy(&w.field);
  free(w.u);
}

static int measure(int argc, char **argv)
{
  dvi_mesh *share;
  dvi_division *division;
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  const double base[2] = {read_memory("VmRSS:"), MPI_Wtime()};
  const dvi_status status = get_share(argv, &share, &division);
  if (status == DVI_OK) print_largest(base);
  if (status == DVI_OK && strcmp(argv[1], "save") == 0)
    measure_states(share, division);
  else if (status != DVI_OK)
    (void)fprintf(stderr, "%s\n", dvi_last_error());
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  (void)PetscFinalize();
  return status != DVI_OK;
}

int main(int argc, char **argv)
{
  if (argc == 3 && (strcmp(argv[1], "read") == 0 || strcmp(argv[1], "divide") == 0 ||
                    strcmp(argv[1], "save") == 0))
    return measure(argc, argv);
  dvi_mesh *mesh = argc == 4 && strcmp(argv[1], "write") == 0 ? make_mesh(argv[3]) : NULL;
  const dvi_status status = dvi_mesh_write_divided(mesh, argc == 4 ? argv[2] : NULL);
  if (status != DVI_OK) (void)fprintf(stderr, "%s\n", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return status != DVI_OK;
}
