/* The memory that a process takes at most for its share of a mesh, beyond that of MPI and PETSc.
 *   memory write FILE CELLS           make the Kuhn mesh of a cube with CELLS^3 cubes
 *   mpirun -np N memory read FILE     read shares of it (dvi_mesh_read_divided)
 *   mpirun -np N memory divide CELLS  cut them out of the whole mesh (dvi_mesh_divide) */
#define _POSIX_C_SOURCE 200809L
#include <dvi/petsc.h>
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
  if (strcmp(argument[1], "read") == 0)
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

static int measure(int argc, char **argv)
{
  dvi_mesh *share;
  dvi_division *division;
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  const double base[2] = {read_memory("VmRSS:"), MPI_Wtime()};
  const dvi_status status = get_share(argv, &share, &division);
  if (status == DVI_OK)
    print_largest(base);
  else
    (void)fprintf(stderr, "%s\n", dvi_last_error());
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  (void)PetscFinalize();
  return status != DVI_OK;
}

int main(int argc, char **argv)
{
  if (argc == 3 && (strcmp(argv[1], "read") == 0 || strcmp(argv[1], "divide") == 0))
    return measure(argc, argv);
  dvi_mesh *mesh = argc == 4 && strcmp(argv[1], "write") == 0 ? make_mesh(argv[3]) : NULL;
  const dvi_status status = dvi_mesh_write_divided(mesh, argc == 4 ? argv[2] : NULL);
  if (status != DVI_OK) (void)fprintf(stderr, "%s\n", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return status != DVI_OK;
}
