#include "support/field/marches.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/suite.h"

void advance_march(dvi_march *march, double t)
{
  ck_assert_msg(dvi_march_advance(march, t) == DVI_OK, "%s", dvi_last_error());
}

double observe_march(const dvi_march *march, const char *name)
{
  const char *found;
  for (int i = 0; (found = dvi_march_observable(march, i)) != NULL; i++) {
    double value;
    if (strcmp(found, name) != 0) continue;
    ck_assert_msg(dvi_march_observe(march, i, &value) == DVI_OK, "%s", dvi_last_error());
    return value;
  }
  ck_abort_msg("there is no observable %s", name);
  return 0;
}

double step_of_march(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return facts.step;
}

void copy_march(const dvi_march *march, dvi_march_form form, double *values)
{
  ck_assert_msg(dvi_march_sample(march, form, 0, NULL, values) == DVI_OK, "%s", dvi_last_error());
}

double *sample_march(const dvi_march *march, dvi_march_form form)
{
  double *values = calloc((size_t)dvi_march_size(march, form) + 1, sizeof *values);
  copy_march(march, form, values);
  return values;
}

unsigned char *save_march(const dvi_march *march, size_t *size)
{
  *size = 0;
  (void)dvi_march_save_memory(march, NULL, 0, size);
  unsigned char *bytes = malloc(*size + 1);
  if (dvi_march_save_memory(march, bytes, *size, size) != DVI_OK) *size = 0;
  return bytes;
}

int march_has_bytes(const dvi_march *march, const unsigned char *bytes, size_t size)
{
  size_t found;
  unsigned char *here = save_march(march, &found);
  const int same = found == size && memcmp(here, bytes, size) == 0;
  free(here);
  return same;
}

int file_has_bytes(const char *path, const unsigned char *bytes, size_t size)
{
  FILE *file = fopen(path, "rb");
  unsigned char *here = malloc(size + 1);
  const size_t found = file != NULL ? fread(here, 1, size + 1, file) : 0;
  const int same = found == size && memcmp(here, bytes, size) == 0;
  if (file != NULL) (void)fclose(file);
  free(here);
  return same;
}

void end_state_trial(state_trial *trial)
{
  (void)unlink(trial->path);
  free(trial->saved);
  free(trial->later);
}
