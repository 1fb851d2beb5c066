#include "varied/varied.h"

#include <dvi/scene.h>
#include <stdlib.h>

#include "cli/command.h"
#include "load/open.h"

enum { MESSAGE_SIZE = 1024 };

static int count_parameters(const dvi_scene *scene)
{
  int count = 0;
  while (dvi_scene_parameter_at(scene, count) != NULL) count++;
  return count;
}

static int derive(const char *command, varied *made, const char *method)
{
  char message[MESSAGE_SIZE];
  dvi_dependence dependence;
  dvi_scene *scene = made->scene->scene;
  const size_t numbers = (size_t)made->n * (size_t)made->count;
  dvi_status status = dvi_scene_depend(scene, &dependence, message, sizeof message);
  if (status == DVI_UNSUPPORTED)
    return usage_error("%s: %s has no Lagrangian of R^n, which derivatives of runs are for; fields "
                       "have none",
                       command, made->scene->name);
  if (status != DVI_OK) return complain("%s", message), USAGE;
  made->by_q = calloc(numbers + 1, sizeof *made->by_q);
  made->by_p = calloc(numbers + 1, sizeof *made->by_p);
  made->by_parameter = calloc((size_t)made->count + 1, sizeof *made->by_parameter);
  if (made->by_q == NULL || made->by_p == NULL || made->by_parameter == NULL)
    return complain("out of memory"), FAILED;
  status = dvi_scene_start_tangent(scene, made->by_q, made->by_p);
  if (status != DVI_OK)
    return complain("%s: the start of %s has no finite derivatives by the parameters", command,
                    made->scene->name),
           FAILED;
  status = dvi_sensitivity_create(made->scene->system, method, &dependence, &made->run);
  return status == DVI_OK ? DONE : library_error(status);
}

int varied_open(const char *command, const char *path, const scene_text *text,
                const words *settings, const char *method, varied *made)
{
  *made = (varied){.scene = NULL};
  int code = scene_parse(path, text, settings, &made->scene);
  if (code != DONE) return code;
  made->n = made->scene->nq;
  made->count = count_parameters(made->scene->scene);
  code = open_wish(command, made->scene, &method);
  return code == DONE ? derive(command, made, method) : code;
}

void varied_close(varied *own)
{
  dvi_sensitivity_destroy(&own->run);
  problem_destroy(&own->scene);
  free(own->by_q);
  free(own->by_p);
  free(own->by_parameter);
  *own = (varied){.scene = NULL};
}

int varied_count(const varied *own)
{
  return 2 * own->n + own->count;
}

static const dvi_scene_parameter *parameter_of(const varied *own, int k)
{
  return dvi_scene_parameter_at(own->scene->scene, k - 2 * own->n);
}

const char *varied_name(const varied *own, int k)
{
  if (k < own->n) return own->scene->coordinate[k];
  if (k < 2 * own->n) return own->scene->momentum[k - own->n];
  const dvi_scene_parameter *p = parameter_of(own, k);
  return p->settable && !p->is_made ? p->name : NULL;
}

double varied_value(const varied *own, int k)
{
  if (k < own->n) return own->scene->q[k];
  return k < 2 * own->n ? own->scene->p[k - own->n] : parameter_of(own, k)->value;
}

void varied_tangent(const varied *own, int k, double *change)
{
  const int rows = 2 * own->n;
  const double *tangent = dvi_sensitivity_tangent(own->run);
  for (int i = 0; i < rows; i++) change[i] = tangent[k * rows + i] + 0.0; /* no -0 */
  for (int j = 0; j < own->n && k >= rows; j++) {
    const double of_q = own->by_q[(k - rows) * own->n + j],
                 of_p = own->by_p[(k - rows) * own->n + j];
    for (int i = 0; i < rows; i++)
      change[i] += tangent[j * rows + i] * of_q + tangent[(own->n + j) * rows + i] * of_p;
  }
}
