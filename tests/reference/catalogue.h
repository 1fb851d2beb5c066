/* Problems of the catalogue for the tests of the reference codes. */
#ifndef REFERENCE_CATALOGUE_H
#define REFERENCE_CATALOGUE_H
#include <check.h>
#include <dvi/dvi.h>
#include <string.h>

#include "problem.h"

enum { CODES = 4, MOST = 40 }; /* the codes for every system */

static inline problem *make(const char *name, const char *setting)
{
  problem *made = NULL;
  char message[256] = "";
  ck_assert_msg(problem_create(name, setting != NULL, &setting, &made, message, sizeof message) ==
                    DVI_OK,
                "%s", message);
  ck_assert_int_le(made->nq, MOST);
  return made;
}

static inline dvi_reference_options option(int code, double tolerance)
{
  return (dvi_reference_options){.code = (dvi_reference_code)code, .relative_tolerance = tolerance};
}

static inline void start(const problem *model, double *q, double *p)
{
  memcpy(q, model->q, (size_t)model->nq * sizeof *q);
  memcpy(p, model->p, (size_t)model->nv * sizeof *p);
}

#endif
